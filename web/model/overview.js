// What the robots of a plan do over time, all together. Pure. Seconds.

import { DOING } from "./timeline.js";

/**
 * How many robots are moving, turning and waiting on average in each of so many equal parts of the plan: {moving,
 * turning, waiting}, an array each.
 */
export function overviewOf(tracks, duration, parts) {
  const sums = {
    moving: new Float64Array(parts),
    turning: new Float64Array(parts),
    waiting: new Float64Array(parts),
  };
  if (!(duration > 0)) return sums;
  const part = duration / parts;
  for (const { actions } of tracks) {
    for (const { type, t_start, t_end } of actions) {
      const sum = sums[DOING[type]];
      const last = Math.min(parts - 1, Math.floor(t_end / part));
      for (let at = Math.floor(t_start / part); at <= last; at += 1) {
        sum[at] += Math.max(0, Math.min(t_end, (at + 1) * part) - Math.max(t_start, at * part)) / part;
      }
    }
  }
  return sums;
}
