// Maps of a request that are not rows of letters: images, occupancy grids, texts of MovingAI. They are read once, when
// they are opened, and remembered as rows. So everything that draws or edits a map sees rows. The same holds for masks
// of zones.

/** @import {Mask, RequestMap} from "./types.js" */

/** @type {WeakMap<object, RequestMap>} */
const drawn = new WeakMap();

/** Remembers what a map of another kind looks like: {rows, resolution, origin}. */
export function rememberRows(map, rows) {
  drawn.set(map, rows);
}

/** The map as one with `rows`: itself, what is remembered of it, or null. */
export function asRows(map) {
  if (map === null || typeof map !== "object") return null;
  return Array.isArray(map.rows) ? map : (drawn.get(map) ?? null);
}

/** @type {WeakMap<object, Mask>} */
const masks = new WeakMap();

/** Remembers what the mask of a zone looks like. */
export function rememberMask(mask, cells) {
  masks.set(mask, cells);
}

/** What is remembered of a mask, or null. */
export function maskOf(mask) {
  return masks.get(mask) ?? null;
}
