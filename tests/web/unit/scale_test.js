import assert from "node:assert/strict";
import { test } from "node:test";

import { lengthInWords, scaleBar, wayBetween } from "../../../web/model/scale.js";

test("a scale bar is the longest round length that fits", () => {
  assert.deepEqual(scaleBar(50, 110), { length: 2, pixels: 100 });
  assert.deepEqual(scaleBar(20, 100), { length: 5, pixels: 100 });
  assert.deepEqual(scaleBar(1, 110), { length: 100, pixels: 100 });
  for (let scale = 0.003; scale < 3000; scale *= 1.37) {
    const { length, pixels } = scaleBar(scale, 110);
    assert.ok(pixels <= 110.001 && pixels > 110 / 2.51, `${scale}: ${pixels}`);
    assert.ok([1, 2, 5].includes(Number(length.toExponential().split("e")[0])), `${length}`);
  }
});

test("lengths are in the unit that suits them", () => {
  assert.deepEqual([0.005, 0.2, 5, 2000].map(lengthInWords), ["5 mm", "20 cm", "5 m", "2 km"]);
});

test("a way has its distance and the heading it leads to", () => {
  const way = (x, y) => wayBetween({ x: 1, y: 1 }, { x: 1 + x, y: 1 + y });
  assert.deepEqual(way(3, 4).distance, 5);
  assert.deepEqual(
    [way(2, 0), way(0, 2), way(-2, 0), way(0, -2)].map(({ heading }) => heading),
    [0, 90, 180, 270],
  );
  assert.deepEqual([way(3, -4).across, way(3, -4).up], [3, -4]);
});
