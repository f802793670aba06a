// The dialog of a scenario: the number of robots, their radius and speeds.

import { readRows } from "../model/grid_cells.js";
import { MapPreview } from "../scene/map_raster.js";
import { robotColour } from "../scene/palette.js";
import { element, setText } from "../ui/dom.js";
import { FormDialog, numberField } from "../ui/form_dialog.js";
import { count } from "../ui/format.js";
import { scenarioRequest } from "./movingai.js";

const FIRST_COUNT = 10; // robots at first, if there are as many

export class ScenarioDialog {
  #map;
  #grid; // for the preview
  #entries;
  #preview = new MapPreview();
  #status = element("p", { class: "dialog-status", role: "status" });
  #fields;
  #dialog;
  /** @type {any} */
  #made = null; // {request, cells, passedOver} for the current fields; null while one is invalid

  /** `entries` on `map`: see readMovingAiScenario. At most `most` robots. `defaults`: initial values. */
  constructor(name, map, entries, defaults, most) {
    this.#map = map;
    const [columns, rows] = [map.rows[0].length, map.rows.length];
    this.#grid = { columns, rows, cells: new Uint8Array(columns * rows) };
    readRows(map.rows, columns, this.#grid.cells, 0, rows);
    this.#entries = entries;
    const robots = Math.min(entries.length, most);
    const positive = { min: "0" };
    this.#fields = {
      count: numberField(
        "scenario-count",
        "Robots",
        "",
        Math.min(FIRST_COUNT, robots),
        { min: "1", max: String(robots), step: "1" },
        `the first that are possible, of ${count(entries.length, "start and goal", "starts and goals")}`,
      ),
      radius: numberField("scenario-radius", "Radius", "m", defaults.radius, positive),
      linear_speed: numberField("scenario-speed", "Speed", "m/s", defaults.linear_speed, positive),
      angular_speed: numberField("scenario-turning", "Turning", "rad/s", defaults.angular_speed, positive),
    };
    const fields = Object.values(this.#fields).map(({ field }) => field);
    const grid = element("div", { class: "dialog-fields" }, ...fields);
    this.#dialog = new FormDialog(`Robots of ${name}`, "Import", grid, this.#preview.canvas, this.#status);
    for (const { input } of Object.values(this.#fields))
      input.addEventListener("input", () => this.#refresh());
  }

  /** Resolves to the request, or to null if it was cancelled. */
  async ask() {
    const sent = this.#dialog.ask();
    this.#refresh();
    return (await sent) ? this.#made.request : null;
  }

  cancel() {
    this.#dialog.cancel();
  }

  #refresh() {
    const { count: chosen, ...rest } = this.#fields;
    const filled = Object.values(this.#fields).every(
      ({ input }) => input.checkValidity() && input.valueAsNumber > 0,
    );
    const defaults = Object.fromEntries(
      Object.entries(rest).map(([key, { input }]) => [key, input.valueAsNumber]),
    );
    this.#made = filled
      ? scenarioRequest(this.#map, this.#entries, chosen.input.valueAsNumber, defaults)
      : null;
    const robots = this.#made?.request.robots ?? [];
    this.#dialog.ready = robots.length > 0;
    setText(this.#status, this.#made ? this.#inWords() : "Enter positive numbers in all fields.");
    this.#paint(robots.length, defaults.radius / this.#map.resolution);
  }

  #inWords() {
    const { request, passedOver } = this.#made;
    const taken = request.robots.length;
    const chosen = this.#fields.count.input.valueAsNumber;
    const { walls, overlaps } = passedOver;
    const reasons = [];
    if (walls > 0) reasons.push(`${walls} where the disk does not fit`);
    if (overlaps > 0) reasons.push(`${overlaps} where it overlaps an earlier one`);
    const outcome = taken < chosen ? `Only ${count(taken, "robot")} possible.` : `${count(taken, "robot")}.`;
    return reasons.length > 0 ? `${outcome} Skipped: ${reasons.join(", ")}.` : outcome;
  }

  #paint(robots, reach) {
    this.#preview.paint(
      this.#grid,
      [null, "wall"],
      `The map with the starts of ${count(robots, "robot")}`,
      (context, theme, place) => {
        this.#made?.cells.forEach(({ start, goal }, index) => {
          const colour = robotColour(index, theme.robotLightness);
          disk(context, place(goal.column, goal.row), reach, colour, 0.4);
          disk(context, place(start.column, start.row), reach, colour, 1);
        });
      },
    );
  }
}

function disk(context, { x, y, cell }, reach, colour, alpha) {
  context.globalAlpha = alpha;
  context.fillStyle = colour;
  context.beginPath();
  context.arc(x, y, Math.max(1.5, reach * cell), 0, 2 * Math.PI);
  context.fill();
  context.globalAlpha = 1;
}
