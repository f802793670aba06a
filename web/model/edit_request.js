// Edits of a request. Each takes a request and returns a new request, which shares the unchanged parts. Nothing is
// changed in place. Robots are identified by their index. Faulty requests are repaired as far as an edit goes. A faulty
// map is edited as it is drawn, see readScene. Pure.

import { isFree, tidy } from "./cells.js";
import { asRows } from "./drawn_map.js";
import { lastGoalOf, withLastGoal, withoutGoals } from "./goals.js";
import { robotsOf } from "./listed.js";
import { readGrid } from "./scene.js";

const FREE = ".";
const BLOCKED = "#";
const MAX_CELLS = 16_000_000; // until the limits are known
const SPEEDS = { linear_speed: 1, angular_speed: 3.1416 }; // m/s, rad/s: defaults
const RADIUS_SHARE = 0.4; // of a cell

/** The value if it is an object, else an empty object. */
export function objectOf(value) {
  return value !== null && typeof value === "object" && !Array.isArray(value) ? value : {};
}

/** The object with a member set, or removed if undefined; the same object if nothing changes. */
export function withMember(object, name, value) {
  if (Object.is(object[name], value)) return object;
  const changed = { ...object, [name]: value };
  if (value === undefined) delete changed[name];
  return changed;
}

/** The object with several members set or removed. */
export function withMembers(object, members) {
  return Object.entries(members).reduce((changed, [name, value]) => withMember(changed, name, value), object);
}

/**
 * The request with these cells of its map blocked, or free. Unchanged cells keep their letter. `known`, the
 * grid of this map or an earlier one, saves reading it again.
 */
export function setCells(request, cells, blocked, known = null) {
  const grid = readGrid(request?.map, known);
  const columns = new Map(); // row -> columns to change
  for (const cell of cells) {
    if (grid === null || isFree(grid, cell) !== blocked) continue;
    if (!columns.has(cell.row)) columns.set(cell.row, []);
    columns.get(cell.row).push(cell.column);
  }
  if (grid === null || columns.size === 0) return request;
  const letter = blocked ? BLOCKED : FREE;
  const rows = grid.lines.map((line, row) =>
    columns.has(row) ? withLetters(line, columns.get(row), letter) : line,
  );
  return withMap(request, { rows });
}

function withLetters(line, columns, letter) {
  const letters = [...line];
  for (const column of columns) {
    while (letters.length < column) letters.push(BLOCKED); // missing cells of a short row are drawn as walls
    letters[column] = letter;
  }
  return letters.join("");
}

/**
 * The request with columns or rows of free cells added on each side: {left, right, top, bottom}, negative to
 * cut. The origin moves so that all positions stay the same. A map keeps at least one cell.
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

/** A list with `filler` added, or items removed, at its start and end. */
function lengthened(list, atBegin, atEnd, filler) {
  const kept = list.slice(Math.max(0, -atBegin), list.length - Math.max(0, -atEnd));
  const added = (count) => Array(Math.max(0, count)).fill(filler);
  return [...added(atBegin), ...kept, ...added(atEnd)];
}

/** The request with another cell size, metres; undefined: the default. Robots keep their positions. */
export function setResolution(request, resolution) {
  return withMap(request, { resolution });
}

/** The request with another x or y of the map's lower left corner, metres; undefined: the default. */
export function setOrigin(request, axis, value) {
  const origin = withMember(objectOf(asRows(request?.map)?.origin), axis, value);
  return withMap(request, { origin: Object.keys(origin).length > 0 ? origin : undefined });
}

/** A request with a new map and no robots: all free or, if `walled`, with a wall around it. */
export function newMap({ columns, rows, resolution, walled }) {
  const open = FREE.repeat(columns);
  const wall = BLOCKED.repeat(columns);
  const between = columns > 2 ? BLOCKED + FREE.repeat(columns - 2) + BLOCKED : wall;
  const lines = Array.from({ length: rows }, (_, row) => {
    if (!walled) return open;
    return row === 0 || row === rows - 1 ? wall : between;
  });
  const map = { rows: lines, resolution };
  return { map, robot_defaults: numbersOfNext({ map }), robots: [] };
}

/** Why a map of this size is invalid, in words, or null. `limits`: see Session. */
export function faultOfSize(columns, rows, limits) {
  if (!Number.isInteger(columns) || !Number.isInteger(rows)) return "Enter whole numbers.";
  if (columns < 1 || rows < 1) return "A map has at least one cell.";
  const most = limits.max_cells ?? MAX_CELLS;
  if (columns * rows > most) return `The service accepts at most ${most.toLocaleString("en")} cells.`;
  return null;
}

/** The request with a changed map. A map that is not rows becomes rows. */
function withMap(request, changes) {
  const map = asRows(request?.map) ?? objectOf(request?.map);
  return { ...objectOf(request), map: withMembers(map, changes) };
}

/** The name of the robot at an index: its id, or "#index". */
export function nameOf(request, index) {
  const id = robotsOf(request)[index]?.id;
  return typeof id === "string" && id !== "" ? id : `#${index}`;
}

/**
 * The request with a member of a robot (id, radius, linear_speed, angular_speed) set, or removed if
 * undefined.
 */
export function setRobot(request, index, name, value) {
  return withRobot(request, index, (robot) => withMember(robot, name, value));
}

/** The request with a default (radius, linear_speed, angular_speed) set, or removed if undefined. */
export function setDefault(request, name, value) {
  const defaults = withMember(objectOf(request?.robot_defaults), name, value);
  const isEmpty = Object.keys(defaults).length === 0;
  return withMember(objectOf(request), "robot_defaults", isEmpty ? undefined : defaults);
}

/**
 * The request with some members of a robot's pose set to {x, y, theta}. `pose`: "start", or "goal" for the last goal.
 * Undefined members are removed. Without theta, a start has its default, and a goal any heading.
 */
export function setPose(request, index, pose, members) {
  return withRobot(request, index, (robot) => {
    if (pose === "goal") return withLastGoal(robot, withMembers(objectOf(lastGoalOf(robot)), members));
    return withMember(robot, pose, withMembers(objectOf(robot[pose]), members));
  });
}

/** The request with a robot without goals. */
export function removeGoal(request, index) {
  return withRobot(request, index, withoutGoals);
}

/**
 * The radius and the speeds of a robot that is added: the values of robot_defaults, or of the last robot, or defaults
 * for the map.
 */
export function numbersOfNext(request) {
  const last = objectOf(robotsOf(request).at(-1));
  const resolution = asRows(request?.map)?.resolution ?? 1;
  const usual = { radius: RADIUS_SHARE * (resolution > 0 ? resolution : 1), ...SPEEDS };
  const sources = [objectOf(request?.robot_defaults), last, usual];
  const of = (name) => sources.map((source) => source[name]).find((value) => value > 0);
  return { radius: of("radius"), linear_speed: of("linear_speed"), angular_speed: of("angular_speed") };
}

/** The request with a new robot at the end, with a start {x, y} and an optional goal. See numbersOfNext. */
export function addRobot(request, start, goal = undefined) {
  const robots = robotsOf(request);
  const robot = { id: freshId(request) };
  for (const [name, value] of Object.entries(numbersOfNext(request))) {
    if (!(request?.robot_defaults?.[name] > 0)) robot[name] = value;
  }
  robot.start = start;
  if (goal !== undefined) robot.goal = goal;
  return { ...objectOf(request), robots: [...robots, robot] };
}

/**
 * The request with a copy of a robot at the end, with its own id, start and last goal (if it has one). What the
 * robot does already, and was planned to do, begins at its start and is not copied.
 */
export function duplicateRobot(request, index, start, goal) {
  const robots = robotsOf(request);
  const robot = objectOf(robots[index]);
  const { committed: _, previous: __, ...kept } = robot;
  const copy = { ...kept, id: freshId(request, robot.id), start: { ...robot.start, ...start } };
  const whole = goal ? withLastGoal(copy, { ...lastGoalOf(robot), ...goal }) : copy;
  return { ...objectOf(request), robots: [...robots, whole] };
}

export function deleteRobot(request, index) {
  return { ...objectOf(request), robots: robotsOf(request).filter((_, at) => at !== index) };
}

/**
 * An unused id that continues the pattern of `like`, or else of the last id with a number: robot-4 after
 * robot-3.
 */
export function freshId(request, like = undefined) {
  const all = new Set(robotsOf(request).map((robot) => robot?.id));
  const ids = [...all].filter((id) => typeof id === "string");
  const pattern = numbered(like) ?? numbered(ids.findLast((id) => /\d$/.test(id)));
  const { stem, digits, number } = pattern ?? { stem: like ? `${like}-` : "robot-", digits: 1, number: 0 };
  return unusedId(robotsOf(request), stem, number, digits);
}

/** The first id of a stem and a number greater than `after` that none of these has. */
export function unusedId(identified, stem, after = 0, digits = 1) {
  const taken = new Set(identified.map((each) => each?.id));
  let next = after;
  let id;
  do {
    next += 1;
    id = stem + String(next).padStart(digits, "0");
  } while (taken.has(id));
  return id;
}

/** The parts of an id that ends in a number, or null. */
function numbered(id) {
  const found = /^(.*?)(\d{1,9})$/.exec(id ?? "");
  return found && { stem: found[1], digits: found[2].length, number: Number(found[2]) };
}

function withRobot(request, index, change) {
  const robots = robotsOf(request);
  const robot = objectOf(robots[index]);
  const changed = change(robot);
  if (changed === robots[index]) return request;
  return { ...objectOf(request), robots: robots.map((each, at) => (at === index ? changed : each)) };
}
