import assert from "node:assert/strict";
import { test } from "node:test";

import { cellAt, cellsAlong, cellsBetween, centreOf } from "../../../web/model/cells.js";
import {
  addRobot,
  deleteRobot,
  duplicateRobot,
  faultOfSize,
  freshId,
  nameOf,
  newMap,
  removeGoal,
  resize,
  setCells,
  setDefault,
  setOrigin,
  setPose,
  setResolution,
  setRobot,
} from "../../../web/model/edit_request.js";
import { nearestFreePlace, snapHeading, snapPoint, stepped, turned } from "../../../web/model/placement.js";
import { readScene } from "../../../web/model/scene.js";

const REQUEST = {
  map: { rows: ["#..", ".GT"], resolution: 0.5, origin: { x: 10, y: -2 } },
  robots: [{ id: "a", start: { x: 10.75, y: -1.75 } }],
};
const gridOf = (request) => readScene(request).grid;
const GRID = gridOf({ map: { rows: Array(10).fill(".".repeat(10)) } });
const names = (cells) => cells.map(({ column, row }) => `${column},${row}`);

test("the centre of a cell lies in the cell, with the top row first", () => {
  const grid = gridOf(REQUEST);
  assert.deepEqual(centreOf(grid, { column: 0, row: 0 }), { x: 10.25, y: -1.25 });
  assert.deepEqual(cellAt(grid, { x: 10.25, y: -1.25 }), { column: 0, row: 0 });
  assert.deepEqual(cellAt(grid, { x: 11.4, y: -1.9 }), { column: 2, row: 1 });
});

test("the centre of a cell has no rounding digits", () => {
  const grid = gridOf({ map: { rows: ["...."], resolution: 0.1 } });
  assert.deepEqual(centreOf(grid, { column: 3, row: 0 }), { x: 0.35, y: 0.05 });
});

test("a line covers all cells that it passes, without a gap", () => {
  const cells = names(cellsAlong(GRID, { x: 0.5, y: 9.5 }, { x: 2.5, y: 8.4 }));
  assert.deepEqual(cells, ["0,0", "1,0", "1,1", "2,1"]);
  const steep = names(cellsAlong(GRID, { x: 2.2, y: 6.1 }, { x: 1.9, y: 9.9 }));
  assert.deepEqual(steep, ["2,3", "2,2", "2,1", "1,1", "1,0"]);
});

test("a line in any direction ends in its last cell", () => {
  const ends = [
    [9.5, 9.5],
    [0.5, 9.3],
    [9.9, 0.1],
    [4.5, 9.9],
    [0.2, 0.3],
    [9.7, 5.5],
    [5.5, 5.5],
  ];
  for (const [x, y] of ends) {
    const to = { x, y };
    const cells = cellsAlong(GRID, { x: 5.5, y: 5.5 }, to);
    assert.deepEqual(cells.at(-1), cellAt(GRID, to));
    cells.slice(1).forEach((cell, at) => {
      assert.equal(Math.abs(cell.column - cells[at].column) + Math.abs(cell.row - cells[at].row), 1);
    });
  }
});

test("lines and rectangles omit cells outside the map", () => {
  assert.deepEqual(names(cellsAlong(GRID, { x: -2.5, y: 0.5 }, { x: 1.5, y: 0.5 })), ["0,9", "1,9"]);
  const corner = cellsBetween(GRID, { column: 1, row: 10 }, { column: -1, row: 8 });
  assert.deepEqual(names(corner), ["0,8", "1,8", "0,9", "1,9"]);
});

test("cells are blocked and freed; unchanged ones keep their letter", () => {
  const all = cellsBetween(gridOf(REQUEST), { column: 0, row: 0 }, { column: 2, row: 1 });
  assert.deepEqual(setCells(REQUEST, all.slice(0, 4), true).map.rows, ["###", "#GT"]);
  assert.deepEqual(setCells(REQUEST, all, true).map.rows, ["###", "##T"]);
  assert.deepEqual(setCells(REQUEST, all, false).map.rows, ["...", ".G."]);
});

test("an edit shares what it does not change and never changes in place", () => {
  const before = structuredClone(REQUEST);
  const edited = setCells(REQUEST, [{ column: 1, row: 0 }], true);
  assert.deepEqual(REQUEST, before);
  assert.equal(edited.robots, REQUEST.robots);
  assert.equal(edited.map.origin, REQUEST.map.origin);
  const blockedOrOutside = [
    { column: 0, row: 0 },
    { column: 7, row: 7 },
  ];
  assert.equal(setCells(REQUEST, blockedOrOutside, true), REQUEST);
});

test("a cell missing from a short row is drawn as a wall and can be freed", () => {
  const request = { map: { rows: [".....", "."] } };
  assert.deepEqual(setCells(request, [{ column: 3, row: 1 }], false).map.rows, [".....", ".##."]);
});

test("a map is enlarged and cut on each side while positions stay the same", () => {
  const place = (request, letter) => {
    const grid = gridOf(request);
    const row = grid.lines.findIndex((line) => line.includes(letter));
    return centreOf(grid, { column: grid.lines[row].indexOf(letter), row });
  };
  for (const sides of [
    { left: 2 },
    { right: 1 },
    { top: 3 },
    { bottom: 2 },
    { left: 1, bottom: 1, top: -1 },
  ]) {
    const resized = resize(REQUEST, sides);
    assert.deepEqual(place(resized, "G"), place(REQUEST, "G"), JSON.stringify(sides));
    assert.equal(resized.robots, REQUEST.robots);
  }
  assert.deepEqual(resize(REQUEST, { left: 1, top: 1 }).map.rows, ["....", ".#..", "..GT"]);
  assert.deepEqual(resize(REQUEST, { right: -1, bottom: -1 }).map.rows, ["#."]);
  assert.deepEqual(resize(REQUEST, { left: 1, bottom: 2 }).map.origin, { x: 9.5, y: -3 });
});

test("enlarging and cutting the same side restores the map", () => {
  let request = { map: { rows: ["...."], resolution: 0.1 } };
  for (let time = 0; time < 3; time += 1) request = resize(request, { left: 1, bottom: 1 });
  assert.deepEqual(request.map.origin, { x: -0.3, y: -0.3 });
  for (let time = 0; time < 3; time += 1) request = resize(request, { left: -1, bottom: -1 });
  assert.deepEqual(request.map, { rows: ["...."], resolution: 0.1, origin: { x: 0, y: 0 } });
});

test("a map keeps at least one cell, and a missing map is not resized", () => {
  assert.equal(resize(REQUEST, { right: -3 }), REQUEST);
  assert.equal(resize(REQUEST, { top: -1, bottom: -1 }), REQUEST);
  assert.equal(resize({ robots: [] }, { left: 1 }).map, undefined);
});

test("resolution and origin are set or reset to their defaults", () => {
  assert.equal(setResolution(REQUEST, 0.2).map.resolution, 0.2);
  assert.ok(!("resolution" in setResolution(REQUEST, undefined).map));
  assert.deepEqual(setOrigin(REQUEST, "x", undefined).map.origin, { y: -2 });
  assert.ok(!("origin" in setOrigin(setOrigin(REQUEST, "x", undefined), "y", undefined).map));
  assert.deepEqual(setOrigin(null, "y", 3), { map: { origin: { y: 3 } } });
});

test("a new map is open or walled, of any size", () => {
  const rows = (columns, count, walled) => newMap({ columns, rows: count, resolution: 1, walled }).map.rows;
  assert.deepEqual(rows(4, 3, true), ["####", "#..#", "####"]);
  assert.deepEqual(rows(4, 2, false), ["....", "...."]);
  assert.deepEqual(rows(2, 3, true), ["##", "##", "##"]);
  assert.deepEqual(rows(1, 1, true), ["#"]);
});

test("an impossible size is rejected with a message", () => {
  assert.equal(faultOfSize(40, 30, {}), null);
  assert.match(faultOfSize(0, 30, {}), /at least one/);
  assert.match(faultOfSize(2.5, 30, {}), /Enter whole numbers/);
  assert.match(faultOfSize(11, 10, { max_cells: 100 }), /at most 100 cells/);
});

const FLEET = {
  map: { rows: ["....."], resolution: 0.5 },
  robots: [
    {
      id: "robot-1",
      radius: 0.2,
      linear_speed: 1.5,
      angular_speed: 2,
      start: { x: 0.25, y: 0.25, theta: 1 },
    },
    { id: "robot-3", start: { x: 1.25, y: 0.25 }, goal: { x: 2.25, y: 0.25, theta: 0 } },
  ],
};
const degrees = (value) => (value * Math.PI) / 180;
const ids = (...named) => ({ robots: named.map((id) => ({ id })) });

test("a start or goal moves and keeps its heading", () => {
  const moved = setPose(FLEET, 0, "start", { x: 0.75, y: 0.25 });
  assert.deepEqual(moved.robots[0].start, { x: 0.75, y: 0.25, theta: 1 });
  assert.equal(moved.robots[1], FLEET.robots[1]);
  assert.equal(moved.map, FLEET.map);
  assert.deepEqual(setPose(FLEET, 1, "goal", { theta: undefined }).robots[1].goal, { x: 2.25, y: 0.25 });
  assert.deepEqual(setPose(FLEET, 0, "goal", { x: 1, y: 2 }).robots[0].goal, { x: 1, y: 2 });
});

test("an edit that changes nothing is the same request", () => {
  assert.equal(setPose(FLEET, 0, "start", { x: 0.25 }), FLEET);
  assert.equal(setRobot(FLEET, 0, "radius", 0.2), FLEET);
  assert.equal(removeGoal(FLEET, 0), FLEET);
});

test("members of robots and defaults are set and removed", () => {
  assert.equal(setRobot(FLEET, 1, "radius", -1).robots[1].radius, -1);
  assert.ok(!("radius" in setRobot(FLEET, 0, "radius", undefined).robots[0]));
  const defaults = setDefault(FLEET, "radius", 0.3);
  assert.deepEqual(defaults.robot_defaults, { radius: 0.3 });
  assert.deepEqual(setDefault(defaults, "radius", undefined), FLEET);
  assert.ok(!("goal" in removeGoal(FLEET, 1).robots[1]));
});

test("a robot that is not an object, or robots that are not a list, can be edited", () => {
  assert.deepEqual(setPose({ robots: [7] }, 0, "start", { x: 1 }).robots, [{ start: { x: 1 } }]);
  const placed = setPose({ robots: [{ start: "here" }] }, 0, "start", { y: 1 });
  assert.deepEqual(placed.robots, [{ start: { y: 1 } }]);
  assert.equal(addRobot({ robots: "none" }, { x: 0, y: 0 }).robots.length, 1);
  assert.equal(addRobot(null, { x: 0, y: 0 }).robots[0].radius, 0.4);
  assert.equal(nameOf({ robots: [7] }, 0), "#0");
});

test("a new robot continues the pattern of ids and copies the last robot", () => {
  const [, , robot] = addRobot(FLEET, { x: 1, y: 1 }, { x: 2, y: 2 }).robots;
  assert.deepEqual(robot, {
    id: "robot-4",
    radius: 0.2, // of the map's cells
    linear_speed: 1,
    angular_speed: 3.1416,
    start: { x: 1, y: 1 },
    goal: { x: 2, y: 2 },
  });
  const first = deleteRobot(FLEET, 1);
  assert.equal(addRobot(first, { x: 1, y: 1 }).robots[1].linear_speed, 1.5);
  const withDefaults = { ...FLEET, robot_defaults: { radius: 0.1, linear_speed: 1, angular_speed: 1 } };
  assert.deepEqual(addRobot(withDefaults, { x: 1, y: 1 }).robots[2], {
    id: "robot-4",
    start: { x: 1, y: 1 },
  });
});

test("new ids are unique and follow the pattern", () => {
  assert.equal(freshId({}), "robot-1");
  assert.equal(freshId(ids("amr-08", "amr-09")), "amr-10");
  assert.equal(freshId(ids("robot-3", "robot-4", "robot-3b", "heavy")), "robot-5");
  assert.equal(freshId(ids("a1", "a3", "a2")), "a4");
  assert.equal(freshId(ids("heavy", "east"), "heavy"), "heavy-1");
  assert.equal(freshId(ids("heavy", "heavy-1"), "heavy"), "heavy-2");
  assert.equal(freshId(ids("tote-1", "pallet-1"), "tote-1"), "tote-2");
});

test("a duplicate differs only in id and positions", () => {
  const [, , copy] = duplicateRobot(FLEET, 1, { x: 0.75, y: 0.25 }, { x: 1.75, y: 0.25 }).robots;
  assert.deepEqual(copy, {
    id: "robot-4",
    start: { x: 0.75, y: 0.25 },
    goal: { x: 1.75, y: 0.25, theta: 0 },
  });
  assert.equal(duplicateRobot(FLEET, 0, { x: 0.75, y: 0.25 }, null).robots[2].start.theta, 1);
  assert.ok(!("goal" in duplicateRobot(FLEET, 0, { x: 0.75, y: 0.25 }, null).robots[2]));
});

test("the nearest free place is clear of walls, map edges and other robots", () => {
  const { grid } = readScene({ map: { rows: ["........", "..#.....", "........", "........"] } });
  const place = (x, y, radius, others = []) => nearestFreePlace(grid, { x, y }, radius, others);
  assert.deepEqual(place(2.5, 0.5, 0.5), { x: 2.5, y: 0.5 });
  assert.deepEqual(place(0.2, 0.2, 0.6), { x: 1.5, y: 1.5 });
  assert.notDeepEqual(place(2.5, 2.5, 0.4), { x: 2.5, y: 2.5 });
  const beside = place(5.5, 1.5, 0.5, [{ x: 5.5, y: 1.5, radius: 0.5 }]);
  assert.equal(Math.hypot(beside.x - 5.5, beside.y - 1.5), 1);
  assert.equal(place(4, 2, 3), null);
  assert.deepEqual(nearestFreePlace(grid, { x: 5.5, y: 1.5 }, 0.5, [], 2), { x: 7.5, y: 1.5 });
});

test("positions snap to the centres of cells, or to a fine grid", () => {
  const { grid } = readScene(FLEET);
  assert.deepEqual(snapPoint(grid, { x: 0.61, y: 0.4 }, false), { x: 0.75, y: 0.25 });
  assert.deepEqual(snapPoint(grid, { x: 0.61234, y: 0.4 }, true), { x: 0.612, y: 0.4 });
  assert.deepEqual(snapPoint(null, { x: 0.61234, y: 0.4 }, false), { x: 0.61, y: 0.4 });
});

test("headings snap to 15 degrees, or to 1 degree", () => {
  assert.equal(snapHeading(degrees(52), false), degrees(45));
  assert.equal(snapHeading(degrees(52.3), true), degrees(52));
  assert.equal(snapHeading(degrees(-178), false), Math.PI);
  assert.ok(Object.is(snapHeading(degrees(359), false), 0));
});

test("turning goes to the next multiple of 15 degrees", () => {
  assert.ok(Math.abs(turned(0, 1) - degrees(15)) < 1e-12);
  assert.ok(Math.abs(turned(1, -1) - degrees(45)) < 1e-12);
  assert.ok(Math.abs(turned(degrees(180), 1) - degrees(-165)) < 1e-12);
});

test("a step moves by a cell, a fine step by a tenth of a cell", () => {
  const { grid } = readScene(FLEET);
  assert.deepEqual(stepped(grid, { x: 0.25, y: 0.25 }, { right: 1, up: 0 }, false), { x: 0.75, y: 0.25 });
  assert.deepEqual(stepped(grid, { x: 0.31, y: 0.25 }, { right: 1, up: 0 }, false), { x: 0.75, y: 0.25 });
  assert.deepEqual(stepped(grid, { x: 0.25, y: 0.25 }, { right: 0, up: 1 }, true), { x: 0.25, y: 0.3 });
});
