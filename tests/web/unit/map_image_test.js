import assert from "node:assert/strict";
import { test } from "node:test";

import { grayOfRgba, hasAlpha, isPng, readPgm, sizeOf } from "../../../web/files/map_image.js";

const bytesOf = (text, ...raw) =>
  Uint8Array.from([...text].map((letter) => letter.charCodeAt(0)).concat(raw));
const read = (...parts) => {
  const { values, ...header } = readPgm(bytesOf(...parts));
  return { ...header, values: [...values] };
};

test("a plain graymap is read with any white space and comments", () => {
  const expected = { width: 3, height: 2, maxval: 15, values: [0, 1, 2, 3, 14, 15] };
  assert.deepEqual(read("P2\n3 2\n15\n0 1 2\n3 14 15\n"), expected);
  assert.deepEqual(read("P2 # gray\r\n# by hand\r\n3\t2 #size\n15 0 1 2 # top\n3 14 15"), expected);
});

test("a raw graymap is read with 8 bits a pixel, or 16 with the high byte first", () => {
  assert.deepEqual(read("P5\n# CREATOR: GIMP 2.10\n2 1\n255\n", 10, 255), {
    width: 2,
    height: 1,
    maxval: 255,
    values: [10, 255],
  });
  assert.deepEqual(read("P5 2 1 65535\n", 1, 2, 255, 255).values, [258, 65535]);
  assert.deepEqual(read("P5 1 1 256\n", 1, 0).values, [256]);
});

test("pixels that look like white space or comments are pixels", () => {
  assert.deepEqual(read("P5 4 1 255\n", 10, 35, 32, 13).values, [10, 35, 32, 13]);
});

test("a header may end in carriage return and line feed", () => {
  assert.deepEqual(read("P5\r\n2 1\r\n255\r\n", 7, 8).values, [7, 8]);
  assert.deepEqual(read("P5 2 1 255\r", 10, 8).values, [10, 8]);
});

test("a raw graymap is read from a view into a larger buffer", () => {
  const whole = bytesOf("....P5 1 2 65535\n", 0, 1, 0, 2);
  assert.deepEqual([...readPgm(whole.subarray(4)).values], [1, 2]);
});

test("other and truncated images are rejected with the reason", () => {
  assert.throws(() => read("P6 1 1 255\n", 1, 2, 3), /of the kind P6.*convert it to PGM/);
  assert.throws(() => read("GIF89a"), /does not begin as a PGM/);
  assert.throws(() => read(""), /does not begin as a PGM/);
  assert.throws(() => read("P5 2"), /no height/);
  assert.throws(() => read("P5 0 2 255\n"), /no width/);
  assert.throws(() => read("P5 1 1 65536\n", 0, 0), /no largest gray/);
  assert.throws(() => read("P5 2 2 255\n", 1, 2, 3), /need 4 bytes, but 3 follow/);
  assert.throws(() => read("P5 100000 100000 255\n"), /too many/);
  assert.throws(() => read("P2 2 2 255 1 2 3"), /truncated/);
  assert.throws(() => read("P2 2 1 255 1 x 3"), /1 of 2 pixels/);
  assert.throws(() => read("P5 2 1 7\n", 7, 8), /Pixel 1, 0 is 8, above the largest gray 7/);
});

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

test("a PNG is recognised by its first bytes", () => {
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

test("an alpha channel counts as a fourth colour only in trinary mode", () => {
  const rgba = { width: 1, height: 1, data: Uint8ClampedArray.from([0, 0, 0, 255]) };
  const { values, maxval } = grayOfRgba(rgba, { alpha: true, mode: "trinary" });
  assert.equal(values[0] / maxval, 0.25);
  assert.deepEqual([...grayOfRgba(rgba, { alpha: true, mode: "scale" }).values], [0]);
});
