import assert from "node:assert/strict";
import { test } from "node:test";

import { panTime, revealTime, ticks, zoomTime } from "../../../web/model/time_range.js";

test("zooming keeps the moment under the pointer where it is", () => {
  assert.deepEqual(zoomTime({ from: 0, to: 8 }, 8, 2, 2), { from: 1, to: 5 });
  assert.deepEqual(zoomTime({ from: 1, to: 5 }, 8, 2, 0.5), { from: 0, to: 8 });
});

test("zooming out shows no more than the plan, zooming in no less than there is to see", () => {
  assert.deepEqual(zoomTime({ from: 6, to: 8 }, 8, 8, 0.01), { from: 0, to: 8 });
  const closest = zoomTime({ from: 0, to: 8 }, 8, 4, 1e9);
  assert.ok(Math.abs(closest.to - closest.from - 0.05) < 1e-12);
  assert.deepEqual(zoomTime({ from: 0, to: 0 }, 0, 0, 2), { from: 0, to: 0 });
});

test("panning stops at both ends", () => {
  assert.deepEqual(panTime({ from: 2, to: 4 }, 10, 3), { from: 5, to: 7 });
  assert.deepEqual(panTime({ from: 2, to: 4 }, 10, 30), { from: 8, to: 10 });
  assert.deepEqual(panTime({ from: 2, to: 4 }, 10, -3), { from: 0, to: 2 });
});

test("a moment out of sight is brought into it, one in sight moves nothing", () => {
  const range = { from: 2, to: 4 };
  assert.equal(revealTime(range, 10, 4), range);
  const later = revealTime(range, 10, 5);
  assert.ok(later.from < 5 && later.to > 5 && later.from > 2);
  const sooner = revealTime(range, 10, 1);
  assert.ok(sooner.from < 1 && sooner.to > 1);
  assert.deepEqual(revealTime(range, 10, 10), { from: 8, to: 10 });
});

test("ticks are round and as many as there is room for", () => {
  assert.deepEqual(ticks({ from: 0, to: 44.1 }, 10), { step: 5, times: [0, 5, 10, 15, 20, 25, 30, 35, 40] });
  assert.deepEqual(ticks({ from: 3, to: 7 }, 4).times, [3, 4, 5, 6, 7]);
  assert.equal(ticks({ from: 1.03, to: 1.08 }, 6).step, 0.01);
  assert.deepEqual(ticks({ from: 0, to: 0 }, 5).times, [0]);
});
