// Edits of a request's robots: a request in, another out that shares what is the same; nothing is changed in
// place. Robots are named by their index. Faulty requests are mended as far as an edit goes. Pure.

import { objectOf, withMember, withMembers } from "./members.js";

const SPEEDS = { linear_speed: 1, angular_speed: 3.1416 }; // m/s, rad/s: where nobody says
const RADIUS_SHARE = 0.4; // of a cell, likewise

/** The robots that the request lists, whatever they are. */
export function robotsOf(request) {
  return Array.isArray(request?.robots) ? request.robots : [];
}

/** What to call the robot at an index: its id, or "#index". */
export function nameOf(request, index) {
  const id = robotsOf(request)[index]?.id;
  return typeof id === "string" && id !== "" ? id : `#${index}`;
}

/**
 * The request with a member of a robot (id, radius, linear_speed, angular_speed) set, or left out if undefined.
 */
export function setRobot(request, index, name, value) {
  return withRobot(request, index, (robot) => withMember(robot, name, value));
}

/** The request with a default (radius, linear_speed, angular_speed) set, or left out if undefined. */
export function setDefault(request, name, value) {
  const defaults = withMember(objectOf(request?.robot_defaults), name, value);
  const isEmpty = Object.keys(defaults).length === 0;
  return withMember(objectOf(request), "robot_defaults", isEmpty ? undefined : defaults);
}

/**
 * The request with members of a robot's `pose`, "start" or "goal", set: {x, y, theta}, those that are undefined
 * left out (theta: the start's default, the goal's any heading).
 */
export function setPose(request, index, pose, members) {
  return withRobot(request, index, (robot) => {
    return withMember(robot, pose, withMembers(objectOf(robot[pose]), members));
  });
}

/** The request with a robot that stays where it is. */
export function removeGoal(request, index) {
  return withRobot(request, index, (robot) => withMember(robot, "goal", undefined));
}

/**
 * The request with one more robot, the last: a start {x, y} and perhaps a goal. Radius and speeds are those of
 * robot_defaults, else the last robot's, else sensible ones for the map.
 */
export function addRobot(request, start, goal = undefined) {
  const robots = robotsOf(request);
  const last = objectOf(robots.at(-1));
  const resolution = request?.map?.resolution ?? 1;
  const usual = { radius: RADIUS_SHARE * (resolution > 0 ? resolution : 1), ...SPEEDS };
  const robot = { id: freshId(request) };
  for (const name of ["radius", "linear_speed", "angular_speed"]) {
    if (!(request?.robot_defaults?.[name] > 0)) robot[name] = last[name] > 0 ? last[name] : usual[name];
  }
  robot.start = start;
  if (goal !== undefined) robot.goal = goal;
  return { ...objectOf(request), robots: [...robots, robot] };
}

/**
 * The request with a robot once more, the last: its like with an id, start and goal (if it has one) of its own.
 */
export function duplicateRobot(request, index, start, goal) {
  const robots = robotsOf(request);
  const robot = objectOf(robots[index]);
  const copy = { ...robot, id: freshId(request, robot.id), start: { ...robot.start, ...start } };
  if (goal) copy.goal = { ...robot.goal, ...goal };
  return { ...objectOf(request), robots: [...robots, copy] };
}

export function deleteRobot(request, index) {
  return { ...objectOf(request), robots: robotsOf(request).filter((_, at) => at !== index) };
}

/**
 * An id that no robot has, of the pattern of `like` or else of the last that ends in a number: robot-4 after
 * robot-3.
 */
export function freshId(request, like = undefined) {
  const taken = new Set(robotsOf(request).map((robot) => robot?.id));
  const ids = [...taken].filter((id) => typeof id === "string");
  const pattern = numbered(like) ?? numbered(ids.findLast((id) => /\d$/.test(id)));
  const { stem, digits, number } = pattern ?? { stem: like ? `${like}-` : "robot-", digits: 1, number: 0 };
  let next = number;
  let id;
  do {
    next += 1;
    id = stem + String(next).padStart(digits, "0");
  } while (taken.has(id));
  return id;
}

/** The parts of an id that ends in a number, or null. */
function numbered(id) {
  const found = /^(.*?)(\d{1,9})$/.exec(id ?? "");
  return found && { stem: found[1], digits: found[2].length, number: Number(found[2]) };
}

function withRobot(request, index, change) {
  const robots = robotsOf(request);
  const robot = objectOf(robots[index]);
  const changed = change(robot);
  if (changed === robots[index]) return request;
  return { ...objectOf(request), robots: robots.map((each, at) => (at === index ? changed : each)) };
}
