// Lengths of a scale bar, and distances of a ruler in words. Pure. Metres.

const STEPS = [5, 2, 1];

/** The longest round length, 1, 2 or 5 times a power of ten, that takes at most so many pixels: {length, pixels}. */
export function scaleBar(pixelsPerMetre, most) {
  const longest = most / pixelsPerMetre;
  const power = 10 ** Math.floor(Math.log10(longest));
  const step = STEPS.find((factor) => factor * power <= longest * (1 + 1e-9)) ?? 1;
  return { length: step * power, pixels: step * power * pixelsPerMetre };
}

/** A round length in words: "5 mm", "20 cm", "50 m", "2 km". */
export function lengthInWords(length) {
  const rounded = (value) => String(Number(value.toPrecision(3)));
  if (length < 0.01) return `${rounded(length * 1000)} mm`;
  if (length < 1) return `${rounded(length * 100)} cm`;
  return length < 1000 ? `${rounded(length)} m` : `${rounded(length / 1000)} km`;
}

/** The way from one point to another: {distance, heading (degrees, [0, 360)), across, up}. */
export function wayBetween(from, to) {
  const [across, up] = [to.x - from.x, to.y - from.y];
  const turn = (Math.atan2(up, across) * 180) / Math.PI;
  return { distance: Math.hypot(across, up), heading: (turn + 360) % 360, across, up };
}
