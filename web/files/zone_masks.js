// The masks of zones, read as the service reads them, to draw them: images with one pixel for each cell of the map.

import { rememberMask, maskOf } from "../model/drawn_map.js";
import { zonesOf } from "../model/listed.js";
import { FileError } from "../model/problem.js";
import { readImage } from "./map_image.js";
import { bytesOfBase64 } from "./request_map.js";
import { FREE_THRESH, OCCUPIED_THRESH, occupancyOf } from "./ros_map.js";

/** Reads the masks of a request's zones. One that cannot be read is not drawn; the service reports its faults. */
export async function prepareMasks(request) {
  const masks = zonesOf(request)
    .map((zone) => zone?.mask)
    .filter((mask) => isObject(mask) && maskOf(mask) === null);
  await Promise.all(masks.map(prepareMask));
}

async function prepareMask(mask) {
  const encoded = mask.png ?? mask.pgm;
  if (typeof encoded !== "string") return;
  try {
    rememberMask(mask, percentages(mask, await readImage(bytesOfBase64(encoded))));
  } catch (error) {
    if (!(error instanceof FileError)) throw error;
  }
}

/** The percentages of the pixels, row by row from the top, 0 for unknown ones: {columns, rows, percents}. */
export function percentages(mask, { width, height, channels, largest, values }) {
  const described = {
    negate: mask.negate === true || mask.negate === 1,
    occupiedThresh: mask.occupied_thresh ?? OCCUPIED_THRESH,
    freeThresh: mask.free_thresh ?? FREE_THRESH,
    mode: mask.mode ?? "trinary",
  };
  const percents = new Uint8Array(width * height);
  for (let at = 0; at < percents.length; at += 1) {
    const pixel = values.subarray(at * channels, (at + 1) * channels);
    percents[at] = occupancyOf(described, pixel, largest) ?? 0;
  }
  return { columns: width, rows: height, percents };
}

const isObject = (value) => value !== null && typeof value === "object";
