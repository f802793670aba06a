import assert from "node:assert/strict";
import { test } from "node:test";

import {
  firstOverlap,
  Follower,
  knotTimes,
  lastKnot,
  motionOf,
  radiusAt,
} from "../../../web/model/motion.js";

const ROBOT = { radius: 0.5, start: { x: 7, y: 8 } };
const action = (t_start, t_end, from, to) => ({
  t_start,
  t_end,
  from: { x: from[0], y: from[1] },
  to: { x: to[0], y: to[1] },
});

test("a robot without actions stands at its start", () => {
  const { radius, knots } = motionOf(ROBOT, []);
  assert.equal(radius, 0.5);
  assert.deepEqual([...knots], [0, 7, 8]);
});

test("a motion has knots only where it changes", () => {
  const actions = [
    action(0, 1, [0, 0], [0, 0]),
    action(1, 2, [0, 0], [0, 0]),
    action(2, 4, [0, 0], [2, 0]),
    action(4, 5, [2, 0], [2, 0]),
    action(5, 9, [2, 0], [2, 0]),
  ];
  assert.deepEqual([...motionOf(ROBOT, actions).knots], [0, 0, 0, 2, 0, 0, 4, 2, 0, 9, 2, 0]);
});

test("jumps of a faulty plan are kept, steps back in time are dropped", () => {
  const actions = [
    action(0, 2, [0, 0], [2, 0]),
    action(2, 3, [5, 5], [6, 5]),
    action(1, 4, [6, 5], [6, 6]),
    action(4, Number.NaN, [6, 6], [9, 9]),
  ];
  assert.deepEqual([...motionOf(ROBOT, actions).knots], [0, 0, 0, 2, 2, 0, 2, 5, 5, 3, 6, 5, 4, 6, 6]);
});

test("the times of several motions come sorted and once, with both ends", () => {
  const one = motionOf(ROBOT, [action(0, 2, [0, 0], [2, 0]), action(2, 5, [2, 0], [2, 3])]);
  const two = motionOf(ROBOT, [action(0, 1, [0, 0], [2, 0]), action(1, 2, [2, 0], [2, 3])]);
  assert.equal(lastKnot([one, two]), 5);
  assert.deepEqual([...knotTimes([one, two], 5)], [0, 1, 2, 5]);
  assert.deepEqual([...knotTimes([one, two], 1.5)], [0, 1, 1.5]);
  assert.deepEqual([...knotTimes([motionOf(ROBOT, [])], 0)], [0]);
});

test("a follower returns both ends of a span, in any order and beyond the motion", () => {
  const actions = [action(1, 3, [0, 0], [2, 0]), action(3, 4, [2, 0], [2, 3])];
  const follower = new Follower(motionOf(ROBOT, actions));
  const at = (t0, t1) => {
    follower.look(t0, t1);
    return [follower.x, follower.y, follower.endX, follower.endY];
  };
  assert.deepEqual(at(0, 1), [0, 0, 0, 0]);
  assert.deepEqual(at(1.5, 3), [0.5, 0, 2, 0]);
  assert.deepEqual(at(3, 4), [2, 0, 2, 3]);
  assert.deepEqual(at(4, 9), [2, 3, 2, 3]);
  assert.deepEqual(at(2, 2), [1, 0, 1, 0]);
});

test("a follower returns the next change of the motion", () => {
  const follower = new Follower(
    motionOf(ROBOT, [action(1, 3, [0, 0], [2, 0]), action(3, 4, [2, 0], [2, 3])]),
  );
  const next = [0, 1, 2, 3, 3.5, 4, 2.5].map((t) => follower.nextKnot(t));
  assert.deepEqual(next, [1, 3, 3, 4, 4, Infinity, 3]);
});

test("a span that ends where the robot jumps ends before the jump", () => {
  const follower = new Follower(
    motionOf(ROBOT, [action(0, 2, [0, 0], [2, 0]), action(2, 3, [5, 5], [6, 5])]),
  );
  follower.look(1, 2);
  assert.deepEqual([follower.endX, follower.endY], [2, 0]);
  follower.look(2, 3);
  assert.deepEqual([follower.x, follower.y], [5, 5]);
});

test("a radius that changes counts from its time on", () => {
  const loaded = motionOf({ radius: 0.5, start: { x: 0, y: 0 } }, [], [{ t: 3, radius: 0.8 }]);
  assert.deepEqual(
    [0, 2.9, 3, 9].map((t) => radiusAt(loaded, t)),
    [0.5, 0.5, 0.8, 0.8],
  );
  assert.deepEqual([...knotTimes([loaded], 4)], [0, 3, 4]);
  const passing = motionOf(ROBOT, [action(0, 10, [-5, 1.2], [5, 1.2])]);
  assert.equal(firstOverlap({ ...loaded, radii: [] }, passing, 0, 10), null);
  assert.equal(firstOverlap(loaded, passing, 0, 3), null);
  assert.ok(Math.abs(firstOverlap(loaded, passing, 0, 10) - (5 - 0.5)) < 1e-4);
});
