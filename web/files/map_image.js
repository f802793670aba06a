// The gray pixels of a map's image: portable graymaps (netpbm's PGM), plain and raw, 8 and 16 bits, are read
// here; PNGs are decoded by the browser.

import { FileError } from "../model/problem.js";
import { contextOf } from "../ui/dom.js";

const MOST_PNG_PIXELS = 2 ** 26; // of a PNG: supported by all browsers
const SPACE = new Set([9, 10, 11, 12, 13, 32]);
const HASH = 35;
const MOST_PIXELS = 2 ** 28; // more is a mistake
const SIGNATURE = [137, 80, 78, 71, 13, 10, 26, 10];
const WITH_ALPHA = new Set([4, 6]); // colour types: gray and colour, each with alpha

/**
 * The pixels for classifyPixels, and `warnings` about them. `mode`: see readRosYaml. Rejects with FileError.
 */
export async function readImage(bytes, mode) {
  if (!isPng(bytes)) return { ...readPgm(bytes), warnings: [] };
  const alpha = hasAlpha(bytes);
  const pixels = grayOfRgba(await decode(bytes), { alpha, mode });
  const warnings = [];
  if (alpha && mode === "trinary") {
    warnings.push(
      "The image has an alpha channel; map_server counts it as a fourth colour, and so it is done here.",
    );
  }
  if (pixels.clear.includes(1)) {
    warnings.push(
      "The colours of pixels that are not opaque are known roughly only; of clear ones, not at all.",
    );
  }
  return { ...pixels, warnings };
}

/** The 8-bit RGBA of a PNG, as stored: {width, height, data}. */
async function decode(bytes) {
  const { width, height } = sizeOf(bytes);
  if (width * height > MOST_PNG_PIXELS)
    throw new FileError(`Its ${width} x ${height} pixels are too many to decode; convert it to PGM.`);
  let bitmap;
  try {
    /** @type {ImageBitmapOptions} */
    const asStored = { colorSpaceConversion: "none", premultiplyAlpha: "none" };
    bitmap = await createImageBitmap(new Blob([bytes], { type: "image/png" }), asStored);
  } catch {
    throw new FileError("It is damaged: the browser cannot decode it. Save it again, or as PGM.");
  }
  const canvas = document.createElement("canvas");
  canvas.width = width;
  canvas.height = height;
  const context = contextOf(canvas, { willReadFrequently: true });
  context.drawImage(bitmap, 0, 0);
  bitmap.close();
  return context.getImageData(0, 0, width, height);
}

/** {width, height, maxval, values}: the gray of each pixel, 0 to maxval, from the top. Throws FileError. */
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
  const width = reader.number("width", MOST_PIXELS);
  const height = reader.number("height", MOST_PIXELS);
  const maxval = reader.number("largest gray", 65535);
  const pixels = width * height;
  if (pixels > MOST_PIXELS) throw new FileError(`Its ${width} x ${height} pixels are too many for a map.`);
  const values = magic === "P5" ? rawValues(bytes, reader.at, pixels, maxval) : plainValues(reader, pixels);
  const bright = values.findIndex((value) => value > maxval);
  if (bright !== -1) {
    throw new FileError(
      `Pixel ${bright % width}, ${Math.floor(bright / width)} is ${values[bright]}, above the largest gray ` +
        `${maxval} that its header names.`,
    );
  }
  return { width, height, maxval, values };
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
function rawValues(bytes, headerEnd, pixels, maxval) {
  const wide = maxval > 255;
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

export function isPng(bytes) {
  return SIGNATURE.every((byte, index) => bytes[index] === byte);
}

/** {width, height} in pixels, from the header. */
export function sizeOf(bytes) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  return bytes.length < 24
    ? { width: 0, height: 0 }
    : { width: view.getUint32(16), height: view.getUint32(20) };
}

/** Whether the image has transparency: an alpha channel, or a tRNS chunk before its pixels. */
export function hasAlpha(bytes) {
  if (WITH_ALPHA.has(bytes[25])) return true;
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  for (let at = 8; at + 8 <= bytes.length; at += view.getUint32(at) + 12) {
    const type = String.fromCharCode(...bytes.subarray(at + 4, at + 8));
    if (type === "tRNS") return true;
    if (type === "IDAT") return false;
  }
  return false;
}

/**
 * The gray pixels, for classifyPixels, of 8-bit RGBA ones: the mean of the colours. In the mode "trinary"
 * map_server counts an alpha channel as a fourth colour, and so does this function.
 */
export function grayOfRgba({ width, height, data }, { alpha, mode }) {
  const values = new Uint16Array(width * height); // sums, as means would be rounded
  const clear = new Uint8Array(width * height);
  const averaged = alpha && mode === "trinary";
  for (let index = 0; index < values.length; index += 1) {
    const at = 4 * index;
    const colours = data[at] + data[at + 1] + data[at + 2];
    values[index] = averaged ? colours + data[at + 3] : colours;
    clear[index] = data[at + 3] < 255 ? 1 : 0;
  }
  return { width, height, maxval: 255 * (averaged ? 4 : 3), values, clear };
}
