// The centre of a robot over time, as a polyline: knots (t, x, y) with constant velocity in between. Two
// knots at one time are a jump, which occurs only in faulty plans. Pure. Times in seconds, lengths in metres.

import { knotsOf } from "./profile.js";
import { poseInAction } from "./timeline.js";

const CONTACT = 5e-7; // metres: disks that overlap by no more are in contact

/**
 * The motion of a robot {start, radius} that executes `actions`: {radius, knots, radii}, the knots one after the
 * other as t, x, y, t, x, y, …; `radii`, see readTracks, are those that it has later.
 */
export function motionOf(robot, actions, radii = []) {
  const knots = [];
  for (const action of actions) {
    if (action.changes) {
      for (const t of knotsOf(action)) addKnot(knots, t, poseInAction(action, t));
    } else {
      addKnot(knots, action.t_start, action.from);
      addKnot(knots, action.t_end, action.to);
    }
  }
  if (knots.length === 0) knots.push(0, robot.start.x, robot.start.y);
  return { radius: robot.radius, knots: Float64Array.from(knots), radii };
}

/**
 * Appends a knot. Omits redundant ones, and those of a faulty plan that go back in time or are not finite.
 */
function addKnot(knots, t, { x, y }) {
  const end = knots.length;
  if (!Number.isFinite(t + x + y) || (end > 0 && t < knots[end - 3])) return;
  const rests = (at) => at >= 0 && knots[at + 1] === x && knots[at + 2] === y;
  if (rests(end - 3)) {
    if (t === knots[end - 3]) return;
    if (rests(end - 6)) knots.length -= 3;
  }
  knots.push(t, x, y);
}

/** The radius at t of something with a `radius` at first and later `radii`, see readTracks. */
export function radiusAt({ radius, radii }, t) {
  return radii.length === 0 ? radius : (radii.findLast((each) => each.t <= t)?.radius ?? radius);
}

/** The last time at which one of the motions changes; 0 where nothing moves. */
export function lastKnot(motions) {
  return motions.reduce((last, { knots }) => Math.max(last, knots[knots.length - 3]), 0);
}

/** The times in [0, end] at which one of the motions changes, ascending, each once, with 0 and `end`. */
export function knotTimes(motions, end) {
  const times = [0, end];
  for (const { knots, radii } of motions) {
    for (let at = 0; at < knots.length; at += 3) {
      if (knots[at] > 0 && knots[at] < end) times.push(knots[at]);
    }
    for (const { t } of radii) if (t > 0 && t < end) times.push(t);
  }
  return sortedOnce(times);
}

/** The numbers ascending, each once. */
export function sortedOnce(numbers) {
  const sorted = Float64Array.from(numbers).sort();
  let length = Math.min(1, sorted.length);
  for (let at = 1; at < sorted.length; at += 1) {
    if (sorted[at] !== sorted[length - 1]) sorted[length++] = sorted[at];
  }
  return sorted.subarray(0, length);
}

/**
 * Follows a motion through time. `x`, `y` and `endX`, `endY` are its positions at both ends of a span, `radius` is that
 * of all the span, and `rests` whether it does not move in it.
 */
export class Follower {
  x = 0;
  y = 0;
  endX = 0;
  endY = 0;
  rests = true;
  radius;
  #motion;
  #knots;
  #at = 0; // the index of the knot before the span

  constructor(motion) {
    this.#motion = motion;
    this.#knots = motion.knots;
    this.radius = motion.radius;
  }

  /** Moves to the span from t0 to t1, which must not contain a knot; fast if it is near the previous span. */
  look(t0, t1) {
    this.#seek(t0);
    this.radius = radiusAt(this.#motion, t0);
    const knots = this.#knots;
    const at = this.#at;
    const x = knots[at + 1];
    const y = knots[at + 2];
    this.x = this.endX = x;
    this.y = this.endY = y;
    this.rests = true;
    if (at + 3 >= knots.length || t0 < knots[at]) return;
    this.rests = knots[at + 4] === x && knots[at + 5] === y;
    const lasts = knots[at + 3] - knots[at];
    const begin = (t0 - knots[at]) / lasts;
    const end = (t1 - knots[at]) / lasts;
    this.x = x + (knots[at + 4] - x) * begin;
    this.y = y + (knots[at + 5] - y) * begin;
    this.endX = end === 1 ? knots[at + 4] : x + (knots[at + 4] - x) * end;
    this.endY = end === 1 ? knots[at + 5] : y + (knots[at + 5] - y) * end;
  }

  /** The time of the next knot, or of the next change of the radius, after t; Infinity if there is none. */
  nextKnot(t) {
    this.#seek(t);
    const at = this.#knots[this.#at] > t ? this.#at : this.#at + 3;
    const change = this.#motion.radii.find((each) => each.t > t);
    return Math.min(this.#knots[at] ?? Infinity, change?.t ?? Infinity);
  }

  /** Moves to the last knot at or before t, or to the first one. */
  #seek(t) {
    const knots = this.#knots;
    while (this.#at > 0 && knots[this.#at] > t) this.#at -= 3;
    while (this.#at + 3 < knots.length && knots[this.#at + 3] <= t) this.#at += 3;
  }
}

/** The first time in [from, until] at which two motions are closer than `margin`, or null. */
export function firstOverlap(motion, other, from, until, margin = 0) {
  const [a, b] = [new Follower(motion), new Follower(other)];
  let t0 = from;
  do {
    const t1 = Math.min(until, a.nextKnot(t0), b.nextKnot(t0));
    a.look(t0, t1);
    b.look(t0, t1);
    const [x, y] = [b.x - a.x, b.y - a.y];
    const reach = a.radius + b.radius + margin - CONTACT;
    const share = shareUntil(reach, x, y, b.endX - a.endX - x, b.endY - a.endY - y);
    if (share !== null) return t0 + (t1 - t0) * share;
    t0 = t1;
  } while (t0 < until);
  return null;
}

/**
 * The fraction in [0, 1] at which a point that moves from (x, y) by (wayX, wayY) comes within reach of the
 * origin, or null.
 */
function shareUntil(reach, x, y, wayX, wayY) {
  if (reach <= 0) return null;
  const beyond = x * x + y * y - reach * reach;
  if (beyond < 0) return 0;
  const squared = wayX * wayX + wayY * wayY;
  const nearing = -(x * wayX + y * wayY);
  const under = nearing * nearing - squared * beyond;
  if (nearing <= 0 || under <= 0) return null;
  const share = beyond / (nearing + Math.sqrt(under)); // the first root, without cancellation
  return share < 1 ? share : null;
}
