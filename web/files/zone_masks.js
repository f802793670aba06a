// The masks of zones, read as the service reads them, to draw them: images with one pixel for each cell of the map. It
// takes long for large ones, see map_work.js.

import { FileError } from "../model/problem.js";
import { readImage } from "./map_image.js";
import { bytesOfBase64 } from "./request_map.js";
import { FREE_THRESH, OCCUPIED_THRESH, occupancyOf } from "./ros_map.js";

/** What a mask looks like, see percentages; null if it cannot be read: the service reports its faults. */
export async function readMask(mask) {
  const encoded = mask.png ?? mask.pgm;
  if (typeof encoded !== "string") return null;
  try {
    return percentages(mask, await readImage(bytesOfBase64(encoded)));
  } catch (error) {
    if (error instanceof FileError) return null;
    throw error;
  }
}

/** The percentages of the pixels, row by row from the top, 0 for unknown ones: {columns, rows, percents}. */
function percentages(mask, { width, height, channels, largest, values }) {
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
