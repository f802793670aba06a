// The dialog of a ROS map: its unknown cells, its margin, and how many cells are merged.

import { rememberRows } from "../model/drawn_map.js";
import { MapPreview } from "../scene/map_raster.js";
import { element, setText } from "../ui/dom.js";
import { FormDialog, numberField } from "../ui/form_dialog.js";
import { grouped, metres } from "../ui/format.js";
import { FREE, OCCUPIED, smallestFactor, UNKNOWN } from "./ros_map.js";

const MAX_MERGED = 100; // cells per side that are merged into one

export class RosMapDialog {
  #whole;
  #trimmed;
  #most;
  #work;
  #preview = new MapPreview();
  #status = element("p", { class: "dialog-status", role: "status" });
  #unknownFree = element("input", { type: "checkbox", id: "ros-unknown-free" });
  #trim = element("input", { type: "checkbox", id: "ros-trim", checked: true });
  #merge;
  #dialog;
  #turn = 0; // counts changes of the fields
  /** @type {any} */
  #made = null; // {grid, counts} for the current fields; null while one is invalid, and until it is made
  #failure = /** @type {any} */ (null);

  /**
   * `read`: see readRosImage of `work`, MAP_WORK; at most `most` cells; `warnings` are shown.
   */
  constructor(name, { whole, trimmed, counts }, warnings, most, work) {
    this.#whole = whole;
    this.#trimmed = trimmed;
    this.#most = most;
    this.#work = work;
    this.#merge = numberField(
      "ros-merge",
      "Cells merged into one",
      "per side",
      smallestFactor(this.#trimmed, most),
      { min: "1", max: String(MAX_MERGED), step: "1" },
      "A merged cell is blocked if any of its cells is.",
    );
    const notes = warnings.map((textContent) => element("li", { textContent }));
    this.#dialog = new FormDialog(
      `Map of ${name}`,
      "Import",
      notes.length > 0 ? element("ul", { class: "warnings", "aria-label": "Warnings" }, ...notes) : null,
      element("p", { textContent: inWords(whole, counts) }),
      tick(this.#unknownFree, "Unknown cells are free (otherwise blocked)"),
      tick(this.#trim, "Crop the unknown margin"),
      this.#merge.field,
      this.#preview.canvas,
      this.#status,
    );
    for (const input of [this.#unknownFree, this.#trim, this.#merge.input]) {
      input.addEventListener("input", () => this.#refresh());
    }
  }

  /** Resolves to the map of a request, or to null if it was cancelled. Rejects with FileError. */
  async ask() {
    const sent = this.#dialog.ask();
    this.#refresh();
    const isSent = await sent;
    if (this.#failure !== null) throw this.#failure;
    if (!isSent) return null;
    const { map, rows } = await this.#work.requestMapOf(this.#made.grid, this.#unknownFree.checked);
    rememberRows(map, rows);
    return map;
  }

  cancel() {
    this.#dialog.cancel();
  }

  async #refresh() {
    const turn = (this.#turn += 1);
    const { input } = this.#merge;
    const source = this.#trim.checked ? this.#trimmed : this.#whole;
    this.#dialog.ready = false;
    const made = input.checkValidity() ? await this.#merged(source, input.valueAsNumber) : null;
    if (turn !== this.#turn || this.#failure !== null) return;
    const fits = made !== null && made.grid.cells.length <= this.#most;
    this.#made = made;
    this.#dialog.ready = fits;
    this.#status.classList.toggle("wrong", !fits);
    setText(this.#status, made ? this.#outcome(source, made) : `Merge 1 to ${MAX_MERGED} cells per side.`);
    if (made) this.#paint(made.grid);
  }

  async #merged(source, factor) {
    try {
      return await this.#work.mergeCells(source, factor);
    } catch (error) {
      this.#failure = error;
      this.#dialog.cancel();
      return null;
    }
  }

  #outcome(source, { grid, counts }) {
    const { columns, rows, cells, resolution, origin } = grid;
    const total = grouped(cells.length);
    const size = `${columns} × ${rows} = ${total} cells of ${metres(resolution)}`;
    const most = grouped(this.#most);
    if (cells.length > this.#most)
      return `${size}: the service accepts at most ${most}. Merge at least ${smallestFactor(source, this.#most)}.`;
    const blocked = counts[OCCUPIED] + (this.#unknownFree.checked ? 0 : counts[UNKNOWN]);
    const limit = Number.isFinite(this.#most) ? ` (at most ${most})` : "";
    return (
      `${size}${limit}, ${percent(blocked, cells.length)} blocked; ` +
      `lower-left corner at (${origin.x}, ${origin.y}) m.`
    );
  }

  #paint(grid) {
    const colours = [];
    colours[FREE] = null;
    colours[OCCUPIED] = "wall";
    colours[UNKNOWN] = this.#unknownFree.checked ? "void" : "wall";
    this.#preview.paint(grid, colours, "The map as imported");
  }
}

function inWords(grid, counts) {
  const unknown = percent(counts[UNKNOWN], grid.cells.length);
  return `${grid.columns} × ${grid.rows} pixels of ${metres(grid.resolution)}, ${unknown} unknown.`;
}

function percent(part, whole) {
  return `${Math.round((100 * part) / whole)} %`;
}

function tick(input, text) {
  return element("label", { class: "tick" }, input, text);
}
