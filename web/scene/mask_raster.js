// Masks of zones as images with one pixel per cell, made once for each mask and theme.

import { OCCUPIED } from "../model/zones.js";
import { contextOf } from "../ui/dom.js";

const STRONGEST = 150; // opacity of a blocked or the slowest cell, of 255

/** The opacity of a cell of so many percent: full if blocked; of a limited speed, the stronger the slower. */
export function opacityOf(type, percent) {
  if (type === "blocked") return percent >= OCCUPIED ? STRONGEST : 0;
  return percent > 0 ? Math.round(STRONGEST * (1 - (percent - 1) / 110)) : 0;
}

const made = new WeakMap(); // mask -> {key, canvas}

/** The image of a mask (see zone_masks.js) in a colour. */
export function rasterOf(mask, type, colour) {
  const key = `${type} ${colour}`;
  const known = made.get(mask);
  if (known?.key === key) return known.canvas;
  const canvas = document.createElement("canvas");
  Object.assign(canvas, { width: mask.columns, height: mask.rows });
  const context = contextOf(canvas);
  const image = context.createImageData(mask.columns, mask.rows);
  const percentOf = (percent) => (type === "speed" ? mask.limits[percent] : percent);
  mask.percents.forEach((percent, at) => (image.data[4 * at + 3] = opacityOf(type, percentOf(percent))));
  context.putImageData(image, 0, 0);
  context.globalCompositeOperation = "source-in";
  context.fillStyle = colour;
  context.fillRect(0, 0, mask.columns, mask.rows);
  made.set(mask, { key, canvas });
  return canvas;
}
