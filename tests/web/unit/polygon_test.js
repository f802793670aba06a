import assert from "node:assert/strict";
import { test } from "node:test";

import { distanceToPolygon } from "../../../web/model/polygon.js";

const SQUARE = [
  { x: 0, y: 0 },
  { x: 2, y: 0 },
  { x: 2, y: 2 },
  { x: 0, y: 2 },
];
const NOTCHED = [...SQUARE, { x: 1, y: 1 }]; // without the triangle at its left side

test("the distance is that of the nearest side or corner, and none inside", () => {
  const distances = [
    [1, 1],
    [3, 1],
    [1, -0.5],
    [5, 6],
    [2, 1],
    [-1, 2],
  ].map(([x, y]) => distanceToPolygon({ x, y }, SQUARE));
  assert.deepEqual(distances, [0, 1, 0.5, 5, 0, 1]);
});

test("a notch is outside, whichever way the corners go round", () => {
  for (const corners of [NOTCHED, [...NOTCHED].reverse()]) {
    assert.equal(distanceToPolygon({ x: 1.5, y: 1 }, corners), 0);
    assert.ok(Math.abs(distanceToPolygon({ x: 0.5, y: 1 }, corners) - Math.SQRT1_2 / 2) < 1e-12);
  }
});

test("a side without length is a point", () => {
  const corners = [...SQUARE, SQUARE[3]];
  assert.equal(distanceToPolygon({ x: -1, y: 2 }, corners), 1);
});
