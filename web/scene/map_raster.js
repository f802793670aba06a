// The map as images with one pixel per cell, made once, so that drawing it at any zoom takes a few copies.

import { contextOf, element } from "../ui/dom.js";
import { readTheme } from "./palette.js";

const TILE = 2048; // cells per side: supported by the canvases of all browsers
const MAX_CELLS = 2 ** 24; // larger previews would be slower than typing

/** A map as tiles: each cell in the colour of its value. */
export class MapRaster {
  /** @type {any} */
  #grid = null;
  #colours = "";
  #pixels = new Uint32Array(0); // the colours as the bytes of a pixel
  #tiles = []; // [{canvas, column, row, columns, rows}]

  /**
   * What to draw from now on: a grid (see readScene), which may be null. `colours`: CSS colours by the values of its
   * cells, null for clear. Only the changed rows of an edited grid are painted again.
   */
  show(grid, colours) {
    const before = this.#grid;
    const named = colours.join();
    if (grid === before && named === this.#colours) return;
    const alike = grid?.columns === before?.columns && grid?.rows === before?.rows;
    this.#grid = grid;
    if (named !== this.#colours || !alike) {
      this.#colours = named;
      this.#pixels = Uint32Array.from(colours, (colour) => (colour === null ? 0 : rgbaOf(colour)));
      this.#tiles = grid ? tilesOf(grid) : [];
      this.#paint(0, grid?.rows ?? 0);
    } else {
      this.#paint(...changedRows(before, grid));
    }
  }

  /**
   * Draws it; `left`, `top` is the map's upper left corner and `cell` a cell's side, in the context's pixels.
   */
  draw(context, left, top, cell) {
    context.imageSmoothingEnabled = cell < 1;
    context.imageSmoothingQuality = "high";
    const snap = (start, count) => Math.round(start + count * cell);
    for (const { canvas, column, row, columns, rows } of this.#tiles) {
      const x = snap(left, column);
      const y = snap(top, row);
      context.drawImage(canvas, x, y, snap(left, column + columns) - x, snap(top, row + rows) - y);
    }
  }

  /** Paints the rows from `begin` to before `end`. */
  #paint(begin, end) {
    for (const tile of this.#tiles) {
      const from = Math.max(begin, tile.row);
      const to = Math.min(end, tile.row + tile.rows);
      if (from < to) paintRows(tile, this.#grid, from, to, this.#pixels);
    }
  }
}

function tilesOf(grid) {
  const tiles = [];
  for (let row = 0; row < grid.rows; row += TILE) {
    for (let column = 0; column < grid.columns; column += TILE) {
      const columns = Math.min(TILE, grid.columns - column);
      const rows = Math.min(TILE, grid.rows - row);
      const canvas = document.createElement("canvas");
      canvas.width = columns;
      canvas.height = rows;
      tiles.push({ canvas, column, row, columns, rows });
    }
  }
  return tiles;
}

/** The range of rows that differ: from the first to after the last one. */
function changedRows(before, grid) {
  let begin = 0;
  let end = grid.rows;
  while (begin < end && grid.lines[begin] === before.lines[begin]) begin += 1;
  while (end > begin && grid.lines[end - 1] === before.lines[end - 1]) end -= 1;
  return [begin, end];
}

function paintRows({ canvas, column, row, columns }, grid, from, to, colours) {
  const context = contextOf(canvas);
  const image = context.createImageData(columns, to - from);
  const pixels = new Uint32Array(image.data.buffer);
  const { blocked } = grid;
  for (let y = from; y < to; y += 1) {
    const first = y * grid.columns + column;
    const at = (y - from) * columns;
    for (let x = 0; x < columns; x += 1) {
      pixels[at + x] = colours[blocked[first + x]];
    }
  }
  context.putImageData(image, 0, from - row);
}

/** A CSS colour as the bytes of a pixel. */
export function rgbaOf(colour) {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = 1;
  const context = contextOf(canvas);
  context.fillStyle = colour;
  context.fillRect(0, 0, 1, 1);
  return new Uint32Array(context.getImageData(0, 0, 1, 1).data.buffer)[0];
}

export class MapPreview {
  canvas = element("canvas", { class: "map-preview", role: "img" });

  /**
   * Paints a map of these cells, row by row from the top. `colours` are names in the theme by the values of cells, null
   * for the floor. `label` describes it. `mark(context, theme, place)` may add to it. place(column, row) is the middle
   * {x, y} of a cell with `cell`, a cell's side, in pixels.
   */
  paint({ columns, rows, cells }, colours, label, mark = /** @type {any} */ (null)) {
    const { canvas } = this;
    const ratio = window.devicePixelRatio || 1;
    canvas.setAttribute("aria-label", label);
    canvas.width = Math.round(canvas.clientWidth * ratio);
    canvas.height = Math.round(canvas.clientHeight * ratio);
    if (canvas.width === 0 || canvas.height === 0) return;
    const theme = readTheme();
    const context = contextOf(canvas);
    const cell = Math.min(canvas.width / columns, canvas.height / rows);
    const left = (canvas.width - columns * cell) / 2;
    const top = (canvas.height - rows * cell) / 2;
    context.fillStyle = theme.floor;
    context.fillRect(left, top, columns * cell, rows * cell);
    if (columns * rows <= MAX_CELLS) {
      const raster = new MapRaster();
      raster.show(
        { columns, rows, blocked: cells },
        colours.map((name) => name && theme[name]),
      );
      raster.draw(context, left, top, cell);
    }
    mark?.(context, theme, (column, row) => ({
      x: left + (column + 0.5) * cell,
      y: top + (row + 0.5) * cell,
      cell,
    }));
  }
}
