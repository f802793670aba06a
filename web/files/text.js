// Text files: their lines, and exact sums of the decimal numbers in them.

/** The lines of a text, with any line endings. */
export const linesOf = (text) => text.split(/\r\n|\r|\n/);

/** `base` + `count` × `step`, where `count` is a whole number. Finite numbers only. */
export function plusTimes(base, count, step) {
  const digits = Math.max(decimalsOf(base), decimalsOf(step));
  const sum = scaled(base, digits) + BigInt(count) * scaled(step, digits);
  return Number(`${sum}e-${digits}`);
}

/** Digits after the point in the shortest decimal form of the number. */
function decimalsOf(value) {
  const [mantissa, exponent = "0"] = String(value).split("e");
  const written = mantissa.split(".")[1]?.length ?? 0;
  return Math.max(0, written - Number(exponent));
}

/** The number times ten to the power of `digits`, which are at least its own. */
function scaled(value, digits) {
  const [mantissa, exponent = "0"] = String(value).split("e");
  const [whole, part = ""] = mantissa.split(".");
  return BigInt(whole + part) * 10n ** BigInt(digits + Number(exponent) - part.length);
}
