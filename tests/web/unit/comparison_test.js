import assert from "node:assert/strict";
import { test } from "node:test";

import { compareRobots, nearestAmong } from "../../../web/model/comparison.js";
import { motionOf } from "../../../web/model/motion.js";

const at = (x, y) => ({ x, y, theta: 0 });
const drive = (t_start, t_end, from, to) => ({ type: "translate", t_start, t_end, from, to });
const rest = (t_start, t_end, where) => ({ type: "wait", t_start, t_end, from: where, to: where });
const ACTIONS = [rest(0, 1, at(0, 0)), drive(1, 4, at(0, 0), at(3, 0))];

test("robots have their figures side by side, unknown ones as null", () => {
  const tracks = new Map([
    ["a", { actions: ACTIONS, cost: 4, lowerBound: 3 }],
    ["b", { actions: [], cost: null, lowerBound: null }],
  ]);
  assert.deepEqual(compareRobots(["a", "b"], tracks), [
    { id: "a", cost: 4, delay: 1, moving: 3, turning: 0, waiting: 1, distance: 3 },
    { id: "b", cost: null, delay: null, moving: 0, turning: 0, waiting: 0, distance: 0 },
  ]);
});

test("the nearest approach is that of the chosen robots only", () => {
  const robot = (x, y, actions = []) => motionOf({ start: at(x, y), radius: 0.5 }, actions, []);
  const motions = new Map([
    ["a", robot(0, 0, ACTIONS)],
    ["b", robot(2, 2)],
    ["c", robot(2, -1)],
  ]);
  const { t, gap, ids } = nearestAmong(["a", "b"], motions);
  assert.deepEqual([t, gap, ids], [3, 1, ["a", "b"]]);
  assert.equal(nearestAmong(["a"], motions), null);
});
