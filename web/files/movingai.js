// Maps and scenarios of the MovingAI benchmarks (movingai.com/benchmarks). A map has a header, then a character per
// cell. A scenario has a line for each start and goal. The first lines become the robots of a request.

import { FileError, quoted } from "../model/problem.js";
import { linesOf, plusTimes } from "./text.js";

// Free: ground (two letters), and swamp, which can be entered from ground. Blocked: out of bounds (two letters), trees,
// water; and the wall of a request.
const OTHER = /[^.GS@OTW#]/;
const HEADER = { type: /^\S+$/, height: /^[1-9]\d{0,8}$/, width: /^[1-9]\d{0,8}$/ };
const ENTRY = /^\s*\d+\s+(.+?)\s+(\d+)\s+(\d+)\s+(\d+)\s+(\d+)\s+(\d+)\s+(\d+)\s+[\d.eE+-]+\s*$/;
const SLACK = 1e-10; // metres by which disks may overlap after rounding, below the tolerance of the service

/** The map of a request for a `.map` text, a metre per cell: {rows, resolution}. Throws FileError. */
export function readMovingAiMap(text) {
  const lines = linesOf(text);
  const { width, height, first } = readHeader(lines);
  const rows = lines.slice(first);
  while (rows.at(-1)?.trim() === "") rows.pop();
  if (rows.length !== height) {
    throw new FileError(
      `The header has height ${height}, but ${rows.length} rows follow "map". ` +
        "Correct the height, or fetch the map again: it may be truncated.",
    );
  }
  return { rows: rows.map((line, row) => readRow(line, first + row + 1, width)), resolution: 1 };
}

/** {width, height, first}: `first` is the index of the line that draws the top row. */
function readHeader(lines) {
  /** @type {any} */
  const header = {};
  for (const [index, line] of lines.entries()) {
    const [, key, value] = /^\s*(\w+)(?:\s+(\S+))?\s*$/.exec(line) ?? [];
    if (key === "map" && value === undefined) return { ...sizesIn(header), first: index + 1 };
    if (!Object.hasOwn(HEADER, key) || !HEADER[key].test(value)) {
      throw new FileError(
        `Line ${index + 1} is ${quoted(line)}, where the header of a MovingAI map is expected: ` +
          '"type octile", "height" and "width" with a whole number each, then "map".',
      );
    }
    header[key] = Number(value);
  }
  throw new FileError('There is no line "map" that ends the header of a MovingAI map.');
}

function sizesIn({ width, height }) {
  const missing = Object.entries({ width, height }).find(([, size]) => size === undefined);
  if (missing)
    throw new FileError(
      `The header names no ${missing[0]}: add a line "${missing[0]} …" before the line "map".`,
    );
  return { width, height };
}

function readRow(line, number, width) {
  const column = line.search(OTHER);
  if (column >= 0) {
    throw new FileError(
      `Line ${number} has ${quoted(line[column])} in column ${column + 1}; free cells are . G and S, ` +
        "blocked ones @ O T W and #.",
    );
  }
  if (line.length !== width) {
    throw new FileError(
      `Line ${number} has ${line.length} cells, but the header has width ${width}; ` +
        "all rows must be of that length.",
    );
  }
  return line.replaceAll("S", ".");
}

const COLUMNS =
  "A line of a scenario has, with tabs between: bucket, map, width, height, start x and y, goal x and y, " +
  "optimal length.";

/**
 * The entries of a `.scen` text: [{map, width, height, start, goal}]. They are the map's file name, its size in cells,
 * and two cells {column, row}; row 0 is at the top. Throws FileError.
 */
export function readMovingAiScenario(text) {
  const entries = [];
  for (const [index, line] of linesOf(text).entries()) {
    if (line.trim() === "" || (entries.length === 0 && /^\s*version\b/.test(line))) continue;
    entries.push(readEntry(line, index + 1));
  }
  if (entries.length === 0) throw new FileError(`There is no start and goal in it. ${COLUMNS}`);
  const other = entries.find(({ map }) => map !== entries[0].map);
  if (other)
    throw new FileError(`It is for two maps, ${entries[0].map} and ${other.map}: make a file for each.`);
  return entries;
}

function readEntry(line, number) {
  const found = ENTRY.exec(line);
  if (!found) throw new FileError(`Line ${number} is ${quoted(line)}. ${COLUMNS}`);
  const [width, height, startColumn, startRow, goalColumn, goalRow] = found.slice(2).map(Number);
  const entry = {
    map: found[1].split(/[\\/]/).pop(),
    width,
    height,
    start: { column: startColumn, row: startRow },
    goal: { column: goalColumn, row: goalRow },
  };
  for (const which of ["start", "goal"]) {
    const { column, row } = entry[which];
    if (column < width && row < height) continue;
    throw new FileError(
      `Line ${number} has its ${which} at column ${column}, row ${row} (both from 0), outside the ` +
        `${width} x ${height} cells that the line itself gives the map.`,
    );
  }
  return entry;
}

/** Throws FileError if the entries are for a map of another size than `map` (of a request). */
export function checkMapOf(entries, { rows }) {
  const [columns, lines] = [rows[0].length, rows.length];
  const other = entries.find(({ width, height }) => width !== columns || height !== lines);
  if (other === undefined) return;
  throw new FileError(
    `The scenario is for ${other.map} of ${other.width} x ${other.height} cells, but the map has ` +
      `${columns} x ${lines}: open it with its own map.`,
  );
}

/**
 * A request on `map` (of a request) for the first `count` entries that are possible: {request, cells, passedOver:
 * {walls, overlaps}}. `defaults` of robots: {radius, linear_speed, angular_speed}; m, m/s, rad/s. Starts and goals are
 * at the cells' centres, goals with any heading.
 *
 * An entry is skipped if a disk does not fit between the walls or overlaps an earlier one. `cells` are the entries
 * used. The map must have the size that the entries give, see checkMapOf.
 */
export function scenarioRequest(map, entries, count, defaults) {
  const passedOver = { walls: 0, overlaps: 0 };
  const taken = [];
  const reach = (defaults.radius - SLACK) / map.resolution; // in cells
  const apart = (a, b) => Math.hypot(a.column - b.column, a.row - b.row) >= 2 * reach;
  for (const entry of entries) {
    if (taken.length >= count) break;
    if (!fits(map.rows, entry.start, reach) || !fits(map.rows, entry.goal, reach)) passedOver.walls += 1;
    else if (!taken.every((other) => apart(other.start, entry.start) && apart(other.goal, entry.goal)))
      passedOver.overlaps += 1;
    else taken.push(entry);
  }
  const robots = taken.map(({ start, goal }, index) => ({
    id: `r${index + 1}`,
    start: { ...centreOf(map, start), theta: 0 },
    goal: centreOf(map, goal),
  }));
  return { request: { map, robot_defaults: { ...defaults }, robots }, cells: taken, passedOver };
}

/** Whether a disk of `reach` cells at the cell's centre is clear of blocked cells and of the map's edge. */
function fits(rows, { column, row }, reach) {
  const toEdge = Math.min(column, row, rows[0].length - 1 - column, rows.length - 1 - row) + 0.5;
  if (toEdge < reach) return false;
  const span = Math.max(0, Math.ceil(reach - 0.5)); // cells away that the disk may touch
  const gap = (cells) => Math.max(0, Math.abs(cells) - 0.5);
  for (let down = -span; down <= span; down += 1) {
    for (let right = -span; right <= span; right += 1) {
      if (Math.hypot(gap(down), gap(right)) < reach && !".G".includes(rows[row + down][column + right]))
        return false;
    }
  }
  return true;
}

function centreOf({ rows, resolution, origin = { x: 0, y: 0 } }, { column, row }) {
  return {
    x: plusTimes(origin.x ?? 0, 2 * column + 1, resolution / 2),
    y: plusTimes(origin.y ?? 0, 2 * (rows.length - row) - 1, resolution / 2),
  };
}
