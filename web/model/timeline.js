// Where a robot is at time t, in continuous time. Pure: no DOM, no clock. Times in seconds from the start of
// the plan, poses {x, y, theta} in metres and radians.

import { shareAt } from "./profile.js";

const FULL_TURN = 2 * Math.PI;

/** The angle in (-pi, pi]. */
export function normalizeAngle(angle) {
  if (angle > -Math.PI && angle <= Math.PI) return angle;
  const rest = angle - FULL_TURN * Math.round(angle / FULL_TURN);
  return rest > -Math.PI ? rest : rest + FULL_TURN;
}

/** The signed turn that leads from one heading to another: the shorter way, exactly pi counter-clockwise. */
export function turnBetween(from, to) {
  return normalizeAngle(normalizeAngle(to) - normalizeAngle(from));
}

/** The index of the action at t; where two actions meet, the later one. `actions` is not empty. */
export function actionIndexAt(actions, t) {
  let low = 0;
  let high = actions.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (actions[middle].t_start <= t) low = middle;
    else high = middle - 1;
  }
  return low;
}

/** The pose within one action; t is clamped to the action. */
export function poseInAction(action, t) {
  return poseAtShare(action, shareAt(action, t));
}

/** The pose of an action after a share of its way. */
export function poseAtShare({ from, to }, share) {
  if (share === 1) return { x: to.x, y: to.y, theta: to.theta };
  return {
    x: from.x + (to.x - from.x) * share,
    y: from.y + (to.y - from.y) * share,
    theta: normalizeAngle(from.theta + turnBetween(from.theta, to.theta) * share),
  };
}

/** The pose at t of a robot that executes `actions` from `start`, and rests before and after them. */
export function poseAt(actions, start, t) {
  if (actions.length === 0) return start;
  return poseInAction(actions[actionIndexAt(actions, t)], t);
}

/** What a robot does during an action, by its type. */
export const DOING = { rotate: "turning", translate: "moving", wait: "waiting" };

/** The state of the robot at t: "turning", "moving", "waiting" or, after its last action, "arrived". */
export function doingAt(actions, t) {
  if (actions.length === 0 || t >= actions[actions.length - 1].t_end) return "arrived";
  return DOING[actions[actionIndexAt(actions, t)].type] ?? "waiting";
}

/** The corners of the path: the start and the end of every translation. */
export function pathOf(actions) {
  const corners = [];
  for (const { type, from, to } of actions) {
    if (type !== "translate") continue;
    if (corners.length === 0) corners.push({ x: from.x, y: from.y });
    corners.push({ x: to.x, y: to.y });
  }
  return corners;
}

/** The corners of the remaining path at t, starting at the robot. */
export function remainingPath(actions, start, t) {
  const { x, y } = poseAt(actions, start, t);
  const corners = [{ x, y }];
  for (const action of actions) {
    if (action.type === "translate" && action.t_end > t) corners.push({ x: action.to.x, y: action.to.y });
  }
  return corners;
}
