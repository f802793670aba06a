// The speeds of a robot over time.

import assert from "node:assert/strict";
import { test } from "node:test";

import { inertiaOf, withChanges } from "../../../web/model/profile.js";
import { greatest, speedLines, speedsAt } from "../../../web/model/speeds.js";

const at = (x, theta = 0) => ({ x, y: 0, theta });
const drive = (t_start, t_end, from, to, more = {}) => ({
  type: "translate",
  t_start,
  t_end,
  from: at(from),
  to: at(to),
  ...more,
});

// 18 m at 2 m/s: 2 m in 2 s, 12 m in 6 s, 4 m in 4 s. Then it turns 2 rad clockwise in 2 s, at most 2 rad/s.
const INERTIA = { linear_acceleration: 1, linear_deceleration: 0.5, angular_acceleration: 2 };
const SMOOTH = withChanges(
  [
    drive(1, 13, 0, 18, { profile: { start: 0, cruise: 2, end: 0 } }),
    { type: "wait", t_start: 13, t_end: 14, from: at(18), to: at(18) },
    {
      type: "rotate",
      t_start: 14,
      t_end: 16,
      from: at(18),
      to: at(18, -2),
      profile: { start: 0, cruise: 2, end: 0 },
    },
  ],
  inertiaOf(INERTIA, {}),
);

test("speeds of a robot that accelerates are lines that rise, stay and fall", () => {
  const { drive: driving, turn } = speedLines(SMOOTH);
  assert.deepEqual(driving, [
    [0, 0],
    [1, 0],
    [3, 2],
    [9, 2],
    [13, 0],
    [16, 0],
  ]);
  assert.deepEqual(turn, [
    [0, 0],
    [14, 0],
    [15, -2],
    [16, 0],
  ]);
});

test("without a profile the speed is constant, and jumps; backwards it is negative", () => {
  const actions = [drive(0, 2, 0, 3), drive(2, 4, 3, 6), drive(5, 6, 6, 4, { reverse: true })];
  const { drive: driving, turn } = speedLines(actions);
  assert.deepEqual(driving, [
    [0, 0],
    [0, 1.5],
    [4, 1.5],
    [4, 0],
    [5, 0],
    [5, -2],
    [6, -2],
    [6, 0],
  ]);
  assert.deepEqual(turn, [
    [0, 0],
    [6, 0],
  ]);
  assert.deepEqual(greatest(driving), [1.5, 2]);
  assert.deepEqual(greatest(turn), [0, 0]);
});

test("the speed at a time is that of the line; a robot rests before, between and after its actions", () => {
  const close = ({ drive: driving, turn }, expected) => {
    assert.ok(Math.abs(driving - expected[0]) < 1e-12 && Math.abs(turn - expected[1]) < 1e-12);
  };
  for (const [t, driving, turn] of [
    [0, 0, 0],
    [2, 1, 0],
    [6, 2, 0],
    [11, 1, 0],
    [13.5, 0, 0],
    [14.5, 0, -1],
    [15.75, 0, -0.5],
    [16, 0, 0],
    [99, 0, 0],
  ]) {
    close(speedsAt(SMOOTH, t), [driving, turn]);
  }
  close(speedsAt([], 1), [0, 0]);
});
