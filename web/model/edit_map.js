// Edits of a request's map: a request in, another out that shares what is the same; nothing is changed in
// place. Pure. A faulty map is taken as it is drawn, see readScene.

import { isFree, tidy } from "./cells.js";
import { objectOf, withMember, withMembers } from "./members.js";
import { readGrid } from "./scene.js";

const FREE = ".";
const BLOCKED = "#";
const MOST_CELLS = 4_000_000; // if the service has not said

/**
 * The request with these cells of its map blocked, or free. Cells that are so already keep their letter.
 * `known`, the grid of this map or one before, makes it cheap.
 */
export function setCells(request, cells, blocked, known = null) {
  const grid = readGrid(request?.map, known);
  const columns = new Map(); // row -> columns to change
  for (const cell of cells) {
    if (grid === null || isFree(grid, cell) !== blocked) continue;
    if (!columns.has(cell.row)) columns.set(cell.row, []);
    columns.get(cell.row).push(cell.column);
  }
  if (columns.size === 0) return request;
  const letter = blocked ? BLOCKED : FREE;
  const rows = grid.lines.map((line, row) =>
    columns.has(row) ? withLetters(line, columns.get(row), letter) : line,
  );
  return withMap(request, { rows });
}

function withLetters(line, columns, letter) {
  const letters = [...line];
  for (const column of columns) {
    while (letters.length < column) letters.push(BLOCKED); // what a short row lacks is drawn as wall
    letters[column] = letter;
  }
  return letters.join("");
}

/**
 * The request with so many columns or rows of free cells more on each side: {left, right, top, bottom},
 * negative to cut. The origin moves so that all else stays where it is. A map keeps at least one cell.
 */
export function resize(request, { left = 0, right = 0, top = 0, bottom = 0 }) {
  const grid = readGrid(request?.map, null);
  if (grid === null || grid.columns + left + right < 1 || grid.rows + top + bottom < 1) return request;
  if (left === 0 && right === 0 && top === 0 && bottom === 0) return request;
  const across = grid.lines.map((line) => {
    const whole = line.padEnd(grid.columns, BLOCKED);
    return lengthened([...whole], left, right, FREE).join("");
  });
  const rows = lengthened(across, top, bottom, FREE.repeat(grid.columns + left + right));
  const origin = {
    x: tidy(grid.origin.x - left * grid.resolution),
    y: tidy(grid.origin.y - bottom * grid.resolution),
  };
  const moved = origin.x !== grid.origin.x || origin.y !== grid.origin.y;
  return withMap(request, moved ? { rows, origin } : { rows });
}

/** A list with `filler` added, or with items cut, at its begin and end. */
function lengthened(list, atBegin, atEnd, filler) {
  const kept = list.slice(Math.max(0, -atBegin), list.length - Math.max(0, -atEnd));
  const added = (count) => Array(Math.max(0, count)).fill(filler);
  return [...added(atBegin), ...kept, ...added(atEnd)];
}

/** The request with another side of a cell, metres; undefined: the default. Robots keep their metres. */
export function setResolution(request, resolution) {
  return withMap(request, { resolution });
}

/** The request with another x or y of the map's lower left corner, metres; undefined: the default. */
export function setOrigin(request, axis, value) {
  const origin = withMember(objectOf(request?.map?.origin), axis, value);
  return withMap(request, { origin: Object.keys(origin).length > 0 ? origin : undefined });
}

/** A request of a map that has no robots yet: all free or, if `walled`, with a wall around it. */
export function newMap({ columns, rows, resolution, walled }) {
  const open = FREE.repeat(columns);
  const wall = BLOCKED.repeat(columns);
  const between = columns > 2 ? BLOCKED + FREE.repeat(columns - 2) + BLOCKED : wall;
  const lines = Array.from({ length: rows }, (_, row) => {
    if (!walled) return open;
    return row === 0 || row === rows - 1 ? wall : between;
  });
  return { map: { rows: lines, resolution }, robots: [] };
}

/** Why a map of this size cannot be, in words, or null. `limits`: see Session. */
export function faultOfSize(columns, rows, limits) {
  if (!Number.isInteger(columns) || !Number.isInteger(rows)) return "Whole numbers, please.";
  if (columns < 1 || rows < 1) return "A map has at least one cell.";
  const most = limits.max_cells ?? MOST_CELLS;
  if (columns * rows > most) return `The service takes up to ${most.toLocaleString("en")} cells.`;
  return null;
}

function withMap(request, changes) {
  return { ...objectOf(request), map: withMembers(objectOf(request?.map), changes) };
}
