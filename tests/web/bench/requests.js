// Requests that are large in one respect: many robots, or many cells.

import { png } from "../support/map_files.js";

const SIDE = 160; // cells of a warehouse
const SHELVES = { across: 12, down: 4, aisle: 2 }; // cells
const BUILDING = { side: 2000, room: 250, wall: 4, door: { from: 100, to: 130 } }; // cells
const DEFAULTS = { radius: 0.4, linear_speed: 1, angular_speed: 1.5 };

/** Numbers in [0, 1), the same each time (a linear congruential generator, constants of Numerical Recipes). */
function sequence(seed) {
  let state = seed;
  return () => (state = (Math.imul(state, 1664525) + 1013904223) >>> 0) / 2 ** 32;
}

const inAisle = (x, y) => y % SHELVES.down < SHELVES.aisle || x % SHELVES.across < SHELVES.aisle;

/** So many robots between random cells of a warehouse, no two starts and no two goals on one cell. */
export function warehouseOf(robots) {
  const random = sequence(1);
  const cells = () => {
    const taken = new Set();
    while (taken.size < robots) {
      const [x, y] = [random(), random()].map((share) => Math.floor(share * SIDE));
      if (inAisle(x, y)) taken.add(y * SIDE + x);
    }
    return [...taken].map((cell) => ({ x: (cell % SIDE) + 0.5, y: Math.floor(cell / SIDE) + 0.5 }));
  };
  const [starts, goals] = [cells(), cells()];
  const rowAt = (y) => Array.from({ length: SIDE }, (_, x) => (inAisle(x, y) ? "." : "#")).join("");
  return {
    map: { rows: Array.from({ length: SIDE }, (_, row) => rowAt(SIDE - 1 - row)) },
    robot_defaults: DEFAULTS,
    robots: starts.map((start, at) => ({ id: `robot-${at + 1}`, start, goal: goals[at] })),
    options: { time_budget_ms: 60_000 },
  };
}

/** Whether each cell of a building of rooms with doors is a wall, row by row. */
function wallsOfBuilding() {
  const { side, room, wall, door } = BUILDING;
  const inDoor = (along) => along % room >= door.from && along % room < door.to;
  const walls = new Uint8Array(side * side);
  for (let y = 0; y < side; y += 1) {
    for (let x = 0; x < side; x += 1) {
      const across = x % room < wall && !inDoor(y);
      const along = y % room < wall && !inDoor(x);
      walls[y * side + x] = across || along ? 1 : 0;
    }
  }
  return walls;
}

/** The rows of the building, each cell as `ofWall` gives it. */
function buildingRows(ofWall) {
  const { side } = BUILDING;
  const walls = wallsOfBuilding();
  return Array.from({ length: side }, (_, row) =>
    Array.from(walls.subarray(row * side, (row + 1) * side), ofWall),
  );
}

/** A request with a building of four million cells as rows, and one robot. */
export function buildingAsRows() {
  const rows = buildingRows((wall) => (wall ? "#" : ".")).map((row) => row.join(""));
  return withRobot({ rows });
}

/** The same with the map as an image. */
export function buildingAsImage() {
  const encoded = png(0, buildingRows(grayOf)).toString("base64");
  return withRobot({ image: { png: encoded, resolution: 1 } });
}

const grayOf = (wall) => (wall ? 0 : 254);

function withRobot(map) {
  const robot = { id: "robot-1", start: { x: 50.5, y: 50.5 }, goal: { x: 60.5, y: 60.5 } };
  return {
    map,
    robot_defaults: DEFAULTS,
    robots: [robot],
  };
}

/** The same building as a map of ROS: the contents of its files by their names. */
export function buildingOfRos() {
  const { side } = BUILDING;
  const pixels = Buffer.from(wallsOfBuilding().map(grayOf));
  return {
    "building.yaml": "image: building.pgm\nresolution: 0.05\norigin: [0, 0, 0]\nnegate: 0\n",
    "building.pgm": Buffer.concat([Buffer.from(`P5\n${side} ${side}\n255\n`), pixels]),
  };
}
