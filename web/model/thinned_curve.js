// Which points of a curve are worth drawing. Pure.

/**
 * The positions of the points of {t, gap}, ascending in t, to draw for the times in a range that is some pixels
 * wide: the lowest in each pixel, and one on either side of the range to lead there.
 */
export function thinned({ t, gap }, { from, to }, pixels) {
  const kept = [];
  let pixel = null; // of the last one kept
  for (let k = 0; k < t.length; k += 1) {
    if (t[k] < from && t[k + 1] < from) continue;
    const own =
      t[k] < from || t[k] > to ? Math.sign(t[k] - from) * Infinity : pixelOf(t[k], from, to, pixels);
    const last = kept.length - 1;
    if (own !== pixel) kept.push(k);
    else if (gap[k] < gap[kept[last]]) kept[last] = k;
    pixel = own;
    if (t[k] > to) break;
  }
  return kept;
}

function pixelOf(t, from, to, pixels) {
  return to > from ? Math.floor(((t - from) / (to - from)) * pixels) : 0;
}
