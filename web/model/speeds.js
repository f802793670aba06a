// How fast a robot drives and turns over time. Pure. Seconds, metres, radians.

import { speedAt } from "./profile.js";
import { actionIndexAt, turnBetween } from "./timeline.js";

/** @import {Action} from "./types.js" */

/**
 * The signed way of an action, metres or radians: negative where the robot goes backwards or turns clockwise.
 * @param {Action} action
 */
function wayOf({ type, from, to, reverse }) {
  if (type === "rotate") return turnBetween(from.theta, to.theta);
  if (type !== "translate") return 0;
  return Math.hypot(to.x - from.x, to.y - from.y) * (reverse ? -1 : 1);
}

function signedSpeed(action, t) {
  const way = wayOf(action);
  const speed = speedAt(action, t, Math.abs(way));
  return way < 0 && speed !== 0 ? -speed : speed;
}

/**
 * The speeds of a robot at t: `drive` in m/s, negative backwards, and `turn` in rad/s, negative clockwise. Outside its
 * actions, the robot is at rest. Where two actions meet, the speeds of the later action.
 * @param {Action[]} actions
 */
export function speedsAt(actions, t) {
  const action = actions[actions.length === 0 ? 0 : actionIndexAt(actions, t)];
  const speed = action && t >= action.t_start && t < action.t_end ? signedSpeed(action, t) : 0;
  return { drive: action?.type === "translate" ? speed : 0, turn: action?.type === "rotate" ? speed : 0 };
}

/**
 * These speeds from 0 to the end of the last action, each as the corners [t, speed] of a line. Two corners at the same
 * time are a jump. The line is exact, because speeds change at constant rates.
 * @param {Action[]} actions
 * @returns {{drive: [number, number][], turn: [number, number][]}}
 */
export function speedLines(actions) {
  return { drive: lineOf(actions, "translate"), turn: lineOf(actions, "rotate") };
}

function lineOf(actions, type) {
  /** @type {[number, number][]} */
  const line = [[0, 0]];
  for (const action of actions) {
    if (action.type !== type) continue;
    const { t_start, t_end, changes } = action;
    add(line, t_start, 0);
    const { rise, fall } = changes ?? { rise: 0, fall: 0 };
    for (const t of [t_start, t_start + rise, t_end - fall, t_end]) add(line, t, signedSpeed(action, t));
    add(line, t_end, 0);
  }
  add(line, actions.at(-1)?.t_end ?? 0, 0);
  return line;
}

/** Appends a corner. Removes earlier corners that the line does not need. */
function add(line, t, speed) {
  const [at, before] = line.at(-1);
  if (t === at && speed === before) return;
  const [earlier, first] = line.at(-2) ?? [];
  const isStraight = (t === at && t === earlier) || (speed === before && speed === first);
  if (isStraight) {
    line.pop();
    add(line, t, speed);
  } else {
    line.push([t, speed]);
  }
}

/** The greatest speed in each direction: [ahead or counter-clockwise, backwards or clockwise], neither negative. */
export function greatest(line) {
  const speeds = line.map(([, speed]) => speed);
  return [Math.max(0, ...speeds), Math.max(0, ...speeds.map((speed) => -speed))];
}
