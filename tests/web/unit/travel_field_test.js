import assert from "node:assert/strict";
import { test } from "node:test";

import { readGrid } from "../../../web/model/scene.js";
import { bandOf, bandsUpTo, shadeOf, TravelField } from "../../../web/model/travel_field.js";

const gridOf = (columns, rows, more = {}) =>
  readGrid({ rows: Array(rows).fill(".".repeat(columns)), ...more }, null);

test("squares are cells, or larger ones of a large map", () => {
  const small = new TravelField(gridOf(7, 3, { resolution: 0.5 }));
  assert.deepEqual([small.columns, small.rows, small.size], [7, 3, 0.5]);
  const large = new TravelField(gridOf(2000, 2000, { resolution: 0.05 }));
  assert.deepEqual([large.columns, large.rows, large.cells, large.size], [100, 100, 20, 1]);
  const long = new TravelField(gridOf(16_000, 10));
  assert.ok(long.count <= 10_000, `${long.count}`);
});

test("each square is asked for once, coarse steps before fine ones", () => {
  const field = new TravelField(gridOf(20, 9));
  const order = [...field.squares()];
  assert.equal(order.length, 180);
  assert.equal(new Set(order).size, 180);
  assert.deepEqual(order.slice(0, 2), [4 * 20 + 4, 4 * 20 + 12]);
});

test("the middle of a square beyond the edge is that of its part on the map", () => {
  const field = new TravelField(gridOf(150, 101, { origin: { x: 10, y: 0 } }));
  assert.equal(field.cells, 2);
  assert.deepEqual(field.middleOf(0), { x: 11, y: 100 });
  assert.deepEqual(field.middleOf(field.count - 1), { x: 159, y: 0.5 });
});

test("squares that are not known yet take the time of a coarser one", () => {
  const field = new TravelField(gridOf(8, 8));
  assert.equal(field.timeTo(0, 0), null);
  field.set(4 * 8 + 4, 12);
  assert.deepEqual(field.timeTo(0, 0), { seconds: 12, isNear: true });
  field.set(2 * 8 + 2, 20);
  assert.deepEqual(field.timeTo(0, 0), { seconds: 20, isNear: true });
  assert.deepEqual(field.timeTo(7, 7), { seconds: 12, isNear: true });
  field.set(0, null);
  assert.deepEqual(field.timeTo(0, 0), { seconds: Infinity, isNear: false });
  field.setNoRoom(1);
  assert.equal(field.timeTo(1, 0), null);
  assert.deepEqual([field.most, field.hasNoWay, field.hasTimes, field.known], [20, true, true, 4]);
});

test("the time at a point is that of its square; there is none outside of the map", () => {
  const field = new TravelField(gridOf(4, 2, { resolution: 0.5, origin: { x: 10, y: -1 } }));
  field.set(1, 3);
  assert.equal(field.timeAt({ x: 10.6, y: -0.2 }).seconds, 3);
  for (const [x, y] of [
    [9.9, -0.2],
    [12.1, -0.2],
    [10.6, 0.1],
    [10.6, -1.1],
  ]) {
    assert.equal(field.timeAt({ x, y }), null);
  }
});

test("bands are round, at most seven, and use the first and the last colour", () => {
  assert.deepEqual(bandsUpTo(24.3), { step: 5, count: 5 });
  assert.deepEqual(bandsUpTo(0), { step: 1, count: 1 });
  for (let most = 0.3; most < 5000; most *= 1.37) {
    const bands = bandsUpTo(most);
    assert.ok(bands.count <= 7 && bands.count * bands.step >= most - 1e-9, `${most}`);
    assert.equal(bandOf(most, bands), bands.count - 1);
    assert.equal(bandOf(0, bands), 0);
  }
  assert.deepEqual(
    [0, 1, 2].map((band) => shadeOf(band, 3)),
    [0, 3, 6],
  );
  assert.equal(shadeOf(0, 1), 0);
});
