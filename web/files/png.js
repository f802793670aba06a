// PNG images as stored, for maps: the browser's decoder would round colours that are not opaque, and has 8 bits a
// channel only.

import { FileError } from "../model/problem.js";

const SIGNATURE = [137, 80, 78, 71, 13, 10, 26, 10];
const MAX_PIXELS = 2 ** 26; // more would not fit in memory
const CHANNELS = { 0: 1, 2: 3, 3: 1, 4: 2, 6: 4 }; // as stored, by colour type
const DEPTHS = { 0: [1, 2, 4, 8, 16], 2: [8, 16], 3: [1, 2, 4, 8], 4: [8, 16], 6: [8, 16] }; // bits of a channel
const PALETTE = 3;
// The first column and row, and the steps, of the pixels of each pass of an interlaced image.
const PASSES = [
  [0, 0, 8, 8],
  [4, 0, 8, 8],
  [0, 4, 4, 8],
  [2, 0, 4, 4],
  [0, 2, 2, 4],
  [1, 0, 2, 2],
  [0, 1, 1, 2],
];

export function isPng(bytes) {
  return SIGNATURE.every((byte, index) => bytes[index] === byte);
}

/**
 * The pixels of a PNG: {width, height, channels, largest, values}, see classifyPixels. Palettes and transparent
 * colours are expanded, and channels of fewer than 16 bits widened. Rejects with FileError.
 */
export async function readPng(bytes) {
  const chunks = readChunks(bytes);
  const form = readHeader(chunks.IHDR?.[0]);
  if (form.type === PALETTE && !chunks.PLTE) throw damaged("it has no palette");
  const stored = unfilter(form, await inflate(chunks.IDAT ?? [], sizeOf(form)));
  return expand(form, stored, chunks.PLTE?.[0], chunks.tRNS?.[0]);
}

const damaged = (why) => new FileError(`It is damaged: ${why}. Save it again, or as PGM.`);

/** The content of the chunks, in lists by their type. */
function readChunks(bytes) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const chunks = {};
  for (let at = SIGNATURE.length; ; ) {
    if (at + 12 > bytes.length) throw damaged("the file ends too early");
    const end = at + 12 + view.getUint32(at);
    if (end > bytes.length) throw damaged("the file ends too early");
    const type = String.fromCharCode(...bytes.subarray(at + 4, at + 8));
    if (crc32(bytes.subarray(at + 4, end - 4)) !== view.getUint32(end - 4))
      throw damaged(`the check sum of its part ${type} is wrong`);
    (chunks[type] ??= []).push(bytes.subarray(at + 8, end - 4));
    if (type === "IEND") return chunks;
    at = end;
  }
}

const CRC_TABLE = Uint32Array.from({ length: 256 }, (_, byte) => {
  let crc = byte;
  for (let bit = 0; bit < 8; bit += 1) crc = (crc >>> 1) ^ (crc & 1 ? 0xedb88320 : 0);
  return crc;
});

export function crc32(bytes) {
  let crc = 0xffffffff;
  for (const byte of bytes) crc = CRC_TABLE[(crc ^ byte) & 255] ^ (crc >>> 8);
  return (crc ^ 0xffffffff) >>> 0;
}

function readHeader(header) {
  if (header?.length !== 13) throw damaged("it has no header");
  const view = new DataView(header.buffer, header.byteOffset, header.byteLength);
  const [width, height] = [view.getUint32(0), view.getUint32(4)];
  const [depth, type, compression, filter, interlaced] = header.subarray(8);
  const known = DEPTHS[type]?.includes(depth) && compression === 0 && filter === 0 && interlaced <= 1;
  if (width === 0 || height === 0 || !known) throw damaged("its header is invalid");
  if (width * height > MAX_PIXELS)
    throw new FileError(`Its ${width} x ${height} pixels are too many for a map.`);
  return { width, height, depth, type, interlaced: interlaced === 1 };
}

/** The images that are stored one after the other: {width, height, column, row, across, down}. */
function passesOf({ width, height, interlaced }) {
  if (!interlaced) return [{ width, height, column: 0, row: 0, across: 1, down: 1 }];
  return PASSES.map(([column, row, across, down]) => ({
    width: Math.ceil((width - column) / across),
    height: Math.ceil((height - row) / down),
    ...{ column, row, across, down },
  })).filter((pass) => pass.width > 0 && pass.height > 0);
}

const bytesOfRow = ({ type, depth }, width) => Math.ceil((width * CHANNELS[type] * depth) / 8);

/** The bytes of all filtered rows. */
const sizeOf = (form) =>
  passesOf(form).reduce((sum, { width, height }) => sum + height * (1 + bytesOfRow(form, width)), 0);

/** The first `size` bytes of the compressed parts together. */
async function inflate(parts, size) {
  const bytes = new Uint8Array(size);
  let at = 0;
  try {
    const stream = new Blob(parts).stream().pipeThrough(new DecompressionStream("deflate"));
    for (const reader = stream.getReader(); at < size; ) {
      const { done, value } = await reader.read();
      if (done) break;
      const part = value.subarray(0, size - at);
      bytes.set(part, at);
      at += part.length;
      if (at === size) await reader.cancel();
    }
  } catch {
    throw damaged("its pixels cannot be decompressed");
  }
  if (at < size) throw damaged("it has too few pixels");
  return bytes;
}

/** The rows without their filters, each after one byte, in place. */
function unfilter(form, bytes) {
  const step = Math.max(1, (CHANNELS[form.type] * form.depth) / 8); // bytes to the pixel on the left
  let first = 0;
  for (const { width, height } of passesOf(form)) {
    const length = bytesOfRow(form, width);
    for (let row = 0; row < height; row += 1, first += 1 + length) {
      const above = row > 0 ? bytes.subarray(first - length, first) : new Uint8Array(length);
      undo(bytes[first], bytes.subarray(first + 1, first + 1 + length), above, step);
    }
  }
  return bytes;
}

function undo(filter, line, above, step) {
  if (filter > 4) throw damaged("a row has an unknown filter");
  if (filter === 0) return;
  for (let at = 0; at < line.length; at += 1) {
    const left = at >= step ? line[at - step] : 0;
    if (filter === 1) line[at] += left;
    else if (filter === 2) line[at] += above[at];
    else if (filter === 3) line[at] += (left + above[at]) >> 1;
    else line[at] += paeth(left, above[at], at >= step ? above[at - step] : 0);
  }
}

/** The one of the three neighbours that is nearest to left + above - corner. */
function paeth(left, above, corner) {
  const [toLeft, toAbove] = [Math.abs(above - corner), Math.abs(left - corner)];
  const toCorner = Math.abs(left + above - 2 * corner);
  if (toLeft <= toAbove && toLeft <= toCorner) return left;
  return toAbove <= toCorner ? above : corner;
}

function expand(form, bytes, palette, transparent) {
  const { width, height, type } = form;
  const colours = type === PALETTE ? 3 : CHANNELS[type];
  const channels = colours + (transparent && (type === 0 || type === 2 || type === PALETTE) ? 1 : 0);
  const values = new Uint16Array(width * height * channels);
  const pixel = pixelReader(form, palette, transparent);
  let first = 0;
  for (const pass of passesOf(form)) {
    const length = bytesOfRow(form, pass.width);
    for (let row = 0; row < pass.height; row += 1, first += 1 + length) {
      const line = bytes.subarray(first + 1, first + 1 + length);
      const begin = (pass.row + row * pass.down) * width + pass.column;
      for (let column = 0; column < pass.width; column += 1)
        pixel(line, column, values, (begin + column * pass.across) * channels);
    }
  }
  return { width, height, channels, largest: 65535, values };
}

/** A function that writes the channels of a pixel of a row to `values`, from `at` on. */
function pixelReader({ type, depth }, palette, transparent) {
  const count = CHANNELS[type];
  const widened = 65535 / (2 ** depth - 1);
  const mask = 2 ** depth - 1;
  const stored = (line, index) => {
    if (depth === 8) return line[index];
    if (depth === 16) return line[2 * index] * 256 + line[2 * index + 1];
    return (line[(index * depth) >> 3] >> (8 - depth - ((index * depth) & 7))) & mask;
  };
  if (type === PALETTE)
    return (line, column, values, at) => {
      const index = stored(line, column);
      for (let colour = 0; colour < 3; colour += 1)
        values[at + colour] = 257 * (palette[3 * index + colour] ?? 0); // black where the palette ends earlier
      if (transparent) values[at + 3] = 257 * (transparent[index] ?? 255);
    };
  const clear = transparent && count !== 2 && count !== 4;
  return (line, column, values, at) => {
    let isClear = clear;
    for (let channel = 0; channel < count; channel += 1) {
      const value = stored(line, column * count + channel);
      values[at + channel] = value * widened;
      isClear &&= value === (transparent[2 * channel] * 256 + transparent[2 * channel + 1]) % (mask + 1);
    }
    if (clear) values[at + count] = isClear ? 0 : 65535;
  };
}
