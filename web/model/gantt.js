// The geometry of the timeline's chart: a row a robot, time to the right. Pure. Pixels from the upper left
// corner; a layout is {left, width, top, height, rowHeight, scroll, rows, range}: where the rows are seen, how
// far they are scrolled, how many there are, and the stretch of time {from, to} they show.

/** Where a moment is from left to right. */
export function xOf({ left, width, range }, t) {
  return left + ((t - range.from) / (range.to - range.from || 1)) * width;
}

/** The moment at a pixel, which may lie outside of what is shown. */
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

/** The rows that are seen at least in part: {first, end}. */
export function rowsSeen({ height, rowHeight, scroll, rows }) {
  return {
    first: Math.max(0, Math.floor(scroll / rowHeight)),
    end: Math.min(rows, Math.ceil((scroll + height) / rowHeight)),
  };
}

/** The nearest sensible value to scroll to. */
export function clampScroll({ height, rowHeight, rows }, scroll) {
  return Math.max(0, Math.min(rows * rowHeight - height, scroll));
}

/** How far to scroll, no more than it takes, so that a row is wholly seen. */
export function scrollToRow(layout, row) {
  const { height, rowHeight, scroll } = layout;
  const least = (row + 1) * rowHeight - height;
  return clampScroll(layout, Math.max(least, Math.min(row * rowHeight, scroll)));
}

const FIRST_MOVE = (track) => track.actions.find(({ type }) => type !== "wait")?.t_start ?? Infinity;

/**
 * What rows can be sorted by: a number for each robot's track, smallest first; as listed where that is equal.
 */
const SORT_KEYS = {
  listed: () => 0,
  start: FIRST_MOVE,
  cost: (track) => -(track.cost ?? -Infinity),
  delay: (track) => -delayOf(track),
};

/** How much later than alone on the map a robot arrives, seconds; -Infinity where that is not known. */
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
