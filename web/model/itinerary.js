// A robot's actions in words and figures, and the cause of each wait. Pure. Seconds, metres, radians.

import { firstOverlap, motionOf, radiusAt } from "./motion.js";
import { DOING, turnBetween } from "./timeline.js";

const WHOLE_TURN = 2 * Math.PI;

/** The time of moving, turning and waiting, seconds, and the distance, metres. */
export function totals(actions) {
  const sum = { moving: 0, turning: 0, waiting: 0, distance: 0 };
  for (const action of actions) {
    sum[DOING[action.type]] += action.t_end - action.t_start;
    if (action.type === "translate") sum.distance += lengthOf(action);
  }
  return sum;
}

/** An action in words: "drive 3.2 m", "reverse 0.8 m", "turn 90° left", "wait 1.4 s", "wait 2 s at goal 1". */
export function actionInWords(action) {
  if (action.type === "translate")
    return `${action.reverse ? "reverse" : "drive"} ${short(lengthOf(action))} m`;
  if (action.type === "wait") {
    const where = Number.isInteger(action.goal) ? ` at goal ${action.goal + 1}` : "";
    return `wait ${short(action.t_end - action.t_start)} s${where}`;
  }
  const turn = turnBetween(action.from.theta, action.to.theta);
  return `turn ${short((Math.abs(turn) / WHOLE_TURN) * 360)}° ${turn < 0 ? "right" : "left"}`;
}

function lengthOf({ from, to }) {
  return Math.hypot(to.x - from.x, to.y - from.y);
}

/** With the significant digits: 132, 13.2, 0.02. */
function short(value) {
  if (value >= 99.95) return value.toFixed(0);
  if (value >= 0.95) return String(Number(value.toFixed(1)));
  return String(Number(value.toPrecision(2)));
}

/**
 * The robot that causes the wait actions[index] of the robot `id`: {robot, t}, or null. The following actions are
 * shifted to the start of the wait. The cause is the first other robot hit until the end of the plan. `fleet` maps ids
 * to motions. `margin` is the distance that counts as a hit, 0 for contact.
 */
export function causeOfWait(id, actions, index, fleet, margin = 0) {
  const shifted = motionWithout(actions, index, fleet.get(id));
  const from = actions[index].t_start;
  const until = actions[actions.length - 1].t_end;
  let found = null;
  for (const [other, motion] of fleet) {
    if (other === id) continue;
    const t = firstOverlap(shifted, motion, from, found?.t ?? until, margin);
    if (t !== null && (found === null || t < found.t)) found = { robot: other, t };
  }
  return found;
}

/** The motion of the robot from the start of the wait if it does not wait. */
function motionWithout(actions, index, motion) {
  const { t_start, t_end, to } = actions[index];
  const radius = radiusAt(motion, t_start);
  const earlier = t_end - t_start;
  const rest = actions
    .slice(index + 1)
    .map((action) => ({ ...action, t_start: action.t_start - earlier, t_end: action.t_end - earlier }));
  const radii = motion.radii.filter(({ t }) => t > t_start).map((each) => ({ ...each, t: each.t - earlier }));
  return motionOf({ start: to, radius }, rest, radii);
}
