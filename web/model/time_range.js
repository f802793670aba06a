// The stretch of time {from, to} that a timeline shows, between 0 and the duration. Pure; seconds.

const SHORTEST = 0.05; // seconds that fill the timeline when zoomed in all the way
const STEPS = [1, 2, 5];
const SLACK = 1e-9; // of a step: rounding must not lose the last tick

/** Zooms by `factor` (above 1 shows less); the moment `anchor` stays where it is. */
export function zoomTime({ from, to }, duration, anchor, factor) {
  const length = Math.min(duration, Math.max(Math.min(SHORTEST, duration), (to - from) / factor));
  const share = to > from ? (anchor - from) / (to - from) : 0;
  return within(anchor - share * length, length, duration);
}

/** Shows what is `shift` seconds later, as far as there is something. */
export function panTime({ from, to }, duration, shift) {
  return within(from + shift, to - from, duration);
}

/** Moves the range no further than it takes for t to be seen; the same range if it is. */
export function revealTime(range, duration, t) {
  if (t >= range.from && t <= range.to) return range;
  const length = range.to - range.from;
  return within(t < range.from ? t - length * 0.1 : t - length * 0.9, length, duration);
}

function within(from, length, duration) {
  const begin = Math.max(0, Math.min(from, duration - length));
  return { from: begin, to: begin + length };
}

/** Round times to mark in the range: {step, times}, at most `most` and some if there is room for them. */
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
