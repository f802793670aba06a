import assert from "node:assert/strict";
import { test } from "node:test";

import { actionInWords, totals, causeOfWait } from "../../../web/model/itinerary.js";
import { motionOf } from "../../../web/model/motion.js";

const { PI } = Math;
const pose = (x, y, theta = 0) => ({ x, y, theta });
const action = (type, t_start, t_end, from, to) => ({ type, t_start, t_end, from, to });

test("time and distance are summed by type of action", () => {
  const actions = [
    action("rotate", 0, 0.5, pose(0, 0, 0), pose(0, 0, 1)),
    action("translate", 0.5, 5.5, pose(0, 0, 1), pose(3, 4, 1)),
    action("wait", 5.5, 6, pose(3, 4, 1), pose(3, 4, 1)),
    action("translate", 6, 8, pose(3, 4, 1), pose(3, 6, 1)),
  ];
  assert.deepEqual(totals(actions), { moving: 7, turning: 0.5, waiting: 0.5, distance: 7 });
  assert.deepEqual(totals([]), { moving: 0, turning: 0, waiting: 0, distance: 0 });
});

test("actions are described with the significant digits", () => {
  const drive = (length) => actionInWords(action("translate", 0, 1, pose(0, 0), pose(length, 0)));
  assert.deepEqual(
    [drive(0.0123), drive(0.5), drive(3.24), drive(12), drive(132.4)],
    ["drive 0.012 m", "drive 0.5 m", "drive 3.2 m", "drive 12 m", "drive 132 m"],
  );
  const back = { ...action("translate", 0, 1, pose(0, 0), pose(-0.8, 0)), reverse: true };
  assert.equal(actionInWords(back), "reverse 0.8 m");
  assert.equal(actionInWords(action("wait", 2, 3.44, pose(0, 0), pose(0, 0))), "wait 1.4 s");
});

test("a turn is described by its angle and side", () => {
  const turn = (from, to) => actionInWords(action("rotate", 0, 1, pose(0, 0, from), pose(0, 0, to)));
  assert.equal(turn(0, PI / 2), "turn 90° left");
  assert.equal(turn(0, -PI / 4), "turn 45° right");
  assert.equal(turn(-3, 3), "turn 16.2° right");
  assert.equal(turn(0, PI), "turn 180° left");
});

// Contact is no hit: disks overlap by half a micrometre before they count as hit, which takes a moment.
const near = (actual, expected) =>
  assert.ok(Math.abs(actual - expected) < 5e-6, `${actual} is not ${expected}`);
const RADIUS = 0.5;

/** Actions through (t, x, y), one a piece: a wait where it stays. */
function through(...points) {
  return points.slice(1).map(([t_end, toX, toY], k) => {
    const [t_start, x, y] = points[k];
    const type = x === toX && y === toY ? "wait" : "translate";
    return { type, t_start, t_end, from: { x, y, theta: 0 }, to: { x: toX, y: toY, theta: 0 } };
  });
}

/** A fleet of robots of one size, given by their actions. */
function fleetOf(plans) {
  const motions = Object.entries(plans).map(([id, actions]) => [
    id,
    motionOf({ radius: RADIUS, start: actions[0].from }, actions),
  ]);
  return new Map(motions);
}

// Waits 4 s for a robot that comes along the crossing at x = 5 and passes it at t = 6.
const CROSSING = {
  waiter: through([0, 0, 0], [1, 1, 0], [5, 1, 0], [14, 10, 0]),
  passer: through([0, 5, 6], [12, 5, -6]),
};

test("the cause of a wait is the robot that would be hit without it", () => {
  const found = causeOfWait("waiter", CROSSING.waiter, 1, fleetOf(CROSSING));
  assert.equal(found.robot, "passer");
  // Without the wait they are at (t, 0) and (5, 6 - t): 1 m apart first when (5 - t)² + (6 - t)² = 1.
  near(found.t, 5);
});

test("touching is not a hit", () => {
  const beside = through([0, 5, 1], [12, 5, 1]);
  const { waiter } = CROSSING;
  assert.equal(causeOfWait("waiter", waiter, 1, fleetOf({ waiter, beside })), null);
  const nearer = through([0, 5, 0.999], [12, 5, 0.999]);
  assert.equal(causeOfWait("waiter", waiter, 1, fleetOf({ waiter, nearer })).robot, "nearer");
});

test("with a margin, a robot passed too closely counts as hit", () => {
  const beside = through([0, 5, 1.1], [12, 5, 1.1]);
  const { waiter } = CROSSING;
  assert.equal(causeOfWait("waiter", waiter, 1, fleetOf({ waiter, beside }), 0.1), null);
  const found = causeOfWait("waiter", waiter, 1, fleetOf({ waiter, beside }), 0.2);
  near(found.t, 5 - Math.sqrt(1.2 ** 2 - 1.1 ** 2));
});

test("of several robots, the one hit first is the cause", () => {
  const later = through([0, 9, 8], [16, 9, -8]);
  const found = causeOfWait("waiter", CROSSING.waiter, 1, fleetOf({ later, ...CROSSING }));
  assert.equal(found.robot, "passer");
});

test("a hit may come several actions after the wait", () => {
  const waiter = through([0, 0, 0], [3, 0, 0], [5, 2, 0], [6, 2, 0], [9, 2, 3], [10, 3, 3]);
  const passer = through([0, 8, 3], [10, -2, 3]);
  const found = causeOfWait("waiter", waiter, 0, fleetOf({ waiter, passer }));
  assert.equal(found.robot, "passer");
  // Driving up from t = 3, it is at (2, t - 3), the other at (8 - t, 3): (6 - t)² + (6 - t)² = 1.
  near(found.t, 6 - Math.SQRT1_2);
});

test("a robot passing the place of an early arrival is hit there", () => {
  const waiter = through([0, 0, 0], [6, 0, 0], [8, 2, 0]);
  const passer = through([0, 2, 5], [10, 2, -5]);
  near(causeOfWait("waiter", waiter, 0, fleetOf({ waiter, passer })).t, 4);
});

test("a wait that prevents no hit has no cause", () => {
  const { waiter } = CROSSING;
  assert.equal(causeOfWait("waiter", waiter, 1, fleetOf({ waiter })), null);
  const gone = through([0, 5, 0], [1, 5, 9], [12, 5, 9]);
  assert.equal(causeOfWait("waiter", waiter, 1, fleetOf({ waiter, gone })), null);
  const afterwards = through([0, 30, 0], [14, 30, 0], [40, 4, 0]);
  assert.equal(causeOfWait("waiter", waiter, 1, fleetOf({ waiter, afterwards })), null);
});
