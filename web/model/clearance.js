// The exact clearance of robots over time. Between two times at which any motion changes, all robots accelerate evenly.
// Then the least distance of two robots is exact, see relative_motion.js. Pure. Gaps in metres between the disks,
// negative where they overlap.

import { Follower, knotTimes, lastKnot, relativeMotion, sortedOnce } from "./motion.js";

const SAMPLES = 600; // least number of windows, so that the curve is smooth
const CONTACT = 1e-6; // metres that disks in contact may overlap

/**
 * The smallest gap of any two motions, window by window: {t, gap, first, second, least} of equally long arrays. In
 * window k, motions first[k] and second[k] are nearest, `gap[k]` apart, at t[k]. `least` is the k of the smallest gap
 * of all. Null with fewer than two motions.
 *
 * Without `resting`, two motions that rest side by side do not count while they rest, unless they overlap. If no others
 * are left in a window, its gap is Infinity.
 */
export function clearanceOf(motions, samples = SAMPLES, resting = true) {
  if (motions.length < 2) return null;
  const end = lastKnot(motions);
  const even = Array.from({ length: samples }, (_, k) => (end * k) / samples);
  const times = sortedOnce([...knotTimes(motions, end), ...even]);
  // A robot whose radius changes only at the end has this radius in none of the windows before.
  const changesLast = motions.some(({ radii }) => radii.some(({ t }) => t >= end));
  const windows = Math.max(1, changesLast ? times.length : times.length - 1);
  const curve = {
    t: new Float64Array(windows),
    gap: new Float64Array(windows),
    first: new Int32Array(windows),
    second: new Int32Array(windows),
    least: 0,
  };
  const sweep = new ClearanceSweep(motions, resting);
  for (let k = 0; k < windows; k += 1) {
    const nearest = sweep.nearestIn(times[k], times[k + 1] ?? times[k]);
    curve.t[k] = nearest.t;
    curve.gap[k] = nearest.gap;
    curve.first[k] = Math.min(nearest.first, nearest.second);
    curve.second[k] = Math.max(nearest.first, nearest.second);
    if (nearest.gap < curve.gap[curve.least]) curve.least = k;
  }
  return curve;
}

/** The runs of windows in which a curve's gap is below a threshold: [{from, to, least}], the windows' indices. */
export function spellsBelow({ gap }, threshold) {
  const spells = [];
  for (let k = 0; k < gap.length; k += 1) {
    if (!(gap[k] < threshold)) continue;
    const spell = spells.at(-1);
    if (spell?.to !== k - 1) {
      spells.push({ from: k, to: k, least: k });
      continue;
    }
    spell.to = k;
    if (gap[k] < gap[spell.least]) spell.least = k;
  }
  return spells;
}

/**
 * Finds the nearest two of at least two motions, now or in a window of time. It sweeps the boxes of all motions from
 * left to right, whose order hardly changes between calls. It compares pairs whose boxes are nearer than the least gap
 * found so far.
 */
export class ClearanceSweep {
  #followers;
  #left;
  #right;
  #bottom;
  #top;
  #order;
  #nearest = { t: 0, gap: Infinity, first: 0, second: 1 };
  #resting;

  /** `resting`: whether two that both rest count, see clearanceOf. */
  constructor(motions, resting = true) {
    this.#resting = resting;
    this.#followers = motions.map((motion) => new Follower(motion));
    [this.#left, this.#right, this.#bottom, this.#top] = [0, 0, 0, 0].map(
      () => new Float64Array(motions.length),
    );
    this.#order = Int32Array.from(motions, (_, at) => at);
  }

  /** The two nearest at a moment: {t, gap, first, second}, with the indices of the two motions. */
  nearestAt(t) {
    return this.nearestIn(t, t);
  }

  /** The two nearest in a window inside which no motion changes, and when. */
  nearestIn(t0, t1) {
    this.#place(t0, t1);
    sortBy(this.#order, this.#left);
    const { first, second } = this.#nearest;
    this.#nearest = { t: t0, gap: Infinity, first, second };
    this.#compare(first, second, t0, t1); // the previous pair is still near, which rules out most others
    const [left, right, bottom, top, order] = [this.#left, this.#right, this.#bottom, this.#top, this.#order];
    for (let i = 0; i < order.length; i += 1) {
      const a = order[i];
      for (let j = i + 1; j < order.length; j += 1) {
        const b = order[j];
        const { gap } = this.#nearest;
        if (left[b] - right[a] > gap) break;
        if (bottom[b] - top[a] > gap || bottom[a] - top[b] > gap) continue;
        this.#compare(a, b, t0, t1);
      }
    }
    return this.#nearest;
  }

  #place(t0, t1) {
    for (let at = 0; at < this.#followers.length; at += 1) {
      const follower = this.#followers[at];
      follower.look(t0, t1);
      const { radius } = follower;
      this.#left[at] = Math.min(follower.x, follower.endX) - radius;
      this.#right[at] = Math.max(follower.x, follower.endX) + radius;
      this.#bottom[at] = Math.min(follower.y, follower.endY) - radius;
      this.#top[at] = Math.max(follower.y, follower.endY) + radius;
    }
  }

  #compare(first, second, t0, t1) {
    const a = this.#followers[first];
    const b = this.#followers[second];
    const motion = relativeMotion(a, b);
    const radii = a.radius + b.radius;
    if (!motion.mayComeWithin(this.#nearest.gap + radii + CONTACT)) return;
    const share = motion.nearestShare();
    const gap = motion.distance(share) - radii;
    if (!this.#resting && a.rests && b.rests && gap >= -CONTACT) return;
    if (gap < this.#nearest.gap) this.#nearest = { t: t0 + (t1 - t0) * share, gap, first, second };
  }
}

/** Insertion sort, which is fast on nearly sorted input. */
function sortBy(order, keys) {
  for (let i = 1; i < order.length; i += 1) {
    const moved = order[i];
    const key = keys[moved];
    let j = i - 1;
    for (; j >= 0 && keys[order[j]] > key; j -= 1) order[j + 1] = order[j];
    order[j + 1] = moved;
  }
}
