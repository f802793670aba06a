// Maps of ROS: a map.yaml and its image as the map of a request, interpreted as in map_server of Jazzy and later, or of
// Humble.
//
// A grid here is {columns, rows, cells, resolution, origin}: `cells` row by row from the top, `resolution` in
// metres, `origin` {x, y} the lower-left corner.

import { FileError } from "../model/problem.js";
import { plusTimes } from "./text.js";
import { quarterTurnsOf, turned } from "./turns.js";
import { readYaml } from "./yaml.js";

export const FREE = 0;
export const OCCUPIED = 1;
export const UNKNOWN = 2;

export const OCCUPIED_THRESH = 0.65; // as in the files that map_server writes
export const FREE_THRESH = 0.196;
const LEAST_OCCUPIED = 65; // percent, as in the service
const MAX_FREE = 25;
const NOT_KNOWN = 255; // no cell
const MODES = ["trinary", "scale", "raw"];

/**
 * The content of a map.yaml: {image, resolution, origin: {x, y}, quarterTurns, negate, occupiedThresh, freeThresh,
 * mode, warnings}. Throws FileError.
 */
export function readRosYaml(text) {
  const given = readYaml(text);
  const warnings = [];
  const image = String(given.image ?? "");
  if (image === "")
    throw new FileError('It names no image; a map.yaml of ROS has a line like "image: map.pgm".');
  const resolution = numberIn(given, "resolution");
  if (!(resolution > 0))
    throw new FileError(`resolution is ${resolution}; it must be in metres per pixel and greater than 0.`);
  const origin = given.origin;
  if (!Array.isArray(origin) || origin.length < 2 || !origin.every(Number.isFinite))
    throw new FileError("origin must be a list of numbers: [x, y, yaw] of the lower-left pixel.");
  const yaw = origin[2] ?? 0;
  const quarterTurns = quarterTurnsOf(yaw);
  if (quarterTurns === null)
    throw new FileError(
      `the map is turned by ${yaw} rad (the yaw of its origin), which is no quarter turn. Turn the image, ` +
        "or set the yaw to 0 and give all poses in the frame of the image.",
    );
  const mode = given.mode ?? "trinary";
  if (!MODES.includes(mode)) throw new FileError(`mode is ${mode}; map_server knows ${MODES.join(", ")}.`);
  const described = {
    image,
    resolution,
    origin: { x: origin[0], y: origin[1] },
    quarterTurns,
    negate: given.negate === true || given.negate === 1,
    occupiedThresh: thresholdIn(given, "occupied_thresh", OCCUPIED_THRESH, warnings),
    freeThresh: thresholdIn(given, "free_thresh", FREE_THRESH, warnings),
    mode,
    warnings,
  };
  if (described.freeThresh > described.occupiedThresh)
    throw new FileError("free_thresh is above occupied_thresh; swap them.");
  return described;
}

function numberIn(given, key) {
  if (Number.isFinite(given[key])) return given[key];
  const found = given[key] === undefined ? "is missing" : `is ${given[key]}`;
  throw new FileError(`${key} ${found}; it must be a number.`);
}

function thresholdIn(given, key, otherwise, warnings) {
  if (given[key] === undefined) {
    warnings.push(`${key} is missing; ${otherwise} is used, as in map_server's own files.`);
    return otherwise;
  }
  const threshold = numberIn(given, key);
  if (threshold >= 0 && threshold <= 1) return threshold;
  throw new FileError(`${key} is ${threshold}; it must be from 0 to 1.`);
}

/**
 * The grid of FREE, OCCUPIED and UNKNOWN cells for pixels from the top: {width, height, channels, largest, values}. It
 * equals the service's grid for such an image. The channels of a pixel are from 0 to `largest`. They are gray; gray and
 * alpha; red, green and blue; or red, green, blue and alpha.
 */
export function classifyPixels(described, { width, height, channels, largest, values }) {
  const { resolution, origin } = described;
  const cells = new Uint8Array(width * height);
  const cellAt = (at) => cellOf(occupancyOf(described, values.subarray(at, at + channels), largest));
  const known = new Uint8Array(largest + 1).fill(NOT_KNOWN); // by gray
  for (let index = 0; index < cells.length; index += 1) {
    if (channels > 1) {
      cells[index] = cellAt(index * channels);
    } else {
      if (known[values[index]] === NOT_KNOWN) known[values[index]] = cellAt(index);
      cells[index] = known[values[index]];
    }
  }
  const place = turned(
    { columns: width, rows: height, cells },
    resolution,
    origin,
    described.quarterTurns ?? 0,
  );
  return { ...place, resolution };
}

/** The percentage that map_server publishes for a pixel, or null if it is unknown. */
export function occupancyOf(described, pixel, largest) {
  if (described.release === "humble") return occupancyOfHumble(described, pixel, largest);
  const { negate, mode } = described;
  if (pixel.length % 2 === 0 && pixel[pixel.length - 1] < largest) return null; // not opaque
  const gray = grayOf(pixel, largest);
  if (mode === "raw") return gray <= 100 ? gray : null;
  const single = Math.fround; // map_server computes in single precision
  const shade = single(gray / 255);
  const occupied = negate ? shade : single(1 - shade);
  const [most, least] = [single(described.freeThresh), single(described.occupiedThresh)];
  if (occupied <= most) return 0;
  if (occupied >= least) return 100;
  if (mode === "trinary") return null;
  const range = single(described.occupiedThresh - described.freeThresh);
  const share = single(single(occupied - most) / range);
  return Math.min(100, Math.round(single(share * 100)));
}

/** The gray of a pixel, 0 to 255: the luma of Rec. 601 in 16 bits, rounded, of which the upper 8 bits are taken. */
function grayOf(pixel, largest) {
  const wide = (channel) => Math.floor((2 * 65535 * channel + largest) / (2 * largest));
  if (pixel.length < 3) return Math.floor(wide(pixel[0]) / 257);
  const luma = 299 * wide(pixel[0]) + 587 * wide(pixel[1]) + 114 * wide(pixel[2]) + 500;
  return Math.floor(Math.floor(luma / 1000) / 257);
}

function occupancyOfHumble(described, pixel, largest) {
  const { negate, occupiedThresh, freeThresh, mode } = described;
  const alpha = pixel.length % 2 === 0 ? pixel[pixel.length - 1] : null;
  const sum = pixel.length < 3 ? 3 * pixel[0] : pixel[0] + pixel[1] + pixel[2];
  if (mode === "scale" && alpha !== null && alpha < largest) return null;
  const mean = mode === "trinary" && alpha !== null ? (sum + alpha) / 4 : sum / 3; // alpha counts as a colour
  const shade = mean / largest;
  if (mode === "raw") {
    const percent = Math.round(shade * 255);
    return percent <= 100 ? percent : null;
  }
  const occupied = negate ? shade : 1 - shade;
  if (occupied > occupiedThresh) return 100;
  if (occupied < freeThresh) return 0;
  if (mode === "trinary" || occupiedThresh <= freeThresh) return null;
  return ((occupied - freeThresh) / (occupiedThresh - freeThresh)) * 100; // rounded by map_server, see cellOf
}

/** The cell of a percentage, or of null. Humble rounds: 64.5 to the even 64, which is unknown, and 25.5 to 26. */
export function cellOf(percent) {
  if (percent === null) return UNKNOWN;
  if (percent > LEAST_OCCUPIED - 0.5) return OCCUPIED;
  return percent < MAX_FREE + 0.5 ? FREE : UNKNOWN;
}

/** How many cells are free, occupied and unknown, in that order. */
export function countCells({ cells }) {
  const counts = [0, 0, 0];
  for (const cell of cells) counts[cell] += 1;
  return counts;
}

/** The grid without wholly unknown rows and columns at its edges; the grid itself if all of it is unknown. */
export function trimUnknown(grid) {
  const { columns, rows, cells } = grid;
  let [left, right, top, bottom] = [columns, -1, rows, -1];
  for (let row = 0; row < rows; row += 1) {
    for (let column = 0; column < columns; column += 1) {
      if (cells[row * columns + column] === UNKNOWN) continue;
      left = Math.min(left, column);
      right = Math.max(right, column);
      top = Math.min(top, row);
      bottom = row;
    }
  }
  if (right === -1) return grid;
  const width = right - left + 1;
  const kept = new Uint8Array(width * (bottom - top + 1));
  for (let row = top; row <= bottom; row += 1) {
    const first = row * columns + left;
    kept.set(cells.subarray(first, first + width), (row - top) * width);
  }
  const origin = {
    x: plusTimes(grid.origin.x, left, grid.resolution),
    y: plusTimes(grid.origin.y, rows - 1 - bottom, grid.resolution),
  };
  return { ...grid, columns: width, rows: bottom - top + 1, cells: kept, origin };
}

/**
 * The grid with `factor` × `factor` cells merged into one, starting at the lower-left corner, which stays in place. A
 * merged cell is occupied if any cell is occupied or not on the map. Otherwise, it is unknown if any cell is unknown.
 */
export function mergeCells(grid, factor) {
  const columns = Math.ceil(grid.columns / factor);
  const rows = Math.ceil(grid.rows / factor);
  const cells = new Uint8Array(columns * rows);
  const beyond = rows * factor - grid.rows; // rows of the top merged row beyond the map
  for (let row = 0; row < grid.rows; row += 1) {
    const target = Math.floor((row + beyond) / factor) * columns;
    for (let column = 0; column < grid.columns; column += 1) {
      const cell = grid.cells[row * grid.columns + column];
      const merged = target + Math.floor(column / factor);
      if (cell === OCCUPIED || (cell === UNKNOWN && cells[merged] === FREE)) cells[merged] = cell;
    }
  }
  if (beyond > 0) cells.fill(OCCUPIED, 0, columns);
  if (columns * factor > grid.columns)
    for (let row = 0; row < rows; row += 1) cells[row * columns + columns - 1] = OCCUPIED;
  return { ...grid, columns, rows, cells, resolution: plusTimes(0, factor, grid.resolution) };
}

/** The smallest factor by which the cells must be merged so that there are no more than `most`. */
export function smallestFactor({ columns, rows }, most) {
  let factor = 1;
  while (Math.ceil(columns / factor) * Math.ceil(rows / factor) > most) factor += 1;
  return factor;
}

/** The grid as the map of a request; unknown cells are blocked or, if `unknownFree`, free. */
export function mapOfGrid({ columns, rows, cells, resolution, origin }, unknownFree) {
  const letters = [];
  letters[FREE] = ".".charCodeAt(0);
  letters[OCCUPIED] = "#".charCodeAt(0);
  letters[UNKNOWN] = letters[unknownFree ? FREE : OCCUPIED];
  const line = new Uint8Array(columns); // as text that grows by letters takes seconds for large maps
  const decoder = new TextDecoder();
  const lines = [];
  for (let first = 0; first < rows * columns; first += columns) {
    for (let column = 0; column < columns; column += 1) line[column] = letters[cells[first + column]];
    lines.push(decoder.decode(line));
  }
  return { rows: lines, resolution, origin: { ...origin } };
}
