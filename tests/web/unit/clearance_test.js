import assert from "node:assert/strict";
import { test } from "node:test";

import { clearanceOf, ClearanceSweep, spellsBelow } from "../../../web/model/clearance.js";

const near = (actual, expected) =>
  assert.ok(Math.abs(actual - expected) < 1e-12, `${actual} is not ${expected}`);
const motion = (radius, ...knots) => ({
  radius,
  knots: Float64Array.from(knots.flat()),
  ramps: new Float64Array(knots.length),
  radii: [],
});

/** Numbers in [0, 1) that look random and are the same in every run. */
function* numbers(seed) {
  for (let state = seed; ; ) {
    state = (state * 16807) % 2147483647;
    yield state / 2147483647;
  }
}

/** A fleet that wanders about in a square. */
function wanderers(count, legs, size, seed) {
  const random = numbers(seed);
  const next = () => random.next().value;
  return Array.from({ length: count }, () => {
    const knots = [[0, next() * size, next() * size]];
    for (let k = 0; k < legs; k += 1) {
      const [t, x, y] = knots[k];
      knots.push(next() < 0.3 ? [t + next(), x, y] : [t + next() * 2, next() * size, next() * size]);
    }
    return motion(0.1 + next() * 0.3, ...knots);
  });
}

function positionAt({ knots }, t) {
  let at = 0;
  while (at + 3 < knots.length && knots[at + 3] <= t) at += 3;
  const [t0, x0, y0, t1, x1, y1] = knots.subarray(at);
  if (t1 === undefined || t < t0) return [x0, y0];
  const share = (t - t0) / (t1 - t0);
  return [x0 + (x1 - x0) * share, y0 + (y1 - y0) * share];
}

function gapAt(motions, first, second, t) {
  const [x, y] = positionAt(motions[first], t);
  const [otherX, otherY] = positionAt(motions[second], t);
  return Math.hypot(otherX - x, otherY - y) - motions[first].radius - motions[second].radius;
}

test("robots that pass each other are nearest side by side", () => {
  const curve = clearanceOf([
    motion(0.25, [0, 0, 0], [10, 10, 0]),
    motion(0.5, [0, 10, 1], [10, 0, 1]),
    motion(1, [0, 50, 50]),
  ]);
  const k = curve.least;
  near(curve.gap[k], 0.25);
  near(curve.t[k], 5);
  assert.deepEqual([curve.first[k], curve.second[k]], [0, 1]);
});

test("every window of a plan has its own smallest gap", () => {
  const curve = clearanceOf([motion(1, [0, 0, 0], [8, 8, 0]), motion(1, [0, 0, 5], [8, 0, 5])], 4);
  const expected = [3, Math.hypot(2, 5) - 2, Math.hypot(4, 5) - 2, Math.hypot(6, 5) - 2];
  assert.equal(curve.gap.length, 4);
  expected.forEach((gap, k) => near(curve.gap[k], gap));
  assert.deepEqual([...curve.t], [0, 2, 4, 6]);
});

test("overlapping disks have a negative gap; fewer than two robots have no clearance", () => {
  const curve = clearanceOf([motion(1, [0, 0, 0]), motion(1, [0, 0.5, 0])]);
  assert.deepEqual([...curve.gap], [-1.5]);
  assert.equal(clearanceOf([motion(1, [0, 0, 0])]), null);
  assert.equal(clearanceOf([]), null);
});

test("the curve is a lower bound of all gaps, reached by the pair it names", () => {
  for (const [count, legs, size, seed] of [
    [2, 6, 5, 1],
    [9, 12, 8, 2],
    [25, 8, 40, 3],
  ]) {
    const motions = wanderers(count, legs, size, seed);
    const curve = clearanceOf(motions, 50);
    curve.t.forEach((t, k) => near(gapAt(motions, curve.first[k], curve.second[k], t), curve.gap[k]));
    const least = curve.gap[curve.least];
    assert.equal(least, Math.min(...curve.gap));
    const end = Math.max(...motions.map(({ knots }) => knots[knots.length - 3]));
    for (let step = 0; step <= 400; step += 1) {
      for (let a = 0; a < count; a += 1) {
        for (let b = a + 1; b < count; b += 1) {
          assert.ok(gapAt(motions, a, b, (end * step) / 400) >= least - 1e-12);
        }
      }
    }
  }
});

test("the nearest pair equals the one found by comparing all pairs, forward and backward", () => {
  const motions = wanderers(30, 10, 20, 7);
  const sweep = new ClearanceSweep(motions);
  for (const t of [0, 0.4, 3, 2.9, 11, 0.1, 99]) {
    const { gap, first, second } = sweep.nearestAt(t);
    near(gapAt(motions, first, second, t), gap);
    for (let a = 0; a < 30; a += 1) {
      for (let b = a + 1; b < 30; b += 1) assert.ok(gapAt(motions, a, b, t) >= gap - 1e-12);
    }
  }
});

test("without resting pairs, neighbours count only while one of them moves", () => {
  const mover = motion(0.5, [0, 10, 0], [4, 10, 0], [6, 12, 0]);
  const neighbours = [motion(0.5, [0, 0, 0]), motion(0.5, [0, 1, 0])];
  const curve = clearanceOf([...neighbours, mover], 6, false);
  assert.deepEqual([...curve.gap], [Infinity, Infinity, Infinity, Infinity, 8, 9]);
  assert.deepEqual([curve.first[curve.least], curve.second[curve.least]], [1, 2]);
  near(clearanceOf([...neighbours, mover], 6).gap[5], 0);
});

test("without resting pairs, one that overlaps counts, and one that leaves contact", () => {
  const overlapping = [motion(0.5, [0, 0, 0]), motion(0.5, [0, 0.9, 0])];
  near(clearanceOf(overlapping, 1, false).gap[0], -0.1);
  const leaving = [motion(0.5, [0, 0, 0]), motion(0.5, [0, 1, 0], [2, 1, 0], [4, 3, 0])];
  const { t, gap, least } = clearanceOf(leaving, 4, false);
  near(gap[least], 0);
  assert.equal(t[least], 2);
});

test("the times below a threshold are runs of windows with their nearest moment", () => {
  const gap = [3, 0.5, 0.2, 0.4, 2, Infinity, 0.1, 0.1];
  assert.deepEqual(spellsBelow({ gap }, 0.5), [
    { from: 2, to: 3, least: 2 },
    { from: 6, to: 7, least: 6 },
  ]);
  assert.deepEqual(spellsBelow({ gap }, 0), []);
});
