// When two moving disks first overlap, exactly. Pure. Times in seconds, lengths in metres.

import { Follower } from "./motion.js";

const CONTACT = 1e-9; // metres that disks may overlap in contact, which rounding makes of none

/** The first time in [from, until] when two motions are nearer to each other than `margin`, or null. */
export function firstOverlap(motion, other, from, until, margin = 0) {
  const reach = motion.radius + other.radius + margin - CONTACT;
  const [a, b] = [new Follower(motion), new Follower(other)];
  let t0 = from;
  do {
    const t1 = Math.min(until, a.nextKnot(t0), b.nextKnot(t0));
    a.look(t0, t1);
    b.look(t0, t1);
    const [x, y] = [b.x - a.x, b.y - a.y];
    const share = shareUntil(reach, x, y, b.endX - a.endX - x, b.endY - a.endY - y);
    if (share !== null) return t0 + (t1 - t0) * share;
    t0 = t1;
  } while (t0 < until);
  return null;
}

/**
 * How much of its way, in [0, 1], a point that moves from (x, y) by (wayX, wayY) goes until it is in reach, or
 * null.
 */
function shareUntil(reach, x, y, wayX, wayY) {
  if (reach <= 0) return null;
  const beyond = x * x + y * y - reach * reach;
  if (beyond < 0) return 0;
  const squared = wayX * wayX + wayY * wayY;
  const nearing = -(x * wayX + y * wayY);
  const under = nearing * nearing - squared * beyond;
  if (nearing <= 0 || under <= 0) return null;
  const share = beyond / (nearing + Math.sqrt(under)); // of the two roots the first, without cancellation
  return share < 1 ? share : null;
}
