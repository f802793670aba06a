// What takes long when large maps are opened: reading images, converting millions of cells. The page has it done in a
// worker, see map_worker.js.

import { readImage } from "./map_image.js";
import { readMovingAiMap } from "./movingai.js";
import { readRequestMap, requestMapOf } from "./request_map.js";
import { classifyPixels, countCells, mergeCells, trimUnknown } from "./ros_map.js";
import { readMask } from "./zone_masks.js";

/** The functions by their names. Each may resolve to its result. Functions that read files reject with FileError. */
export const MAP_WORK = {
  readMask,
  readMovingAiMap,
  readRequestMap,
  requestMapOf,

  /** The grid of an image (see classifyPixels): {whole, trimmed, counts}, see trimUnknown and countCells. */
  async readRosImage(described, bytes) {
    const whole = classifyPixels(described, await readImage(bytes));
    return { whole, trimmed: trimUnknown(whole), counts: countCells(whole) };
  },

  /** The grid with merged cells: {grid, counts}, see mergeCells and countCells. */
  mergeCells(grid, factor) {
    const merged = mergeCells(grid, factor);
    return { grid: merged, counts: countCells(merged) };
  },
};
