// The centre of a robot over time, as a polyline: knots (t, x, y) with constant acceleration in between, straight along
// the line. Two knots at one time are a jump, which occurs only in faulty plans. Pure. Times in seconds, lengths in metres.

import { coveredShare, phasesOf } from "./profile.js";
import { RelativeMotion } from "./relative_motion.js";
import { poseAtShare } from "./timeline.js";

const CONTACT = 5e-7; // metres: disks that overlap by no more are in contact

/**
 * The motion of a robot {start, radius} that executes `actions`: {radius, knots, ramps, radii}.
 *
 * - `knots`: the knots one after the other, as t, x, y, t, x, y, …
 * - `ramps`: for each knot, how the speed changes from the knot before, see coveredShare
 * - `radii`: the radii that the robot has later, see readTracks
 */
export function motionOf(robot, actions, radii = []) {
  const knots = [];
  const ramps = [];
  for (const action of actions) {
    for (const { t_start, t_end, from, to, ramp } of phasesOf(action)) {
      addKnot(knots, ramps, t_start, poseAtShare(action, from), 0);
      addKnot(knots, ramps, t_end, poseAtShare(action, to), knots[knots.length - 3] === t_start ? ramp : 0);
    }
  }
  if (knots.length === 0) addKnot(knots, ramps, 0, robot.start, 0);
  return { radius: robot.radius, knots: Float64Array.from(knots), ramps: Float64Array.from(ramps), radii };
}

/** Appends a knot. Omits redundant knots, and knots of a faulty plan that go back in time or are not finite. */
function addKnot(knots, ramps, t, { x, y }, ramp) {
  const end = knots.length;
  if (!Number.isFinite(t + x + y) || (end > 0 && t < knots[end - 3])) return;
  const rests = (at) => at >= 0 && knots[at + 1] === x && knots[at + 2] === y;
  if (rests(end - 3)) {
    if (t === knots[end - 3]) return;
    if (rests(end - 6)) {
      knots.length -= 3;
      ramps.length -= 1;
    }
  }
  knots.push(t, x, y);
  ramps.push(ramp);
}

/** The radius at t of something with a `radius` at first and later `radii`, see readTracks. */
export function radiusAt({ radius, radii }, t) {
  return radii.length === 0 ? radius : (radii.findLast((each) => each.t <= t)?.radius ?? radius);
}

/** The last time at which one of the motions changes; 0 where nothing moves. */
export function lastKnot(motions) {
  return motions.reduce(
    (last, { knots, radii }) => Math.max(last, knots[knots.length - 3], ...radii.map(({ t }) => t)),
    0,
  );
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
 * Follows a motion through time. `x`, `y` and `endX`, `endY` are its positions at both ends of a span. `bendX`, `bendY`
 * tell how its speed changes (see RelativeMotion). `radius` holds for the whole span. `rests`: whether it does not move
 * in it.
 */
export class Follower {
  x = 0;
  y = 0;
  endX = 0;
  endY = 0;
  bendX = 0;
  bendY = 0;
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
    this.bendX = this.bendY = 0;
    this.rests = true;
    if (at + 3 >= knots.length || t0 < knots[at]) return;
    const [wayX, wayY] = [knots[at + 4] - x, knots[at + 5] - y];
    this.rests = wayX === 0 && wayY === 0;
    const ramp = this.#motion.ramps[at / 3 + 1];
    const lasts = knots[at + 3] - knots[at];
    const begin = (t0 - knots[at]) / lasts;
    const end = (t1 - knots[at]) / lasts;
    const [covered, until] = [coveredShare(begin, ramp), coveredShare(end, ramp)];
    this.x = x + wayX * covered;
    this.y = y + wayY * covered;
    this.endX = end === 1 ? knots[at + 4] : x + wayX * until;
    this.endY = end === 1 ? knots[at + 5] : y + wayY * until;
    const bend = ramp * (end - begin) ** 2;
    this.bendX = wayX * bend;
    this.bendY = wayY * bend;
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

/** The motion of one follower relative to another, in the span of both. */
export function relativeMotion(a, b) {
  const [x, y] = [b.x - a.x, b.y - a.y];
  return new RelativeMotion(
    x,
    y,
    b.endX - a.endX - x,
    b.endY - a.endY - y,
    b.bendX - a.bendX,
    b.bendY - a.bendY,
  );
}

/** The first time in [from, until] at which two motions are closer than `margin`, or null. */
export function firstOverlap(motion, other, from, until, margin = 0) {
  const [a, b] = [new Follower(motion), new Follower(other)];
  let t0 = from;
  do {
    const t1 = Math.min(until, a.nextKnot(t0), b.nextKnot(t0));
    a.look(t0, t1);
    b.look(t0, t1);
    const share = relativeMotion(a, b).firstShareWithin(a.radius + b.radius + margin - CONTACT);
    if (share !== null) return t0 + (t1 - t0) * share;
    t0 = t1;
  } while (t0 < until);
  return null;
}
