import assert from "node:assert/strict";
import { test } from "node:test";

import {
  doingAt,
  normalizeAngle,
  pathOf,
  poseAt,
  poseInAction,
  remainingPath,
  turnBetween,
} from "../../../web/model/timeline.js";

const { PI } = Math;
const near = (actual, expected) =>
  assert.ok(Math.abs(actual - expected) < 1e-12, `${actual} is not ${expected}`);
const pose = (x, y, theta = 0) => ({ x, y, theta });
const turn = (t_start, t_end, from, to) => ({
  type: "rotate",
  t_start,
  t_end,
  from: pose(0, 0, from),
  to: pose(0, 0, to),
});

// Turns left, goes 2 m up, waits 1 s, goes 1 m up.
const ACTIONS = [
  { type: "rotate", t_start: 0, t_end: 0.5, from: pose(1, 1, 0), to: pose(1, 1, PI / 2) },
  { type: "translate", t_start: 0.5, t_end: 2.5, from: pose(1, 1, PI / 2), to: pose(1, 3, PI / 2) },
  { type: "wait", t_start: 2.5, t_end: 3.5, from: pose(1, 3, PI / 2), to: pose(1, 3, PI / 2) },
  { type: "translate", t_start: 3.5, t_end: 4.5, from: pose(1, 3, PI / 2), to: pose(1, 4, PI / 2) },
];

test("angles are normalized into the half-open range that ends at pi", () => {
  near(normalizeAngle(0), 0);
  near(normalizeAngle(PI), PI);
  near(normalizeAngle(-PI), PI);
  near(normalizeAngle(3 * PI), PI);
  near(normalizeAngle(-3 * PI), PI);
  near(normalizeAngle(2 * PI), 0);
  near(normalizeAngle(-PI / 2 - 4 * PI), -PI / 2);
});

test("a turn goes the shorter way", () => {
  near(turnBetween(0, 1), 1);
  near(turnBetween(1, 0), -1);
  near(turnBetween(3, -3), 2 * PI - 6);
  near(turnBetween(-3, 3), 6 - 2 * PI);
});

test("a turn by exactly pi is counter-clockwise from either side", () => {
  near(turnBetween(0, PI), PI);
  near(turnBetween(PI, 0), PI);
  near(turnBetween(PI / 2, -PI / 2), PI);
  near(turnBetween(-PI / 2, PI / 2), PI);
});

test("a half turn passes through the heading a quarter turn to the left", () => {
  near(poseInAction(turn(0, 2, 0, PI), 1).theta, PI / 2);
  near(poseInAction(turn(0, 2, PI, 0), 1).theta, -PI / 2);
});

test("a turn across the seam stays the shorter way and in range", () => {
  near(poseInAction(turn(0, 1, 3, -3), 0.5).theta, PI);
  near(poseInAction(turn(0, 1, -3, 3), 0.25).theta, -3 - (2 * PI - 6) / 4);
});

test("positions within a translation are proportional to time", () => {
  assert.deepEqual(poseAt(ACTIONS, pose(1, 1), 1), pose(1, 1.5, PI / 2));
  assert.deepEqual(poseAt(ACTIONS, pose(1, 1), 2.25), pose(1, 2.75, PI / 2));
});

test("a robot stands at its start before and at its goal after the plan", () => {
  assert.deepEqual(poseAt(ACTIONS, pose(1, 1), -1), pose(1, 1, 0));
  assert.deepEqual(poseAt(ACTIONS, pose(1, 1), 4.5), pose(1, 4, PI / 2));
  assert.deepEqual(poseAt(ACTIONS, pose(1, 1), 100), pose(1, 4, PI / 2));
});

test("a robot without actions stands at its start", () => {
  assert.deepEqual(poseAt([], pose(7, 8, 1), 3), pose(7, 8, 1));
});

test("where two actions meet the pose is the one they share", () => {
  for (const { t_end, to } of ACTIONS) assert.deepEqual(poseAt(ACTIONS, pose(1, 1), t_end), to);
});

test("the state of a robot is that of its current action", () => {
  const actual = [0, 0.49, 0.5, 2.49, 2.5, 3.5, 4.49, 4.5, 9].map((t) => doingAt(ACTIONS, t));
  const expected = [
    "turning",
    "turning",
    "moving",
    "moving",
    "waiting",
    "moving",
    "moving",
    "arrived",
    "arrived",
  ];
  assert.deepEqual(actual, expected);
  assert.equal(doingAt([], 0), "arrived");
});

test("a path has a corner for each end of a translation", () => {
  assert.deepEqual(pathOf(ACTIONS), [
    { x: 1, y: 1 },
    { x: 1, y: 3 },
    { x: 1, y: 4 },
  ]);
  assert.deepEqual(pathOf([ACTIONS[0], ACTIONS[2]]), []);
});

test("the remaining path starts at the robot's position", () => {
  assert.deepEqual(remainingPath(ACTIONS, pose(1, 1), 1.5), [
    { x: 1, y: 2 },
    { x: 1, y: 3 },
    { x: 1, y: 4 },
  ]);
  assert.deepEqual(remainingPath(ACTIONS, pose(1, 1), 3), [
    { x: 1, y: 3 },
    { x: 1, y: 4 },
  ]);
  assert.deepEqual(remainingPath(ACTIONS, pose(1, 1), 5), [{ x: 1, y: 4 }]);
});
