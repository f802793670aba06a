// How long a robot takes to the squares of a map, as colours: bands of times, and stripes where there is no way.

import { bandOf, bandsUpTo, shadeOf } from "../model/travel_field.js";
import { contextOf } from "../ui/dom.js";
import { rgbaOf } from "./map_raster.js";

const PIXELS = 4; // along a side of a square, for its stripes

export class TravelMap {
  #canvas = document.createElement("canvas");
  /** @type {any} */
  #shown = null; // what Stage.look has: {field}, or null
  #theme = /** @type {any} */ (null);

  /** What to draw from now on, see Stage.look, under a theme. */
  show(travel, theme) {
    if (travel === this.#shown && theme === this.#theme) return;
    this.#shown = travel;
    this.#theme = theme;
    if (travel !== null) this.#paint(travel.field, theme);
  }

  /** Draws it on a map of so many columns and rows; `left`, `top`, `width` and `height` are its place in the context's pixels. */
  draw(context, { columns, rows }, { left, top, width, height }) {
    if (this.#shown === null) return;
    const { field } = this.#shown;
    const [across, down] = [(width / columns) * field.cells, (height / rows) * field.cells]; // of a square
    context.save();
    context.beginPath();
    context.rect(left, top, width, height); // the last squares may be larger than the map
    context.clip();
    context.imageSmoothingEnabled = across < PIXELS;
    context.drawImage(this.#canvas, left, top, field.columns * across, field.rows * down);
    context.restore();
  }

  #paint(field, theme) {
    const { columns, rows } = field;
    const width = columns * PIXELS;
    Object.assign(this.#canvas, { width, height: rows * PIXELS });
    const context = contextOf(this.#canvas);
    const image = context.createImageData(width, rows * PIXELS);
    const pixels = new Uint32Array(image.data.buffer);
    const bands = bandsUpTo(field.most);
    const shades = theme.travel.map(rgbaOf);
    const stripe = rgbaOf(theme.muted);
    for (let row = 0; row < rows; row += 1) {
      for (let column = 0; column < columns; column += 1) {
        const time = field.timeTo(column, row);
        if (time === null) continue;
        const isStriped = time.seconds === Infinity;
        const colour = isStriped ? stripe : shades[shadeOf(bandOf(time.seconds, bands), bands.count)];
        fillSquare(pixels, width, { x: column * PIXELS, y: row * PIXELS }, colour, isStriped);
      }
    }
    context.putImageData(image, 0, 0);
  }
}

function fillSquare(pixels, width, { x, y }, colour, isStriped) {
  for (let down = 0; down < PIXELS; down += 1) {
    for (let across = 0; across < PIXELS; across += 1) {
      if (isStriped && (across + down) % PIXELS !== 0) continue;
      pixels[(y + down) * width + x + across] = colour;
    }
  }
}
