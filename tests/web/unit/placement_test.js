// Where robots fit.

import assert from "node:assert/strict";
import { test } from "node:test";

import { endDisks, misplaced, placeWithRoom, startDisks } from "../../../web/model/placement.js";
import { readScene } from "../../../web/model/scene.js";

/** A room of 2 m by 2 m with walls of 0.5 m, in cells of 0.1 m. */
const WALL = "#".repeat(30);
const ROOM = `#####${".".repeat(20)}#####`;
const MAP = {
  rows: [...Array(5).fill(WALL), ...Array(20).fill(ROOM), ...Array(5).fill(WALL)],
  resolution: 0.1,
};
const sceneOf = (robots) => readScene({ map: MAP, robot_defaults: { radius: 0.3 }, robots });

test("a disk is put beside the wall or the disk that is in its way, if that is near", () => {
  const { grid } = sceneOf([]);
  const place = (x, y, others = []) => placeWithRoom(grid, { x, y }, 0.3, others);
  assert.deepEqual(place(1.51, 1.49), { x: 1.55, y: 1.45 });
  assert.deepEqual(place(0.6, 1.52), { x: 0.85, y: 1.55 });
  assert.equal(place(0.2, 1.5), null, "deep in the wall");
  const beside = place(1.55, 1.55, [{ x: 1.05, y: 1.55, radius: 0.3 }]);
  assert.ok(Math.hypot(beside.x - 1.05, beside.y - 1.55) >= 0.6 - 1e-9, JSON.stringify(beside));
  assert.equal(place(1.55, 1.55, [{ x: 1.55, y: 1.55, radius: 0.3 }]), null, "on another one");
});

test("robots without room are found, each once", () => {
  const scene = sceneOf([
    { id: "fits", start: { x: 1, y: 1 }, goal: { x: 2, y: 2 } },
    { id: "in-wall", start: { x: 0.7, y: 2 }, goal: { x: 0.7, y: 2 } },
    { id: "onto-parked", start: { x: 1.4, y: 2 }, goal: { x: 2, y: 1.1 } },
    { id: "parked", start: { x: 2, y: 1 } },
  ]);
  assert.deepEqual(
    misplaced(scene).map(({ robot, pose }) => [robot.id, pose]),
    [
      ["in-wall", "start"],
      ["onto-parked", "goal"],
    ],
  );
  assert.deepEqual(misplaced({ ...scene, grid: null }), []);
});

test("a robot stays at its goal, or at its start if it has none", () => {
  const scene = sceneOf([
    { id: "a", start: { x: 1, y: 1 }, goal: { x: 2, y: 2 } },
    { id: "b", start: { x: 2, y: 1 } },
  ]);
  const placesOf = (disks) => disks.map(({ x, y, radius }) => [x, y, radius]);
  assert.deepEqual(placesOf(startDisks(scene)), [
    [1, 1, 0.3],
    [2, 1, 0.3],
  ]);
  assert.deepEqual(placesOf(endDisks(scene)), [
    [2, 2, 0.3],
    [2, 1, 0.3],
  ]);
  assert.deepEqual(placesOf(endDisks(scene, scene.robots[1])), [[2, 2, 0.3]]);
});

test("a robot stays at its last goal with its last radius, and at none of several poses yet", () => {
  const loads = [
    { x: 1, y: 1, radius_after: 0.5 },
    { x: 1.5, y: 1 },
    { x: 2, y: 2 },
  ];
  const scene = sceneOf([
    { id: "loaded", start: { x: 1, y: 1 }, goals: loads },
    { id: "loads-last", start: { x: 1, y: 2 }, goal: { x: 1, y: 2, radius_after: 0.2 } },
    {
      id: "any",
      start: { x: 2, y: 1 },
      goal: {
        any_of: [
          { x: 2, y: 1 },
          { x: 2, y: 1.4 },
        ],
      },
    },
  ]);
  const discs = endDisks(scene).map(({ x, y, radius }) => [x, y, radius]);
  assert.deepEqual(discs, [
    [2, 2, 0.5],
    [1, 2, 0.2],
  ]);
  const near = sceneOf([
    {
      id: "loaded",
      start: { x: 1, y: 2 },
      goals: [
        { ...loads[0], y: 2 },
        { x: 1.7, y: 2 },
      ],
    },
    { id: "beside", start: { x: 1, y: 1 }, goal: { x: 1, y: 2 } },
    {
      id: "any",
      start: { x: 2, y: 1 },
      goal: {
        any_of: [
          { x: 1, y: 1 },
          { x: 2, y: 1.4 },
        ],
      },
    },
  ]);
  assert.deepEqual(
    misplaced(near).map(({ robot, pose }) => [robot.id, pose]),
    [
      ["loaded", "goal"],
      ["beside", "goal"],
    ],
  );
});

test("robots that yield may have the goals of others", () => {
  const place = { x: 1, y: 2 };
  const robots = [
    { id: "first", start: { x: 1, y: 1 }, goal: place, idle: "yield" },
    { id: "second", start: { x: 2, y: 2 }, goal: place },
    { id: "idle", start: { x: 2, y: 1 }, idle: "yield" },
  ];
  const found = (list) => misplaced(sceneOf(list)).map(({ robot, pose }) => [robot.id, pose]);
  assert.deepEqual(found(robots), []);
  assert.equal(endDisks(sceneOf(robots)).length, 1);
  const { idle: _, ...staying } = robots[0];
  assert.deepEqual(found([staying, ...robots.slice(1)]), [
    ["first", "goal"],
    ["second", "goal"],
  ]);
  assert.deepEqual(found([{ ...robots[0], goal: { x: 0.6, y: 2 } }]), [["first", "goal"]]);
});
