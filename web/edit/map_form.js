// The forms of the map: its size by each side, the side of a cell, the place of its corner; and a new, empty
// map.

import { asRows } from "../model/drawn_map.js";
import { faultOfSize, newMap, resize, setOrigin, setResolution } from "../model/edit_request.js";
import { byId, element, setText } from "../ui/dom.js";
import { NumberField } from "../ui/number_field.js";

const SIDES = { left: "column", right: "column", top: "row", bottom: "row" };

export class MapForm {
  #session;
  #fields;

  constructor(session) {
    this.#session = session;
    const number = (label, unit, edited) =>
      new NumberField({ label, unit, late: true, accept: (value) => session.edit(edited(value)) });
    this.#fields = {
      columns: this.#sizeField("Columns", "columns", "right"),
      rows: this.#sizeField("Rows", "rows", "top"),
      resolution: number("Cell", "m", (value) => setResolution(session.request, value)),
      x: number("Origin x", "m", (value) => setOrigin(session.request, "x", value)),
      y: number("Origin y", "m", (value) => setOrigin(session.request, "y", value)),
    };
    const { columns, rows, resolution, x, y } = this.#fields;
    columns.input.dataset.pointer = "/map/rows";
    resolution.input.dataset.pointer = "/map/resolution";
    x.input.dataset.pointer = "/map/origin/x";
    y.input.dataset.pointer = "/map/origin/y";
    byId("map-numbers").append(...[columns, rows, resolution].map((field) => field.element));
    byId("map-origin").append(...[x, y].map((field) => field.element));
    byId("map-sides").append(...Object.keys(SIDES).map((side) => this.#sideButtons(side)));
    session.on("request", () => this.#refresh());
    this.#refresh();
  }

  /** Accepts a size only when it is complete: a partly typed one would cut the map. */
  #sizeField(label, dimension, side) {
    const accept = (value) => this.#resize({ [side]: value - this.#session.scene.grid[dimension] });
    return new NumberField({ label, step: "1", required: true, late: true, accept });
  }

  #sideButtons(side) {
    const button = (sign, by, words) => {
      const made = element("button", {
        type: "button",
        textContent: sign,
        "aria-label": `${words} a ${SIDES[side]} at the ${side}`,
        "data-side": `${side} ${by}`,
      });
      made.addEventListener("click", () => this.#resize({ [side]: by }));
      return made;
    };
    const name = element("span", { textContent: side });
    return element("div", { class: `side-${side}` }, button("−", -1, "Cut"), name, button("+", 1, "Add"));
  }

  /** Resizes the map; returns the reason if that is impossible, else null. */
  #resize(sides) {
    const { grid } = this.#session.scene;
    const sum = (name) => sides[name] ?? 0;
    const columns = grid.columns + sum("left") + sum("right");
    const rows = grid.rows + sum("top") + sum("bottom");
    const fault = faultOfSize(columns, rows, this.#session.limits);
    if (fault === null) this.#session.edit(resize(this.#session.request, sides));
    this.#session.announce(fault ?? `The map has ${columns} columns and ${rows} rows.`);
    return fault;
  }

  #refresh() {
    const { request, scene } = this.#session;
    const { columns, rows, resolution, x, y } = this.#fields;
    byId("map-form").hidden = scene.grid === null;
    byId("no-map").hidden = scene.grid !== null;
    columns.show(scene.grid?.columns);
    rows.show(scene.grid?.rows);
    const map = asRows(request?.map);
    resolution.show(map?.resolution, { placeholder: "1" });
    x.show(map?.origin?.x, { placeholder: "0" });
    y.show(map?.origin?.y, { placeholder: "0" });
  }
}

/** `begin(request)` opens the new request. */
export function watchNewMapForm(session, begin) {
  const form = byId("new-map");
  const fault = byId("new-map-fault");
  const number = (id) => byId(id).valueAsNumber;
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    const [columns, rows, resolution] = ["new-columns", "new-rows", "new-resolution"].map(number);
    const wrong =
      resolution > 0 ? faultOfSize(columns, rows, session.limits) : "A cell must be larger than 0 m.";
    setText(fault, wrong ?? "");
    if (wrong !== null) return;
    begin(newMap({ columns, rows, resolution, walled: byId("new-walled").checked }));
    session.announce(`New map of ${columns} columns and ${rows} rows.`);
  });
}
