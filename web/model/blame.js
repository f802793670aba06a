// What a robot waits for: whom it would hit if it did not wait. Pure. Times in seconds, lengths in metres.

import { firstOverlap } from "./encounter.js";
import { motionOf } from "./motion.js";

/**
 * The robot that actions[index], a wait of the robot `id`, is for: all that follows is brought forward to the
 * start of the wait, and followed to the end of the plan. {robot, t} of the first other robot hit and when, or
 * null if none is. `fleet` is the ids and motions of all robots; `margin` is a distance that counts as hit, 0
 * for contact.
 */
export function waitedFor(id, actions, index, fleet, margin = 0) {
  const hasty = motionWithout(actions, index, fleet.get(id).radius);
  const from = actions[index].t_start;
  const until = actions[actions.length - 1].t_end;
  let found = null;
  for (const [other, motion] of fleet) {
    if (other === id) continue;
    const t = firstOverlap(hasty, motion, from, found?.t ?? until, margin);
    if (t !== null && (found === null || t < found.t)) found = { robot: other, t };
  }
  return found;
}

/** How the robot moves from the start of the wait on if it does not wait. */
function motionWithout(actions, index, radius) {
  const { t_start, t_end, to } = actions[index];
  const earlier = t_end - t_start;
  const rest = actions
    .slice(index + 1)
    .map((action) => ({ ...action, t_start: action.t_start - earlier, t_end: action.t_end - earlier }));
  return motionOf({ start: to, radius }, rest);
}
