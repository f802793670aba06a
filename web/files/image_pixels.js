// The gray pixels of a map's image. The browser decodes PNGs; graymaps are read here.

import { FileError } from "./file_text.js";
import { readPgm } from "./pgm.js";
import { grayOfRgba, hasAlpha, isPng, sizeOf } from "./png.js";

const MOST_PIXELS = 2 ** 26; // of a PNG: what browsers decode and hold without trouble

/** The pixels for classifyPixels, and `warnings` about them. `mode`: see readRosYaml. Rejects with FileError. */
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

/** 8-bit RGBA of a PNG, as the file has them: {width, height, data}. */
async function decode(bytes) {
  const { width, height } = sizeOf(bytes);
  if (width * height > MOST_PIXELS)
    throw new FileError(`Its ${width} x ${height} pixels are too many to decode; convert it to PGM.`);
  let bitmap;
  try {
    const asStored = { colorSpaceConversion: "none", premultiplyAlpha: "none" };
    bitmap = await createImageBitmap(new Blob([bytes], { type: "image/png" }), asStored);
  } catch {
    throw new FileError("It is damaged: the browser cannot decode it. Save it again, or as PGM.");
  }
  const canvas = document.createElement("canvas");
  canvas.width = width;
  canvas.height = height;
  const context = canvas.getContext("2d", { willReadFrequently: true });
  context.drawImage(bitmap, 0, 0);
  bitmap.close();
  return context.getImageData(0, 0, width, height);
}
