// A small picture of a map that is about to be imported.

import { MapRaster } from "../scene/map_raster.js";
import { readTheme } from "../scene/palette.js";
import { element } from "../ui/dom.js";

const MOST_CELLS = 2 ** 24; // to paint as fast as one types

export class MapPreview {
  canvas = element("canvas", { class: "map-preview", role: "img" });

  /**
   * Paints a map of so many cells. `layers` says which in which colour: [{cells, colour}], `cells` row by row
   * from the top, 0 for none, `colour` a name in the theme. `label` describes it. `mark(context, theme, place)`
   * may add to it, where place(column, row) is the middle of a cell {x, y} with `cell`, a cell's side, in pixels.
   */
  paint({ columns, rows }, layers, label, mark = () => {}) {
    const { canvas } = this;
    const ratio = window.devicePixelRatio || 1;
    canvas.setAttribute("aria-label", label);
    canvas.width = Math.round(canvas.clientWidth * ratio);
    canvas.height = Math.round(canvas.clientHeight * ratio);
    if (canvas.width === 0 || canvas.height === 0) return;
    const theme = readTheme();
    const context = canvas.getContext("2d");
    const cell = Math.min(canvas.width / columns, canvas.height / rows);
    const left = (canvas.width - columns * cell) / 2;
    const top = (canvas.height - rows * cell) / 2;
    context.fillStyle = theme.floor;
    context.fillRect(left, top, columns * cell, rows * cell);
    for (const { cells, colour } of columns * rows <= MOST_CELLS ? layers : []) {
      const raster = new MapRaster();
      raster.show({ columns, rows, blocked: cells }, theme[colour]);
      raster.draw(context, left, top, cell);
    }
    mark(context, theme, (column, row) => ({
      x: left + (column + 0.5) * cell,
      y: top + (row + 0.5) * cell,
      cell,
    }));
  }
}
