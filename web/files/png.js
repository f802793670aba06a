// What a PNG's chunks tell that its decoded pixels no longer do, and the gray that map_server sees in them.

const SIGNATURE = [137, 80, 78, 71, 13, 10, 26, 10];
const WITH_ALPHA = new Set([4, 6]); // colour types: gray and colour, each with alpha

export function isPng(bytes) {
  return SIGNATURE.every((byte, index) => bytes[index] === byte);
}

/** {width, height} in pixels, as the header says. */
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
 * map_server counts the alpha channel, where the image has one, as a fourth colour; so do we.
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
