import assert from "node:assert/strict";
import { test } from "node:test";

import { thinned } from "../../../web/model/thinned_curve.js";

const curve = (...points) => ({ t: points.map(([t]) => t), gap: points.map(([, gap]) => gap) });

test("of the points in one pixel the lowest is kept", () => {
  const points = curve([0, 5], [0.4, 1], [0.9, 3], [1.2, 7], [1.6, 8], [3.5, 2]);
  assert.deepEqual(thinned(points, { from: 0, to: 4 }, 4), [1, 3, 5]);
  assert.deepEqual(thinned(points, { from: 0, to: 4 }, 400), [0, 1, 2, 3, 4, 5]);
});

test("of the points out of sight the nearest on each side is kept, so that lines lead there", () => {
  const points = curve([0, 5], [1, 4], [2, 3], [3, 2], [4, 1], [5, 0]);
  assert.deepEqual(thinned(points, { from: 1.5, to: 3.5 }, 10), [1, 2, 3, 4]);
  assert.deepEqual(thinned(points, { from: 2, to: 3 }, 10), [1, 2, 3, 4]);
});

test("a plan that takes no time has one point", () => {
  assert.deepEqual(thinned(curve([0, 5]), { from: 0, to: 0 }, 100), [0]);
});
