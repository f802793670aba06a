import assert from "node:assert/strict";
import { test } from "node:test";

import { deleteRobots, differ, moveRobots, setRobots, sharedValue } from "../../../web/model/edit_group.js";

const REQUEST = {
  map: { rows: ["...."] },
  robots: [
    { id: "a", radius: 0.2, start: { x: 0.1, y: 0.5 }, goal: { x: 3.5, y: 0.5 } },
    { id: "b", radius: 0.3, start: { x: 1.5, y: 0.5, theta: 1 } },
    {
      id: "c",
      radius: 0.2,
      start: {},
      goals: [
        { x: 1, y: 1 },
        { x: 2, y: 1 },
      ],
    },
  ],
};

test("robots share a value, or differ", () => {
  assert.equal(sharedValue(REQUEST, [0, 2], "radius"), 0.2);
  assert.equal(sharedValue(REQUEST, [0, 1], "radius"), undefined);
  assert.deepEqual([differ(REQUEST, [0, 2], "radius"), differ(REQUEST, [0, 1], "radius")], [false, true]);
});

test("a member is set for the chosen robots and no others, and removed", () => {
  const set = setRobots(REQUEST, [0, 2], "radius", 0.4);
  assert.deepEqual(
    set.robots.map(({ radius }) => radius),
    [0.4, 0.3, 0.4],
  );
  assert.equal(set.robots[1], REQUEST.robots[1]);
  assert.equal(setRobots(REQUEST, [0, 2], "radius", 0.2), REQUEST, "nothing changes");
  assert.equal("radius" in setRobots(REQUEST, [1], "radius", undefined).robots[1], false);
});

test("starts and last goals are moved together, where there are any", () => {
  const by = { x: 0.2, y: -0.1 };
  const starts = moveRobots(REQUEST, [0, 1, 2], "start", by).robots.map(({ start }) => start);
  assert.deepEqual(starts, [{ x: 0.3, y: 0.4 }, { x: 1.7, y: 0.4, theta: 1 }, {}]);
  const moved = moveRobots(REQUEST, [0, 1, 2], "goal", by).robots;
  assert.deepEqual(moved[0].goal, { x: 3.7, y: 0.4 });
  assert.equal("goal" in moved[1], false);
  assert.deepEqual(moved[2].goals, [
    { x: 1, y: 1 },
    { x: 2.2, y: 0.9 },
  ]);
});

test("several robots are deleted at once", () => {
  assert.deepEqual(
    deleteRobots(REQUEST, [0, 2]).robots.map(({ id }) => id),
    ["b"],
  );
});
