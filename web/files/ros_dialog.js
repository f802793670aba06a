// The dialog of a ROS map: its unknown cells, its margin, and how many cells are merged.

import { MapPreview } from "../scene/map_raster.js";
import { element, setText } from "../ui/dom.js";
import { FormDialog, numberField } from "../ui/form_dialog.js";
import { metres } from "../ui/format.js";
import { requestMapOf } from "./request_map.js";
import { countCells, mergeCells, OCCUPIED, smallestFactor, trimUnknown, UNKNOWN } from "./ros_map.js";

const MOST_MERGED = 100; // cells per side that are merged into one

export class RosMapDialog {
  #whole;
  #trimmed;
  #most;
  #preview = new MapPreview();
  #status = element("p", { class: "dialog-status", role: "status" });
  #unknownFree = element("input", { type: "checkbox", id: "ros-unknown-free" });
  #trim = element("input", { type: "checkbox", id: "ros-trim", checked: true });
  #merge;
  #dialog;
  /** @type {any} */
  #made = null; // a grid for the current fields; null while one is invalid

  /** `grid`: see classifyPixels; at most `most` cells; `warnings` are shown. */
  constructor(name, grid, warnings, most) {
    this.#whole = grid;
    this.#trimmed = trimUnknown(grid);
    this.#most = most;
    this.#merge = numberField(
      "ros-merge",
      "Cells merged into one",
      "a side",
      smallestFactor(this.#trimmed, most),
      { min: "1", max: String(MOST_MERGED), step: "1" },
      "A merged cell is blocked if any of its cells is.",
    );
    const notes = warnings.map((textContent) => element("li", { textContent }));
    this.#dialog = new FormDialog(
      `Map of ${name}`,
      "Import",
      notes.length > 0 ? element("ul", { class: "warnings", "aria-label": "Warnings" }, ...notes) : null,
      element("p", { textContent: inWords(grid) }),
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

  /** Resolves to the map of a request, or to null if it was cancelled. */
  async ask() {
    const sent = this.#dialog.ask();
    this.#refresh();
    return (await sent) ? requestMapOf(this.#made, this.#unknownFree.checked) : null;
  }

  cancel() {
    this.#dialog.cancel();
  }

  #refresh() {
    const { input } = this.#merge;
    const source = this.#trim.checked ? this.#trimmed : this.#whole;
    const made = input.checkValidity() ? mergeCells(source, input.valueAsNumber) : null;
    const fits = made !== null && made.cells.length <= this.#most;
    this.#made = made;
    this.#dialog.ready = fits;
    this.#status.classList.toggle("wrong", !fits);
    setText(this.#status, made ? this.#outcome(source) : `Merge 1 to ${MOST_MERGED} cells a side.`);
    if (made) this.#paint(made);
  }

  #outcome(source) {
    const { columns, rows, cells, resolution, origin } = this.#made;
    const total = cells.length.toLocaleString("en");
    const size = `${columns} × ${rows} = ${total} cells of ${metres(resolution)}`;
    const most = this.#most.toLocaleString("en");
    if (cells.length > this.#most)
      return `${size}: the service accepts at most ${most}. Merge at least ${smallestFactor(source, this.#most)}.`;
    const counts = countCells(this.#made);
    const blocked = counts[OCCUPIED] + (this.#unknownFree.checked ? 0 : counts[UNKNOWN]);
    const limit = Number.isFinite(this.#most) ? ` (at most ${most})` : "";
    return (
      `${size}${limit}, ${percent(blocked, cells.length)} blocked; ` +
      `lower-left corner at (${origin.x}, ${origin.y}) m.`
    );
  }

  #paint(made) {
    const layerOf = (kind, colour) => ({ cells: made.cells.map((cell) => (cell === kind ? 1 : 0)), colour });
    const unknown = layerOf(UNKNOWN, this.#unknownFree.checked ? "void" : "wall");
    this.#preview.paint(made, [layerOf(OCCUPIED, "wall"), unknown], "The map as imported");
  }
}

function inWords(grid) {
  const unknown = percent(countCells(grid)[UNKNOWN], grid.cells.length);
  return `${grid.columns} × ${grid.rows} pixels of ${metres(grid.resolution)}, ${unknown} unknown.`;
}

function percent(part, whole) {
  return `${Math.round((100 * part) / whole)} %`;
}

function tick(input, text) {
  return element("label", { class: "tick" }, input, text);
}
