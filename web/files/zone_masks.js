// The masks of zones, read in the same way as by the service, to draw them. It takes long for large masks, see
// map_work.js.

import { FileError } from "../model/problem.js";
import { readImage } from "./map_image.js";
import { bytesOfBase64, placeOfMap } from "./request_map.js";
import { FREE_THRESH, OCCUPIED_THRESH, occupancyOf } from "./ros_map.js";
import { quarterTurnsOf, turned } from "./turns.js";

const BASE = 100; // percent, as in nav2_bringup
const MULTIPLIER = -1;

/**
 * What a mask on a map of a request looks like: {columns, rows, percents, limits, bounds}, row by row from the top.
 * Null if it cannot be read: the service reports its faults.
 *
 * - `percents`: the percentage of each pixel, 0 for unknown pixels
 * - `limits`: by percentage, the percent of a robot's speed, 0 if there is no limit
 * - `bounds`: in the world
 */
export async function readMask(mask, map) {
  const encoded = mask.png ?? mask.pgm;
  if (typeof encoded !== "string") return null;
  const place = placeOf(mask, map);
  if (place === null) return null;
  try {
    return drawn(mask, place, await readImage(bytesOfBase64(encoded)));
  } catch (error) {
    if (error instanceof FileError) return null;
    throw error;
  }
}

/** Where the mask lies. What it does not say is as of the map. */
function placeOf(mask, map) {
  const { resolution, corner, quarterTurns } = placeOfMap(map);
  const [x, y, yaw] = Array.isArray(mask.origin) ? mask.origin : [];
  const place = { resolution: mask.resolution ?? resolution, corner, quarterTurns };
  if (Array.isArray(mask.origin))
    Object.assign(place, { corner: { x, y }, quarterTurns: quarterTurnsOf(yaw) });
  const isPlaced = Number.isFinite(place.corner.x) && Number.isFinite(place.corner.y);
  return isPlaced && place.resolution > 0 && place.quarterTurns !== null ? place : null;
}

function drawn(mask, { resolution, corner, quarterTurns }, { width, height, channels, largest, values }) {
  const described = {
    negate: mask.negate === true || mask.negate === 1,
    occupiedThresh: mask.occupied_thresh ?? OCCUPIED_THRESH,
    freeThresh: mask.free_thresh ?? FREE_THRESH,
    mode: mask.mode ?? "trinary",
    release: mask.release,
  };
  const cells = new Uint8Array(width * height);
  for (let at = 0; at < cells.length; at += 1) {
    const pixel = values.subarray(at * channels, (at + 1) * channels);
    cells[at] = occupancyOf(described, pixel, largest) ?? 0;
  }
  const raster = turned({ columns: width, rows: height, cells }, resolution, corner, quarterTurns);
  const { columns, rows, origin } = raster;
  const bounds = {
    left: origin.x,
    bottom: origin.y,
    right: origin.x + columns * resolution,
    top: origin.y + rows * resolution,
  };
  const isFramed = mask.resolution !== undefined || mask.origin !== undefined;
  return { columns, rows, percents: raster.cells, limits: limitsOf(mask), bounds, resolution, isFramed };
}

/** By percentage the limit that it makes; 0 for none, as in Nav2 what is not from 0 to 100 percent. */
function limitsOf({ base = BASE, multiplier = MULTIPLIER }) {
  const limits = new Uint8Array(101);
  for (let percent = 1; percent <= 100; percent += 1) {
    const limit = base + multiplier * percent;
    limits[percent] = limit > 0 && limit <= 100 ? Math.ceil(limit) : 0;
  }
  return limits;
}
