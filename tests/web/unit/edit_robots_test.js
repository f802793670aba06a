import assert from "node:assert/strict";
import { test } from "node:test";

import {
  addRobot,
  deleteRobot,
  duplicateRobot,
  freshId,
  nameOf,
  removeGoal,
  setDefault,
  setPose,
  setRobot,
} from "../../../web/model/edit_robots.js";
import { nearestFreePlace } from "../../../web/model/free_place.js";
import { readScene } from "../../../web/model/scene.js";
import { snapHeading, snapPoint, stepped, turned } from "../../../web/model/snap.js";

const REQUEST = {
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
  const moved = setPose(REQUEST, 0, "start", { x: 0.75, y: 0.25 });
  assert.deepEqual(moved.robots[0].start, { x: 0.75, y: 0.25, theta: 1 });
  assert.equal(moved.robots[1], REQUEST.robots[1]);
  assert.equal(moved.map, REQUEST.map);
  assert.deepEqual(setPose(REQUEST, 1, "goal", { theta: undefined }).robots[1].goal, { x: 2.25, y: 0.25 });
  assert.deepEqual(setPose(REQUEST, 0, "goal", { x: 1, y: 2 }).robots[0].goal, { x: 1, y: 2 });
});

test("an edit that changes nothing is the same request", () => {
  assert.equal(setPose(REQUEST, 0, "start", { x: 0.25 }), REQUEST);
  assert.equal(setRobot(REQUEST, 0, "radius", 0.2), REQUEST);
  assert.equal(removeGoal(REQUEST, 0), REQUEST);
});

test("a robot's members and the defaults are set and left out", () => {
  assert.equal(setRobot(REQUEST, 1, "radius", -1).robots[1].radius, -1);
  assert.ok(!("radius" in setRobot(REQUEST, 0, "radius", undefined).robots[0]));
  const defaults = setDefault(REQUEST, "radius", 0.3);
  assert.deepEqual(defaults.robot_defaults, { radius: 0.3 });
  assert.deepEqual(setDefault(defaults, "radius", undefined), REQUEST);
  assert.ok(!("goal" in removeGoal(REQUEST, 1).robots[1]));
});

test("a robot that is no object, or robots that are no list, can be edited", () => {
  assert.deepEqual(setPose({ robots: [7] }, 0, "start", { x: 1 }).robots, [{ start: { x: 1 } }]);
  const placed = setPose({ robots: [{ start: "here" }] }, 0, "start", { y: 1 });
  assert.deepEqual(placed.robots, [{ start: { y: 1 } }]);
  assert.equal(addRobot({ robots: "none" }, { x: 0, y: 0 }).robots.length, 1);
  assert.equal(addRobot(null, { x: 0, y: 0 }).robots[0].radius, 0.4);
  assert.equal(nameOf({ robots: [7] }, 0), "#0");
});

test("a new robot goes on with the others' pattern and is like the last", () => {
  const [, , robot] = addRobot(REQUEST, { x: 1, y: 1 }, { x: 2, y: 2 }).robots;
  assert.deepEqual(robot, {
    id: "robot-4",
    radius: 0.2, // of the map's cells
    linear_speed: 1,
    angular_speed: 3.1416,
    start: { x: 1, y: 1 },
    goal: { x: 2, y: 2 },
  });
  const first = deleteRobot(REQUEST, 1);
  assert.equal(addRobot(first, { x: 1, y: 1 }).robots[1].linear_speed, 1.5);
  const withDefaults = { ...REQUEST, robot_defaults: { radius: 0.1, linear_speed: 1, angular_speed: 1 } };
  assert.deepEqual(addRobot(withDefaults, { x: 1, y: 1 }).robots[2], {
    id: "robot-4",
    start: { x: 1, y: 1 },
  });
});

test("fresh ids are unique and keep to the pattern", () => {
  assert.equal(freshId({}), "robot-1");
  assert.equal(freshId(ids("amr-08", "amr-09")), "amr-10");
  assert.equal(freshId(ids("robot-3", "robot-4", "robot-3b", "heavy")), "robot-5");
  assert.equal(freshId(ids("a1", "a3", "a2")), "a4");
  assert.equal(freshId(ids("heavy", "east"), "heavy"), "heavy-1");
  assert.equal(freshId(ids("heavy", "heavy-1"), "heavy"), "heavy-2");
  assert.equal(freshId(ids("tote-1", "pallet-1"), "tote-1"), "tote-2");
});

test("a duplicate is the same but for its id and places", () => {
  const [, , copy] = duplicateRobot(REQUEST, 1, { x: 0.75, y: 0.25 }, { x: 1.75, y: 0.25 }).robots;
  assert.deepEqual(copy, {
    id: "robot-4",
    start: { x: 0.75, y: 0.25 },
    goal: { x: 1.75, y: 0.25, theta: 0 },
  });
  assert.equal(duplicateRobot(REQUEST, 0, { x: 0.75, y: 0.25 }, null).robots[2].start.theta, 1);
  assert.ok(!("goal" in duplicateRobot(REQUEST, 0, { x: 0.75, y: 0.25 }, null).robots[2]));
});

test("the nearest free place is clear of walls, of the map's end and of others", () => {
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

test("places snap to the middle of cells, or finely when free", () => {
  const { grid } = readScene(REQUEST);
  assert.deepEqual(snapPoint(grid, { x: 0.61, y: 0.4 }, false), { x: 0.75, y: 0.25 });
  assert.deepEqual(snapPoint(grid, { x: 0.61234, y: 0.4 }, true), { x: 0.612, y: 0.4 });
  assert.deepEqual(snapPoint(null, { x: 0.61234, y: 0.4 }, false), { x: 0.61, y: 0.4 });
});

test("headings snap to 15 degrees, or to one when free", () => {
  assert.equal(snapHeading(degrees(52), false), degrees(45));
  assert.equal(snapHeading(degrees(52.3), true), degrees(52));
  assert.equal(snapHeading(degrees(-178), false), Math.PI);
  assert.ok(Object.is(snapHeading(degrees(359), false), 0));
});

test("turning leads to the next 15 degrees either way", () => {
  assert.ok(Math.abs(turned(0, 1) - degrees(15)) < 1e-12);
  assert.ok(Math.abs(turned(1, -1) - degrees(45)) < 1e-12);
  assert.ok(Math.abs(turned(degrees(180), 1) - degrees(-165)) < 1e-12);
});

test("a step leads to the next cell, a fine one a tenth of it", () => {
  const { grid } = readScene(REQUEST);
  assert.deepEqual(stepped(grid, { x: 0.25, y: 0.25 }, { right: 1, up: 0 }, false), { x: 0.75, y: 0.25 });
  assert.deepEqual(stepped(grid, { x: 0.31, y: 0.25 }, { right: 1, up: 0 }, false), { x: 0.75, y: 0.25 });
  assert.deepEqual(stepped(grid, { x: 0.25, y: 0.25 }, { right: 0, up: 1 }, true), { x: 0.25, y: 0.3 });
});
