import assert from "node:assert/strict";
import { test } from "node:test";

import { latticePoints, spacingOf } from "../../../web/model/lattice.js";
import { readGrid } from "../../../web/model/scene.js";

const GRID = readGrid({ rows: ["..#.", "...."], resolution: 1, origin: { x: 10, y: 0 } }, null);
const ALL = { left: -100, bottom: -100, right: 100, top: 100 };

test("the points are the centres of free cells", () => {
  const points = latticePoints(GRID, 1, ALL).map(({ x, y }) => `${x},${y}`);
  assert.deepEqual(points, [
    "10.5,0.5",
    "11.5,0.5",
    "12.5,0.5",
    "13.5,0.5",
    "10.5,1.5",
    "11.5,1.5",
    "13.5,1.5",
  ]);
});

test("larger squares are counted from the lower left, as many as nearest fit, as in the service", () => {
  assert.deepEqual(latticePoints(GRID, 1.5, ALL), [
    { x: 10.75, y: 0.75 },
    { x: 12.25, y: 0.75 },
    { x: 13.75, y: 0.75 },
  ]);
});

test("only the points of a part are found", () => {
  const part = { left: 11, bottom: 0, right: 13, top: 1 };
  assert.deepEqual(
    latticePoints(GRID, 1, part).map(({ x }) => x),
    [11.5, 12.5],
  );
});

test("the spacing is what the answer tells, then what is asked for, then a cell", () => {
  const request = { options: { lattice_spacing: 0.4 } };
  assert.equal(spacingOf(GRID, request, { lattice_spacing: 0.25 }), 0.25);
  assert.equal(spacingOf(GRID, request, null), 0.4);
  assert.equal(spacingOf(GRID, { options: { lattice_spacing: null } }, {}), 1);
});
