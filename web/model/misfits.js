// Starts and goals that do not fit, found by the service's check of robots that just stand there, told as the
// errors that planning would give. Pure.

import { robotsOf } from "./edit_robots.js";

const TOLERANCE = 1e-9; // metres: what planning forgives

/** What to have checked for a request's starts: its robots, standing there. */
export function standingAtStarts(request) {
  return { ...request, plans: [], tolerance: TOLERANCE };
}

/** What to have checked for its goals: the robots that have one, standing there; null if none has. */
export function standingAtGoals(request) {
  const robots = robotsOf(request).filter(({ goal }) => goal !== undefined);
  if (robots.length === 0) return null;
  return { ...standingAtStarts(request), robots: robots.map((robot) => ({ ...robot, start: robot.goal })) };
}

/**
 * The errors, [{pointer, detail}], that the violations of robots standing at their "start" or "goal" amount to.
 */
export function misfitErrors(request, violations, pose) {
  const indices = new Map(robotsOf(request).map(({ id }, index) => [id, index]));
  return violations.map(({ kind, robots, distance, required }) => {
    const placed = robots.map((id) => indices.get(id)).sort((a, b) => a - b);
    const room = `${inMetres(distance)} where ${inMetres(required)} is needed`;
    const others = robots.filter((id) => indices.get(id) !== placed.at(-1));
    const detail =
      kind === "robot_collision"
        ? `The ${pose} overlaps with that of ${others.join(" and ")}: ${room}, from middle to middle.`
        : `The ${pose} does not fit: ${room}, from its middle to a wall or the edge of the map.`;
    return { pointer: `/robots/${placed.at(-1)}/${pose}`, detail };
  });
}

const inMetres = (value) => `${Number(value.toFixed(4))} m`;
