// Playback of robots that need time to start and to stop.

import assert from "node:assert/strict";
import { test } from "node:test";

import { Follower, motionOf } from "../../../web/model/motion.js";
import {
  inertiaAfter,
  inertiaOf,
  shareAt,
  speedAt,
  timeAtShare,
  withChanges,
} from "../../../web/model/profile.js";
import { poseAt } from "../../../web/model/timeline.js";

const ROBOT = { linear_acceleration: 1, linear_deceleration: 0.5, angular_acceleration: 2 };
const at = (x, theta = 0) => ({ x, y: 0, theta });
// 18 m at 2 m/s: 2 m in 2 s, 12 m in 6 s, 4 m in 4 s.
const DRIVE = {
  type: "translate",
  t_start: 1,
  t_end: 13,
  from: at(0),
  to: at(18),
  profile: { start: 0, cruise: 2, end: 0 },
};
const [ACTION] = withChanges([DRIVE], inertiaOf(ROBOT, {}));

test("the speed rises, stays and falls", () => {
  assert.deepEqual(ACTION.changes, { rise: 2, fall: 4 });
  for (const [t, speed] of [
    [1, 0],
    [2, 1],
    [3, 2],
    [6, 2],
    [11, 1],
    [13, 0],
  ]) {
    assert.ok(Math.abs(speedAt(ACTION, t, 18) - speed) < 1e-12, `${t} s`);
  }
});

test("the robot is where this speed has brought it", () => {
  for (const [t, x] of [
    [0, 0],
    [2, 0.5],
    [3, 2],
    [9, 14],
    [11, 17],
    [13, 18],
    [20, 18],
  ]) {
    assert.ok(Math.abs(poseAt([ACTION], at(0), t).x - x) < 1e-9, `${t} s`);
  }
});

test("the time of a share is the inverse of the share at a time", () => {
  for (const t of [1.5, 2.5, 7, 10, 12.9])
    assert.ok(Math.abs(timeAtShare(ACTION, shareAt(ACTION, t)) - t) < 1e-9);
});

test("without accelerations of the robot, and without a profile, actions are as ever", () => {
  const plain = { ...DRIVE, profile: undefined };
  assert.equal(withChanges([plain], inertiaOf(ROBOT, {}))[0], plain);
  assert.ok(Math.abs(poseAt([plain], at(0), 7).x - 9) < 1e-12);
  assert.deepEqual(inertiaOf({}, { linear_acceleration: 4 }), { rise: 0.25, fall: 0.25, turn: 0 });
});

test("a load changes how the actions after it begin and end", () => {
  const robot = inertiaOf(ROBOT, {});
  const loaded = inertiaAfter({ linear_acceleration_after: 0.25 }, robot);
  assert.deepEqual(loaded, { rise: 4, fall: 4, turn: robot.turn });
  assert.deepEqual(inertiaAfter({ linear_deceleration_after: 0.1 }, loaded), { ...loaded, fall: 10 });
  assert.deepEqual(inertiaAfter({ radius_after: 1 }, robot), robot);
  const second = { ...DRIVE, t_start: DRIVE.t_end, t_end: DRIVE.t_end + 17 }; // 8 m in 8 s, 2 m in 1 s, 8 m in 8 s
  const [before, after] = withChanges([DRIVE, second], robot, [{ t: DRIVE.t_end, inertia: loaded }]);
  assert.deepEqual(before, withChanges([DRIVE], robot)[0]);
  assert.equal(after.changes.rise, 8);
});

test("a profile that does not fit into its action is left out", () => {
  const inertia = inertiaOf(ROBOT, {});
  for (const profile of [
    { start: 0, cruise: 3, end: 0 },
    { start: 2, cruise: 1, end: 0 },
    { start: 0, cruise: 1, end: 2 },
    { start: 0, cruise: null, end: 0 },
  ]) {
    const brief = { ...DRIVE, t_end: DRIVE.t_start + 8, profile };
    assert.equal(withChanges([brief], inertia)[0].changes, undefined);
    assert.ok(Math.abs(poseAt([brief], at(0), 5).x - 9) < 1e-12);
  }
});

test("a rotation turns as its angular acceleration allows", () => {
  const profile = { start: 0, cruise: 1, end: 0 };
  const [turn] = withChanges(
    [{ type: "rotate", t_start: 0, t_end: 2, from: at(0, 0), to: at(0, 1.5), profile }],
    inertiaOf(ROBOT, {}),
  );
  assert.ok(Math.abs(poseAt([turn], at(0), 0.5).theta - 0.25) < 1e-9);
  assert.ok(Math.abs(poseAt([turn], at(0), 1).theta - 0.75) < 1e-9);
});

test("gaps are measured along the way that it drives", () => {
  const motion = motionOf({ start: at(0), radius: 0.4 }, [ACTION]);
  assert.deepEqual([...motion.knots], [1, 0, 0, 3, 2, 0, 9, 14, 0, 13, 18, 0]);
  assert.deepEqual([...motion.ramps], [0, 1, 0, -1]);
  const follower = new Follower(motion);
  for (let t = 0; t < 14; t += 0.125) {
    follower.look(t, t);
    assert.ok(Math.abs(follower.x - poseAt([ACTION], at(0), t).x) < 1e-12, `${t} s`);
  }
});
