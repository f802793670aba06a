// PNG images of gray pixels, 8 bits each: the smallest form of a large map.

import { crc32 } from "./png.js";

const SIGNATURE = [137, 80, 78, 71, 13, 10, 26, 10];

/** The bytes of an image of `grays`, row by row from the top. */
export async function writePng(width, height, grays) {
  const lines = new Uint8Array((width + 1) * height); // each begins with 0: it is not filtered
  for (let row = 0; row < height; row += 1) {
    lines.set(grays.subarray(row * width, (row + 1) * width), row * (width + 1) + 1);
  }
  const header = new Uint8Array(13);
  const view = new DataView(header.buffer);
  view.setUint32(0, width);
  view.setUint32(4, height);
  view.setUint8(8, 8); // bits of a pixel, of the colour type 0: gray
  const packed = new Blob([lines]).stream().pipeThrough(new CompressionStream("deflate"));
  const deflated = new Uint8Array(await new Response(packed).arrayBuffer());
  return joined([
    Uint8Array.from(SIGNATURE),
    chunk("IHDR", header),
    chunk("IDAT", deflated),
    chunk("IEND", new Uint8Array(0)),
  ]);
}

function chunk(name, content) {
  const made = new Uint8Array(content.length + 12);
  const view = new DataView(made.buffer);
  view.setUint32(0, content.length);
  made.set(new TextEncoder().encode(name), 4);
  made.set(content, 8);
  view.setUint32(content.length + 8, crc32(made.subarray(4, content.length + 8)));
  return made;
}

function joined(parts) {
  const made = new Uint8Array(parts.reduce((length, part) => length + part.length, 0));
  let at = 0;
  for (const part of parts) {
    made.set(part, at);
    at += part.length;
  }
  return made;
}
