// A robot's actions in words and figures. Pure. Seconds, metres, radians.

import { turnBetween } from "./timeline.js";

const WHOLE_TURN = 2 * Math.PI;
const SHARES = { translate: "moving", rotate: "turning", wait: "waiting" };

/** How long a robot moves, turns and waits, seconds, and how far it goes, metres. */
export function totals(actions) {
  const sum = { moving: 0, turning: 0, waiting: 0, distance: 0 };
  for (const action of actions) {
    sum[SHARES[action.type]] += action.t_end - action.t_start;
    if (action.type === "translate") sum.distance += lengthOf(action);
  }
  return sum;
}

/** What an action does: "drive 3.2 m", "turn 90° left", "wait 1.4 s". */
export function actionInWords(action) {
  if (action.type === "translate") return `drive ${short(lengthOf(action))} m`;
  if (action.type === "wait") return `wait ${short(action.t_end - action.t_start)} s`;
  const turn = turnBetween(action.from.theta, action.to.theta);
  return `turn ${short((Math.abs(turn) / WHOLE_TURN) * 360)}° ${turn < 0 ? "right" : "left"}`;
}

function lengthOf({ from, to }) {
  return Math.hypot(to.x - from.x, to.y - from.y);
}

/** With as many digits as tell something: 132, 13.2, 0.02. */
function short(value) {
  if (value >= 99.95) return value.toFixed(0);
  if (value >= 0.95) return String(Number(value.toFixed(1)));
  return String(Number(value.toPrecision(2)));
}
