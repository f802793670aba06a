// When a robot has served its goals, by its actions alone. For answers without `visits`, such as the runs of a
// simulation, and for robots without a plan that execute their committed actions. Pure. Seconds, metres, radians.

import { turnBetween } from "./timeline.js";

/** @import {Action, Robot} from "./types.js" */

const ROUNDING = 1e-6; // metres, radians, and seconds

/**
 * The ends of its services, in the order of the goals: [{goal, t}], each goal as early as possible. The last goal is
 * served at the end of a plan only.
 * @param {Robot} robot
 * @param {Action[]} actions
 * @param {boolean} isPlan
 * @returns {{goal: number, t: number}[]}
 */
export function servicesOf(robot, actions, isPlan) {
  if (!isPlan && actions.length === 0) return [];
  const places = placesOf(robot);
  const served = [];
  let free = 0; // since when it is at rest and serves nothing
  const serve = (pose, now, marked = -1, isEnd = false) => {
    for (let goal = served.length; goal < places.length - (isEnd ? 0 : 1); goal += 1) {
      const { service, notBefore } = robot.services[goal];
      const isThere = marked === goal || places[goal].some((place) => isIn(pose, place));
      const t = Math.max(free, notBefore) + service;
      if (!isThere || (t > now + ROUNDING && !isEnd)) return;
      served.push({ goal, t });
      free = t;
    }
  };
  serve(robot.start, 0);
  for (const { type, t_end, to, goal } of actions) {
    if (type !== "wait") free = t_end;
    serve(to, t_end, goal);
  }
  const last = actions.at(-1);
  if (isPlan) serve(last?.to ?? robot.start, last?.t_end ?? 0, last?.goal, true);
  return served;
}

/** The poses at one of which each goal is served. */
function placesOf({ via, goal, alternatives }) {
  return [...via, goal].slice(0, alternatives.length).map((each, at) => {
    const poses = alternatives[at].length > 0 ? alternatives[at] : [each];
    return poses.filter((pose) => pose !== null);
  });
}

function isIn(pose, { x, y, theta }) {
  if (Math.hypot(pose.x - x, pose.y - y) > ROUNDING) return false;
  return theta === null || Math.abs(turnBetween(pose.theta, theta)) <= ROUNDING;
}
