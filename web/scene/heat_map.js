// The heat map: squares of the map in one colour, the stronger the longer robots wait there, or the more pass.

import { heatOf } from "../model/heat.js";
import { contextOf } from "../ui/dom.js";

const STRONGEST = 0.85; // opacity
const FAINTEST = 0.12;

/** The opacity of a value among values up to `most`. The root spreads the small values. */
export function opacityOfHeat(value, most) {
  return value > 0 ? FAINTEST + (STRONGEST - FAINTEST) * Math.sqrt(value / most) : 0;
}

export class HeatMap {
  #canvas = document.createElement("canvas");
  #made = /** @type {any} */ ({}); // {tracks, kind, colour, heat}

  /** Draws the heat of a kind, see heatOf, under a camera that `screen` and `scale` are of. */
  draw(context, { grid, tracks, kind, colour, screen, scale }) {
    const { columns, rows, size } = this.#heat(grid, tracks, kind, colour);
    const corner = screen({ x: grid.bounds.left, y: grid.bounds.top });
    context.save();
    context.imageSmoothingEnabled = false;
    context.drawImage(this.#canvas, corner.x, corner.y, columns * size * scale, rows * size * scale);
    context.restore();
  }

  #heat(grid, tracks, kind, colour) {
    const made = this.#made;
    if (made.tracks === tracks && made.kind === kind && made.colour === colour) return made.heat;
    const heat = heatOf(grid, tracks.values(), kind);
    this.#made = { tracks, kind, colour, heat };
    Object.assign(this.#canvas, { width: heat.columns, height: heat.rows });
    const context = contextOf(this.#canvas);
    const image = context.createImageData(heat.columns, heat.rows);
    heat.values.forEach((value, at) => (image.data[4 * at + 3] = 255 * opacityOfHeat(value, heat.most)));
    context.putImageData(image, 0, 0);
    context.globalCompositeOperation = "source-in";
    context.fillStyle = colour;
    context.fillRect(0, 0, heat.columns, heat.rows);
    return heat;
  }
}
