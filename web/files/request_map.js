// The maps of a request that are not rows of letters. They are read in the same way as by the service, to draw and edit
// them. Also makes an imported map the map of a request. It takes long for large maps, see map_work.js.

import { FileError } from "../model/problem.js";
import { readImage } from "./map_image.js";
import { readMovingAiMap } from "./movingai.js";
import {
  cellOf,
  classifyPixels,
  FREE,
  FREE_THRESH,
  mapOfGrid,
  OCCUPIED,
  OCCUPIED_THRESH,
  UNKNOWN,
} from "./ros_map.js";
import { quarterTurnsOf, turned } from "./turns.js";
import { writePng } from "./write_png.js";

const MAX_AS_ROWS = 250_000; // cells: the image of a larger map is a hundredth of its rows
const GRAYS = []; // of cells, as map_server writes them
GRAYS[FREE] = 254;
GRAYS[OCCUPIED] = 0;
GRAYS[UNKNOWN] = 205;

/**
 * A grid (see ros_map.js) as the map of a request: an image if it is large. Unknown cells are blocked or free. Resolves to
 * {map, rows}, with the map as one of rows.
 */
export async function requestMapOf(grid, unknownFree) {
  const rows = mapOfGrid(grid, unknownFree);
  if (grid.cells.length <= MAX_AS_ROWS) return { map: rows, rows };
  const { columns, resolution, origin } = grid;
  const png = await writePng(
    columns,
    grid.rows,
    grid.cells.map((cell) => GRAYS[cell]),
  );
  const image = {
    png: base64Of(png),
    resolution,
    origin: [origin.x, origin.y, 0],
    negate: 0,
    occupied_thresh: OCCUPIED_THRESH,
    free_thresh: FREE_THRESH,
    mode: "trinary",
  };
  return { map: { image, ...(unknownFree ? { unknown: "free" } : {}) }, rows };
}

function base64Of(bytes) {
  let text = "";
  for (let at = 0; at < bytes.length; at += 8192)
    text += String.fromCharCode(...bytes.subarray(at, at + 8192));
  return btoa(text);
}

/** A map of another kind as {rows, resolution, origin}; null if it cannot be read: the service reports its faults. */
export function readRequestMap(map) {
  return rowsOf(map).catch((error) => {
    if (error instanceof FileError) return null;
    throw error;
  });
}

/** The same; null if it is of no kind that can be read. Rejects with FileError. */
async function rowsOf(map) {
  if (typeof map.movingai === "string") return rowsOfMovingAi(map);
  const grid = isObject(map.image)
    ? await gridOfImage(map.image)
    : isObject(map.occupancy_grid)
      ? gridOfOccupancy(map.occupancy_grid)
      : null;
  return grid && mapOfGrid(grid, map.unknown === "free");
}

function rowsOfMovingAi({ movingai, resolution = 1, origin = { x: 0, y: 0 } }) {
  return { ...readMovingAiMap(movingai), resolution, origin };
}

async function gridOfImage(image) {
  const encoded = image.png ?? image.pgm;
  const [x = 0, y = 0, yaw = 0] = Array.isArray(image.origin) ? image.origin : [];
  const quarterTurns = quarterTurnsOf(yaw);
  if (typeof encoded !== "string" || !(image.resolution > 0) || quarterTurns === null) return null;
  const described = {
    negate: image.negate === true || image.negate === 1,
    occupiedThresh: image.occupied_thresh ?? OCCUPIED_THRESH,
    freeThresh: image.free_thresh ?? FREE_THRESH,
    mode: image.mode ?? "trinary",
    release: image.release,
    resolution: image.resolution,
    origin: { x, y },
    quarterTurns,
  };
  return classifyPixels(described, await readImage(bytesOfBase64(encoded)));
}

/** The bytes of a text in base64. Throws FileError. */
export function bytesOfBase64(text) {
  let binary;
  try {
    binary = atob(text);
  } catch {
    throw new FileError("It is not base64.");
  }
  const bytes = new Uint8Array(binary.length); // a loop, as large images take a second otherwise
  for (let at = 0; at < bytes.length; at += 1) bytes[at] = binary.charCodeAt(at);
  return bytes;
}

/** Row by row from the bottom; -1 to 100 a cell. */
function gridOfOccupancy({ info, data }) {
  const [columns, rows, resolution] = [info?.width, info?.height, info?.resolution];
  const isWhole = Number.isInteger(columns) && Number.isInteger(rows) && resolution > 0;
  if (!isWhole || !Array.isArray(data) || data.length !== columns * rows) return null;
  const cells = new Uint8Array(columns * rows);
  for (let row = 0; row < rows; row += 1) {
    for (let column = 0; column < columns; column += 1) {
      cells[(rows - 1 - row) * columns + column] = cellOfGiven(data[row * columns + column]);
    }
  }
  const { x = 0, y = 0 } = info.origin?.position ?? {};
  const quarterTurns = turnsOfOrientation(info.origin?.orientation);
  if (quarterTurns === null) return null;
  return { ...turned({ columns, rows, cells }, resolution, { x, y }, quarterTurns), resolution };
}

function turnsOfOrientation({ z = 0, w = 1 } = {}) {
  return quarterTurnsOf(z === 0 ? 0 : 2 * Math.atan2(z, w));
}

/** Where the raster of a map lies: {resolution, corner, quarterTurns}; null if that cannot be read. */
export function placeOfMap(map) {
  if (isObject(map?.image)) {
    const [x = 0, y = 0, yaw = 0] = Array.isArray(map.image.origin) ? map.image.origin : [];
    return { resolution: map.image.resolution, corner: { x, y }, quarterTurns: quarterTurnsOf(yaw) ?? 0 };
  }
  const info = map?.occupancy_grid?.info;
  if (isObject(info)) {
    const { x = 0, y = 0 } = info.origin?.position ?? {};
    const quarterTurns = turnsOfOrientation(info.origin?.orientation) ?? 0;
    return { resolution: info.resolution, corner: { x, y }, quarterTurns };
  }
  const { resolution = 1, origin } = map ?? {};
  return { resolution, corner: { x: origin?.x ?? 0, y: origin?.y ?? 0 }, quarterTurns: 0 };
}

const cellOfGiven = (percent) => cellOf(percent < 0 ? null : percent);

const isObject = (value) => value !== null && typeof value === "object";
