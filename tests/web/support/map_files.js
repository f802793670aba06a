// Files of maps for tests: images made byte by byte, and ways to pass files to the page.

import { deflateSync } from "node:zlib";

/** A raw 8-bit graymap of rows of grays. */
export function pgm(rows) {
  return Buffer.concat([
    Buffer.from(`P5\n# for a test\n${rows[0].length} ${rows.length}\n255\n`),
    Buffer.from(rows.flat()),
  ]);
}

const CHANNELS = { 0: 1, 2: 3, 3: 1, 4: 2, 6: 4 }; // by colour type
// The first column and row, and the steps, of the passes of an interlaced PNG.
const PASSES = ["0088", "4088", "0448", "2044", "0224", "1022", "0112"].map((pass) => [...pass].map(Number));

/**
 * A PNG of a colour type (0 gray, 2 RGB, 3 palette, 4 gray and alpha, 6 RGBA) from rows of channels of `depth` bits.
 * `chunks`: others, by type, before the pixels.
 */
export function png(colourType, rows, { depth = 8, interlaced = false, chunks = {} } = {}) {
  const header = Buffer.alloc(13);
  const channels = CHANNELS[colourType];
  header.writeUInt32BE(rows[0].length / channels, 0);
  header.writeUInt32BE(rows.length, 4);
  header.set([depth, colourType, 0, 0, interlaced ? 1 : 0], 8);
  const images = interlaced ? PASSES.map((pass) => pixelsOf(rows, channels, pass)) : [rows];
  const step = Math.ceil((channels * depth) / 8); // bytes to the pixel on the left
  const stored = images.map((image) =>
    filtered(
      image.filter((row) => row.length > 0).map((row) => packed(row, depth)),
      step,
    ),
  );
  return Buffer.concat([
    Buffer.from([137, 80, 78, 71, 13, 10, 26, 10]),
    chunk("IHDR", header),
    ...Object.entries(chunks).map(([type, data]) => chunk(type, Buffer.from(data))),
    chunk("IDAT", deflateSync(Buffer.concat(stored))),
    chunk("IEND", Buffer.alloc(0)),
  ]);
}

/** Every so many of the pixels. */
function pixelsOf(rows, channels, [left, top, across, down]) {
  return rows
    .filter((_, row) => row >= top && (row - top) % down === 0)
    .map((row) =>
      row.filter((_, at) => {
        const column = Math.floor(at / channels);
        return column >= left && (column - left) % across === 0;
      }),
    );
}

/** The bytes of channels of `depth` bits. */
function packed(row, depth) {
  if (depth === 8) return row;
  if (depth === 16) return row.flatMap((value) => [value >> 8, value & 255]);
  const bytes = Array(Math.ceil((row.length * depth) / 8)).fill(0);
  row.forEach((value, index) => {
    const bit = index * depth;
    bytes[bit >> 3] |= value << (8 - depth - (bit & 7));
  });
  return bytes;
}

/** The rows one after the other, each with a byte that names its filter: none, left, above and so on in turn. */
function filtered(lines, step) {
  return Buffer.concat(
    lines.map((line, row) => {
      const above = lines[row - 1];
      const filter = row % 5;
      const neighbour = (bytes, at) => bytes?.[at] ?? 0;
      const bytes = line.map((byte, at) => {
        const [left, up, corner] = [line[at - step] ?? 0, neighbour(above, at), neighbour(above, at - step)];
        return (byte - [0, left, up, (left + up) >> 1, nearest(left, up, corner)][filter]) & 255;
      });
      return Buffer.from([filter, ...bytes]);
    }),
  );
}

function nearest(left, up, corner) {
  const distance = (value) => Math.abs(left + up - corner - value);
  const [first] = [left, up, corner].sort((a, b) => distance(a) - distance(b)); // stable
  return first;
}

function chunk(type, data) {
  const named = Buffer.concat([Buffer.from(type), data]);
  const length = Buffer.alloc(4);
  length.writeUInt32BE(data.length);
  const sum = Buffer.alloc(4);
  sum.writeUInt32BE(crc32(named));
  return Buffer.concat([length, named, sum]);
}

function crc32(bytes) {
  let crc = 0xffffffff;
  for (const byte of bytes) {
    crc ^= byte;
    for (let bit = 0; bit < 8; bit += 1) crc = (crc >>> 1) ^ (crc & 1 ? 0xedb88320 : 0);
  }
  return (crc ^ 0xffffffff) >>> 0;
}

/** The two ways to pass files to the page, {name: content}, a text or a Buffer each. */
export const WAYS = {
  "through the file dialog": (page, files) =>
    page.setInputFiles(
      "#file",
      Object.entries(files).map(([name, content]) => ({
        name,
        mimeType: "application/octet-stream",
        buffer: Buffer.from(content),
      })),
    ),
  "by dropping": (page, files) =>
    page.evaluate(
      (dropped) => {
        const dataTransfer = new DataTransfer();
        for (const [name, bytes] of dropped) dataTransfer.items.add(new File([Uint8Array.from(bytes)], name));
        const options = { dataTransfer, bubbles: true, cancelable: true };
        document.body.dispatchEvent(new DragEvent("dragover", options));
        document.body.dispatchEvent(new DragEvent("drop", options));
      },
      Object.entries(files).map(([name, content]) => [name, [...Buffer.from(content)]]),
    ),
};

export const drop = WAYS["by dropping"];
