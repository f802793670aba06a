// Files of maps for tests: images made byte by byte, and ways to pass files to the page.

import { deflateSync } from "node:zlib";

/** A raw 8-bit graymap of rows of grays. */
export function pgm(rows) {
  return Buffer.concat([
    Buffer.from(`P5\n# for a test\n${rows[0].length} ${rows.length}\n255\n`),
    Buffer.from(rows.flat()),
  ]);
}

const CHANNELS = { 0: 1, 2: 3, 4: 2, 6: 4 }; // by colour type

/** An 8-bit PNG of a colour type (0 gray, 2 RGB, 4 gray and alpha, 6 RGBA) from rows of channels. */
export function png(colourType, rows) {
  const header = Buffer.alloc(13);
  header.writeUInt32BE(rows[0].length / CHANNELS[colourType], 0);
  header.writeUInt32BE(rows.length, 4);
  header.set([8, colourType, 0, 0, 0], 8);
  const unfiltered = Buffer.from(rows.flatMap((row) => [0, ...row]));
  return Buffer.concat([
    Buffer.from([137, 80, 78, 71, 13, 10, 26, 10]),
    chunk("IHDR", header),
    chunk("IDAT", deflateSync(unfiltered)),
    chunk("IEND", Buffer.alloc(0)),
  ]);
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
