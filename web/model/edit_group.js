// Edits of several robots at once, see edit_request.js. Robots are identified by their indices. Pure.

import { tidy } from "./cells.js";
import { objectOf, setPose, withMember } from "./edit_request.js";
import { lastGoalOf } from "./goals.js";
import { robotsOf } from "./listed.js";

/** The value that all of these robots have for a member; undefined if they differ or have none. */
export function sharedValue(request, indices, name) {
  const values = indices.map((index) => robotsOf(request)[index]?.[name]);
  return values.every((value) => Object.is(value, values[0])) ? values[0] : undefined;
}

/** Whether robots differ in a member. */
export function differ(request, indices, name) {
  const values = indices.map((index) => robotsOf(request)[index]?.[name]);
  return values.some((value) => !Object.is(value, values[0]));
}

/** The request with a member of these robots set, or removed if undefined. */
export function setRobots(request, indices, name, value) {
  const chosen = new Set(indices);
  const robots = robotsOf(request).map((robot, at) => {
    return chosen.has(at) ? withMember(objectOf(robot), name, value) : robot;
  });
  const changed = robots.some((robot, at) => robot !== robotsOf(request)[at]);
  return changed ? { ...objectOf(request), robots } : request;
}

/** The request with the "start" or last "goal" of these robots moved by {x, y}, metres; some have no goal. */
export function moveRobots(request, indices, pose, by) {
  return indices.reduce((moved, index) => {
    const robot = robotsOf(moved)[index];
    const from = pose === "goal" ? lastGoalOf(robot) : robot?.start;
    if (!Number.isFinite(from?.x) || !Number.isFinite(from?.y)) return moved;
    return setPose(moved, index, pose, { x: tidy(from.x + by.x), y: tidy(from.y + by.y) });
  }, request);
}

/** The request without these robots. */
export function deleteRobots(request, indices) {
  const gone = new Set(indices);
  return { ...objectOf(request), robots: robotsOf(request).filter((_, at) => !gone.has(at)) };
}
