import assert from "node:assert/strict";
import { test } from "node:test";

import { readPgm } from "../../../web/files/map_image.js";

const bytesOf = (text, ...raw) =>
  Uint8Array.from([...text].map((letter) => letter.charCodeAt(0)).concat(raw));
const read = (...parts) => {
  const { values, ...header } = readPgm(bytesOf(...parts));
  return { ...header, values: [...values] };
};

test("a plain graymap is read with any white space and comments", () => {
  const expected = { width: 3, height: 2, channels: 1, largest: 15, values: [0, 1, 2, 3, 14, 15] };
  assert.deepEqual(read("P2\n3 2\n15\n0 1 2\n3 14 15\n"), expected);
  assert.deepEqual(read("P2 # gray\r\n# by hand\r\n3\t2 #size\n15 0 1 2 # top\n3 14 15"), expected);
});

test("a raw graymap is read with 8 bits a pixel, or 16 with the high byte first", () => {
  assert.deepEqual(read("P5\n# CREATOR: GIMP 2.10\n2 1\n255\n", 10, 255), {
    width: 2,
    height: 1,
    channels: 1,
    largest: 255,
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
