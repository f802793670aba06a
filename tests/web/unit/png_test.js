import assert from "node:assert/strict";
import { test } from "node:test";

import { isPng, readPng } from "../../../web/files/png.js";
import { png } from "../support/map_files.js";

const valuesOf = async (...image) => [...(await readPng(png(...image))).values];

test("a PNG is recognised by its first bytes", () => {
  assert.equal(isPng(png(0, [[0]])), true);
  assert.equal(isPng(Uint8Array.from([80, 53, 10])), false);
});

test("channels of any depth are widened to 16 bits", async () => {
  const image = await readPng(
    png(0, [
      [0, 255],
      [7, 100],
    ]),
  );
  const { values, ...form } = image;
  assert.deepEqual(form, { width: 2, height: 2, channels: 1, largest: 65535 });
  assert.deepEqual([...values], [0, 65535, 7 * 257, 100 * 257]);
  assert.deepEqual(await valuesOf(0, [[1, 0, 1]], { depth: 1 }), [65535, 0, 65535]);
  assert.deepEqual(await valuesOf(0, [[1, 2, 3]], { depth: 2 }), [21845, 43690, 65535]);
  assert.deepEqual(await valuesOf(0, [[258, 65535]], { depth: 16 }), [258, 65535]);
  assert.deepEqual(await valuesOf(2, [[1, 2, 3]]), [257, 514, 771]);
});

test("palettes and transparent colours are expanded", async () => {
  const PLTE = [10, 20, 30, 1, 1, 1];
  assert.deepEqual(await valuesOf(3, [[1, 0]], { chunks: { PLTE } }), [257, 257, 257, 2570, 5140, 7710]);
  assert.deepEqual(
    await valuesOf(3, [[1, 0]], { chunks: { PLTE, tRNS: [0] } }),
    [257, 257, 257, 65535, 2570, 5140, 7710, 0],
  );
  assert.deepEqual(await valuesOf(0, [[5, 6]], { chunks: { tRNS: [0, 5] } }), [1285, 0, 1542, 65535]);
  const colours = [[1, 2, 3, 1, 2, 4]];
  const opaque = [257, 514, 1028, 65535];
  assert.deepEqual(await valuesOf(2, colours, { chunks: { tRNS: [0, 1, 0, 2, 0, 3] } }), [
    257,
    514,
    771,
    0,
    ...opaque,
  ]);
});

test("every filter is undone, of plain and interlaced images", async () => {
  for (const [type, channels] of [
    [0, 1],
    [2, 3],
    [4, 2],
    [6, 4],
  ]) {
    const rows = Array.from({ length: 11 }, (_, row) =>
      Array.from({ length: 13 * channels }, (__, at) => (31 * row * row + 57 * at) % 256),
    );
    const expected = rows.flat().map((value) => 257 * value);
    assert.deepEqual(await valuesOf(type, rows), expected);
    assert.deepEqual(await valuesOf(type, rows, { interlaced: true }), expected);
  }
  assert.deepEqual(await valuesOf(0, [[9]], { interlaced: true }), [9 * 257]);
});

test("a damaged PNG is rejected wherever it is cut or changed", async () => {
  const whole = png(0, [
    [1, 2, 3],
    [4, 5, 6],
  ]);
  for (let length = 8; length < whole.length; length += 1) {
    await assert.rejects(readPng(whole.subarray(0, length)), /It is damaged/, String(length));
  }
  for (let at = 8; at < whole.length; at += 1) {
    const changed = Buffer.from(whole);
    changed[at] ^= 0x10;
    await assert.rejects(readPng(changed), /It is damaged/, String(at));
  }
});
