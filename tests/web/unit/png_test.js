import assert from "node:assert/strict";
import { test } from "node:test";

import { grayOfRgba, hasAlpha, isPng, sizeOf } from "../../../web/files/png.js";

const chunk = (type, ...data) => [
  0,
  0,
  0,
  data.length,
  ...[...type].map((letter) => letter.charCodeAt(0)),
  ...data,
  0,
  0,
  0,
  0,
];
const png = (colourType, ...chunks) =>
  Uint8Array.from([
    ...[137, 80, 78, 71, 13, 10, 26, 10],
    ...chunk("IHDR", 0, 0, 0, 1, 0, 0, 0, 1, 8, colourType, 0, 0, 0),
    ...chunks.flat(),
  ]);

test("a PNG is known by its first bytes", () => {
  assert.equal(isPng(png(0)), true);
  assert.equal(isPng(Uint8Array.from([80, 53, 10])), false);
});

test("a PNG's header has its size", () => {
  assert.deepEqual(sizeOf(png(0)), { width: 1, height: 1 });
  assert.deepEqual(sizeOf(png(0).subarray(0, 20)), { width: 0, height: 0 });
});

test("an image has alpha by its colour type or by a chunk of transparent colours", () => {
  assert.equal(hasAlpha(png(6)), true);
  assert.equal(hasAlpha(png(4)), true);
  assert.equal(hasAlpha(png(3, chunk("PLTE", 1, 2, 3), chunk("tRNS", 0), chunk("IDAT", 0))), true);
  assert.equal(hasAlpha(png(0, chunk("gAMA", 0, 0, 0, 1), chunk("IDAT", 0), chunk("tRNS", 0))), false);
  assert.equal(hasAlpha(png(2)), false);
});

test("the gray of a colour is the mean of its channels", () => {
  const rgba = { width: 2, height: 1, data: Uint8ClampedArray.from([10, 20, 33, 255, 255, 255, 255, 254]) };
  const opaque = grayOfRgba(rgba, { alpha: false, mode: "trinary" });
  assert.deepEqual(
    [...opaque.values].map((value) => value / opaque.maxval),
    [21 / 255, 1],
  );
  assert.deepEqual([...opaque.clear], [0, 1]);
  assert.deepEqual([opaque.width, opaque.height], [2, 1]);
});

test("an alpha channel counts as a fourth colour in the mode trinary alone", () => {
  const rgba = { width: 1, height: 1, data: Uint8ClampedArray.from([0, 0, 0, 255]) };
  const { values, maxval } = grayOfRgba(rgba, { alpha: true, mode: "trinary" });
  assert.equal(values[0] / maxval, 0.25);
  assert.deepEqual([...grayOfRgba(rgba, { alpha: true, mode: "scale" }).values], [0]);
});
