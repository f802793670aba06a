// The pixels of a map's image: portable graymaps (netpbm's PGM), plain and raw, 8 and 16 bits, and PNGs.

import { FileError } from "../model/problem.js";
import { isPng, readPng } from "./png.js";

const SPACE = new Set([9, 10, 11, 12, 13, 32]);
const HASH = 35;
const MAX_PIXELS = 2 ** 28; // more is a mistake

/** The pixels for classifyPixels. Rejects with FileError. */
export async function readImage(bytes) {
  return isPng(bytes) ? readPng(bytes) : readPgm(bytes);
}

/** The pixels of a graymap, see classifyPixels. Throws FileError. */
export function readPgm(bytes) {
  const magic = String.fromCharCode(bytes[0], bytes[1]);
  if (magic !== "P2" && magic !== "P5") {
    throw new FileError(
      /^P[1346]$/.test(magic)
        ? `It is a netpbm image of the kind ${magic}, not a graymap: convert it to PGM (P5).`
        : "It does not begin as a PGM image (P2 or P5).",
    );
  }
  const reader = new HeaderReader(bytes);
  const width = reader.number("width", MAX_PIXELS);
  const height = reader.number("height", MAX_PIXELS);
  const largest = reader.number("largest gray", 65535);
  const pixels = width * height;
  if (pixels > MAX_PIXELS) throw new FileError(`Its ${width} x ${height} pixels are too many for a map.`);
  const values = magic === "P5" ? rawValues(bytes, reader.at, pixels, largest) : plainValues(reader, pixels);
  const bright = values.findIndex((value) => value > largest);
  if (bright !== -1) {
    throw new FileError(
      `Pixel ${bright % width}, ${Math.floor(bright / width)} is ${values[bright]}, above the largest gray ` +
        `${largest} that its header names.`,
    );
  }
  return { width, height, channels: 1, largest, values };
}

/** Reads numbers in ASCII with white space and comments between. */
class HeaderReader {
  #bytes;
  at = 2; // after the magic number

  constructor(bytes) {
    this.#bytes = bytes;
  }

  /** Bytes not read yet. */
  get left() {
    return this.#bytes.length - this.at;
  }

  /** The next whole number from 1 to `most`. */
  number(what, most) {
    const value = this.next();
    if (value >= 1 && value <= most) return value;
    throw new FileError(`Its header has no ${what} from 1 to ${most}; is it truncated or damaged?`);
  }

  /** The next whole number, or NaN where there is none. */
  next() {
    const bytes = this.#bytes;
    while (SPACE.has(bytes[this.at]) || bytes[this.at] === HASH) {
      if (bytes[this.at] === HASH) while (this.at < bytes.length && bytes[this.at] !== 10) this.at += 1;
      else this.at += 1;
    }
    const first = this.at;
    let value = 0;
    for (; bytes[this.at] >= 48 && bytes[this.at] <= 57; this.at += 1) {
      value = value * 10 + bytes[this.at] - 48;
    }
    return this.at > first ? value : NaN;
  }
}

function plainValues(reader, pixels) {
  const cut = (index) =>
    new FileError(`It has ${index} of ${pixels} pixels and then something else: it is truncated or damaged.`);
  if (reader.left < 2 * pixels - 1) throw cut("too few");
  const values = new Float64Array(pixels);
  for (let index = 0; index < pixels; index += 1) {
    values[index] = reader.next();
    if (Number.isNaN(values[index])) throw cut(index);
  }
  return values;
}

/** One byte of white space ends the header; two where lines end with carriage return and line feed. */
function rawValues(bytes, headerEnd, pixels, largest) {
  const wide = largest > 255;
  const size = pixels * (wide ? 2 : 1);
  const crlf =
    bytes[headerEnd] === 13 && bytes[headerEnd + 1] === 10 && bytes.length === headerEnd + 2 + size;
  const first = headerEnd + (crlf ? 2 : 1);
  if (bytes.length < first + size) {
    const left = Math.max(0, bytes.length - first);
    throw new FileError(`Its pixels need ${size} bytes, but ${left} follow the header: it is truncated.`);
  }
  if (!wide) return bytes.subarray(first, first + size);
  const view = new DataView(bytes.buffer, bytes.byteOffset + first, size);
  return Uint16Array.from({ length: pixels }, (_, index) => view.getUint16(2 * index));
}
