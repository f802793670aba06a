// The service's check (POST /v1/validate): of an edited request, soon after each edit, and its violations in words.
// No DOM; the service is passed in.

import { robotsOf } from "./edit_request.js";
import { Follower } from "./motion.js";
import { ProblemError } from "./problem.js";

const SEEN = 0.25; // seconds before and after its moment for which a violation can be seen

const CONTACT = 1e-6; // metres that disks may overlap in contact

const KINDS = {
  robot_collision: "Robots collide",
  obstacle_collision: "Collides with a wall",
  discontinuity: "Discontinuous motion",
  speed: "Exceeds the speed limit",
  wrong_start: "Does not start at the start pose",
  wrong_goal: "Does not end at the goal pose",
};

const TOLERANCE = 1e-9; // metres: what planning forgives
const REST_MS = 350; // without a further edit

/** A kind of violation in words. */
export function kindInWords(kind) {
  return KINDS[kind] ?? kind;
}

/** The violations to be seen at a time: robots that overlap then, and all whose moment is near. */
export function violationsAt(violations, time, motions) {
  return violations.filter(
    ({ kind, robots, t }) =>
      Math.abs(t - time) <= SEEN || (kind === "robot_collision" && overlap(motions, robots, time)),
  );
}

function overlap(motions, ids, time) {
  const [a, b] = ids.map((id) => motions.get(id));
  if (!a || !b) return false;
  const [one, other] = [a, b].map((motion) => {
    const follower = new Follower(motion);
    follower.look(time, time);
    return follower;
  });
  return Math.hypot(other.x - one.x, other.y - one.y) < a.radius + b.radius - CONTACT;
}

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
export function placementErrors(request, violations, pose) {
  const indices = new Map(robotsOf(request).map(({ id }, index) => [id, index]));
  return violations.map(({ kind, robots, distance, required }) => {
    const placed = robots.map((id) => indices.get(id)).sort((a, b) => a - b);
    const room = `${inMetres(distance)} of the required ${inMetres(required)}`;
    const others = robots.filter((id) => indices.get(id) !== placed.at(-1));
    const detail =
      kind === "robot_collision"
        ? `The ${pose} overlaps that of ${others.join(" and ")}: ${room}, between the centres.`
        : `The ${pose} does not fit: ${room}, from its centre to a wall or the edge of the map.`;
    return { pointer: `/robots/${placed.at(-1)}/${pose}`, detail };
  });
}

const inMetres = (value) => `${Number(value.toFixed(4))} m`;

/**
 * Has the service judge the session's request when edits have rested so many milliseconds. `validate(text)`:
 * see service/client.js.
 */
export function watchEdits(session, validate, rest = REST_MS) {
  let timer = null;
  session.on("request", ({ opened }) => {
    clearTimeout(timer);
    if (!opened || session.edited) timer = setTimeout(() => judge(session, validate), rest);
  });
}

async function judge(session, validate) {
  const { turn } = session;
  const problem = await problemOf(session.request, validate);
  const stillShown = turn === session.turn && session.planning === null && session.answer === null;
  if (stillShown) session.setProblem(problem);
}

/** What is wrong with a request, or null. */
async function problemOf(request, validate) {
  try {
    const atStarts = standingAtStarts(request);
    const { violations } = await validate(JSON.stringify(atStarts));
    const errors = placementErrors(request, violations, "start");
    const atGoals = standingAtGoals(request);
    if (atGoals) {
      const check = await validate(JSON.stringify(atGoals));
      errors.push(...placementErrors(request, check.violations, "goal"));
    }
    if (errors.length === 0) return null;
    return { title: "Invalid Request", errors };
  } catch (error) {
    if (!(error instanceof ProblemError)) throw error;
    const errors = (error.problem.errors ?? []).filter((each) => !isWithoutRobots(each));
    return errors.length > 0 ? { ...error.problem, errors } : null; // others are not about the request
  }
}

/** That a request has no robots yet is no fault while it is being made. */
const isWithoutRobots = ({ pointer, code }) => pointer === "/robots" && ["empty", "missing"].includes(code);
