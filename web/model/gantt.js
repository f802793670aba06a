// The geometry of the timeline's chart: a row per robot, time to the right. Pure. Pixels from the upper left corner. A
// layout is {left, width, top, height, rowHeight, scroll, rows, range}: where the rows are, how far they are scrolled,
// how many there are, and the range of time {from, to} that they show.

const SHORTEST = 0.05; // seconds: the shortest range
const STEPS = [1, 2, 5];
const SLACK = 1e-9; // of a step: rounding must not lose the last tick

/** The x of a time. */
export function xOf({ left, width, range }, t) {
  return left + ((t - range.from) / (range.to - range.from || 1)) * width;
}

/** The time at a pixel, possibly outside the range. */
export function timeAt({ left, width, range }, x) {
  return range.from + ((x - left) / Math.max(1, width)) * (range.to - range.from);
}

/** The top of a row. */
export function yOf({ top, rowHeight, scroll }, row) {
  return top + row * rowHeight - scroll;
}

/** The row at a pixel, or -1. */
export function rowAt({ top, height, rowHeight, scroll, rows }, y) {
  if (y < top || y >= top + height) return -1;
  const row = Math.floor((y - top + scroll) / rowHeight);
  return row < rows ? row : -1;
}

/** The rows that are at least partly visible: {first, end}. */
export function rowsSeen({ height, rowHeight, scroll, rows }) {
  return {
    first: Math.max(0, Math.floor(scroll / rowHeight)),
    end: Math.min(rows, Math.ceil((scroll + height) / rowHeight)),
  };
}

/** The nearest valid scroll position. */
export function clampScroll({ height, rowHeight, rows }, scroll) {
  return Math.max(0, Math.min(rows * rowHeight - height, scroll));
}

/** The scroll position, with the least change, at which a row is fully visible. */
export function scrollToRow(layout, row) {
  const { height, rowHeight, scroll } = layout;
  const least = (row + 1) * rowHeight - height;
  return clampScroll(layout, Math.max(least, Math.min(row * rowHeight, scroll)));
}

const FIRST_MOVE = (track) => track.actions.find(({ type }) => type !== "wait")?.t_start ?? Infinity;

/** The keys for sorting rows: a number per track, ascending; ties keep the listed order. */
const SORT_KEYS = {
  listed: () => 0,
  start: FIRST_MOVE,
  cost: (track) => -(track.cost ?? -Infinity),
  delay: (track) => -delayOf(track),
};

/** The cost above the lower bound, seconds; -Infinity if unknown. */
export function delayOf({ cost, lowerBound }) {
  return Number.isFinite(cost) && Number.isFinite(lowerBound) ? cost - lowerBound : -Infinity;
}

/** The robots' ids in the order of their rows. `by` is "listed", "start", "cost" or "delay". */
export function orderRows(robots, tracks, by) {
  const key = SORT_KEYS[by];
  const keyed = robots.map(({ id }) => ({ id, value: key(tracks.get(id)) }));
  keyed.sort((a, b) => (a.value === b.value ? 0 : a.value - b.value));
  return keyed.map(({ id }) => id);
}

/** Zooms by `factor` (above 1 shows less); the time `anchor` stays in place. */
export function zoomTime({ from, to }, duration, anchor, factor) {
  const length = Math.min(duration, Math.max(Math.min(SHORTEST, duration), (to - from) / factor));
  const share = to > from ? (anchor - from) / (to - from) : 0;
  return within(anchor - share * length, length, duration);
}

/** Moves the range by `shift` seconds, within the plan. */
export function panTime({ from, to }, duration, shift) {
  return within(from + shift, to - from, duration);
}

/** Moves the range so that it includes t; returns the same range if it does already. */
export function revealTime(range, duration, t) {
  if (t >= range.from && t <= range.to) return range;
  const length = range.to - range.from;
  return within(t < range.from ? t - length * 0.1 : t - length * 0.9, length, duration);
}

function within(from, length, duration) {
  const begin = Math.max(0, Math.min(from, duration - length));
  return { from: begin, to: begin + length };
}

/** Round times to mark in the range: {step, times}, at most `most` of them. */
export function ticks({ from, to }, most) {
  const least = (to - from) / Math.max(1, most);
  if (!(least > 0)) return { step: 1, times: [from] };
  const power = 10 ** Math.floor(Math.log10(least));
  const step = power * (STEPS.find((factor) => power * factor >= least) ?? 10);
  const times = [];
  const first = Math.max(0, Math.ceil(from / step - SLACK));
  for (let k = first; k * step <= to + SLACK * step; k += 1) times.push(k * step);
  return { step, times };
}

/**
 * The indices of the points of {t, gap}, ascending in t, to draw for a range of time with a width in pixels. They are
 * the lowest point in each pixel, and one point on either side of the range.
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
