import assert from "node:assert/strict";
import { test } from "node:test";

import { actionInWords, totals } from "../../../web/model/itinerary.js";

const { PI } = Math;
const pose = (x, y, theta = 0) => ({ x, y, theta });
const action = (type, t_start, t_end, from, to) => ({ type, t_start, t_end, from, to });

test("time and distance are summed by what the robot does", () => {
  const actions = [
    action("rotate", 0, 0.5, pose(0, 0, 0), pose(0, 0, 1)),
    action("translate", 0.5, 5.5, pose(0, 0, 1), pose(3, 4, 1)),
    action("wait", 5.5, 6, pose(3, 4, 1), pose(3, 4, 1)),
    action("translate", 6, 8, pose(3, 4, 1), pose(3, 6, 1)),
  ];
  assert.deepEqual(totals(actions), { moving: 7, turning: 0.5, waiting: 0.5, distance: 7 });
  assert.deepEqual(totals([]), { moving: 0, turning: 0, waiting: 0, distance: 0 });
});

test("actions are told with as many digits as say something", () => {
  const drive = (length) => actionInWords(action("translate", 0, 1, pose(0, 0), pose(length, 0)));
  assert.deepEqual(
    [drive(0.0123), drive(0.5), drive(3.24), drive(12), drive(132.4)],
    ["drive 0.012 m", "drive 0.5 m", "drive 3.2 m", "drive 12 m", "drive 132 m"],
  );
  assert.equal(actionInWords(action("wait", 2, 3.44, pose(0, 0), pose(0, 0))), "wait 1.4 s");
});

test("a turn is told by its angle and side, the shorter way", () => {
  const turn = (from, to) => actionInWords(action("rotate", 0, 1, pose(0, 0, from), pose(0, 0, to)));
  assert.equal(turn(0, PI / 2), "turn 90° left");
  assert.equal(turn(0, -PI / 4), "turn 45° right");
  assert.equal(turn(-3, 3), "turn 16.2° right");
  assert.equal(turn(0, PI), "turn 180° left");
});
