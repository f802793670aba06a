// The service's check (POST /v1/validate): of an opened or edited request, and its violations in words. No DOM; the service is passed in.

import { alternativesOf, goalsOf, lastGoalOf, lastGoalPlace } from "./goals.js";
import { latestOnly } from "./latest.js";
import { robotsOf } from "./listed.js";
import { Follower } from "./motion.js";
import { ProblemError } from "./problem.js";

const SEEN = 0.25; // seconds before and after its time for which a violation is shown

const CONTACT = 1e-6; // metres that disks in contact may overlap

const KINDS = {
  robot_collision: "Robots collide",
  obstacle_collision: "Collides with a wall",
  discontinuity: "Discontinuous motion",
  speed: "Exceeds the speed limit",
  wrong_start: "Does not start at the start pose",
  wrong_goal: "Does not end at the goal pose",
  wrong_visit: "Does not visit a goal as requested",
  committed_changed: "Does not begin with its committed actions",
  margin: "Robots pass too soon after each other",
  moving_obstacle: "Collides with a moving obstacle",
};

const PLACEMENT_KINDS = new Set(["robot_collision", "obstacle_collision"]);
const TOLERANCE = 5e-7; // metres: disks that overlap by no more are in contact
const REST_MS = 350; // without a further edit

/** A kind of violation in words. */
export function kindInWords(kind) {
  return KINDS[kind] ?? kind;
}

/** The violations to show at a time: overlaps at that time, and all violations near it. */
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
  return Math.hypot(other.x - one.x, other.y - one.y) < one.radius + other.radius - CONTACT;
}

/** The plan file that checks the starts of a request: without plans, its robots are there at time 0. */
export function standingAtStarts(request) {
  return { ...request, plans: [], tolerance: TOLERANCE };
}

/**
 * The plan file that checks the last goals. The robots with a goal stand there with their last radii, and nothing
 * moves. Null if there are no such robots. A goal that may be at one of several poses has no pose yet.
 */
export function standingAtGoals(request) {
  const { obstacles: _, ...still } = standingAtStarts(request);
  const hasPose = (goal) => goal !== undefined && alternativesOf(goal).length === 0;
  const robots = robotsOf(request).filter((robot) => hasPose(lastGoalOf(robot)));
  if (robots.length === 0) return null;
  return { ...still, robots: robots.map(standingAtGoal) };
}

function standingAtGoal(robot) {
  const { goals: _, committed: __, previous: ___, ...rest } = robot;
  const { x, y, theta } = lastGoalOf(robot);
  const pose = theta === undefined ? { x, y } : { x, y, theta };
  const radius = goalsOf(robot).findLast((each) => each?.radius_after !== undefined)?.radius_after;
  return { ...rest, ...(radius === undefined ? {} : { radius }), start: pose, goal: pose };
}

/**
 * The errors, [{pointer, detail}], for the violations of robots standing at their "start" or "goal". Robots that yield may
 * have the goals of others.
 */
export function placementErrors(request, violations, pose) {
  const indices = new Map(robotsOf(request).map(({ id }, index) => [id, index]));
  const yielding = new Set(robotsOf(request).flatMap(({ id, idle }) => (idle === "yield" ? [id] : [])));
  const mayShare = ({ kind, robots }) =>
    pose === "goal" && kind === "robot_collision" && robots.some((id) => yielding.has(id));
  const standing = violations.filter(
    (each) => PLACEMENT_KINDS.has(each.kind) && !(each.t > 0) && !mayShare(each),
  );
  return standing.map(({ kind, robots, distance, required }) => {
    const placed = robots.map((id) => indices.get(id)).sort((a, b) => a - b);
    const missing = inMetres(required - distance);
    const detail =
      kind === "robot_collision"
        ? `${robots.join(" and ")} overlap at their ${pose}s, by ${missing}.`
        : `${robots[0]} does not fit at its ${pose}: it needs ${missing} more than is free.`;
    const index = placed.at(-1);
    const place = pose === "goal" ? lastGoalPlace(robotsOf(request)[index]) : pose;
    return { pointer: `/robots/${index}/${place}`, detail };
  });
}

const inMetres = (value) => `${Number(value.toFixed(4))} m`;

/**
 * Checks the session's request at once when it is opened, unless it is an example or a map without robots. Checks it
 * after edits when there was no edit for `rest` milliseconds. `validate(text)`: see service/client.js.
 */
export function watchRequest(session, validate, rest = REST_MS) {
  const later = latestOnly();
  session.on("request", ({ opened, proceeded = false }) => {
    later(opened ? 0 : rest, async (signal) => {
      if (proceeded || (opened && (session.example !== null || isEmpty(session.request)))) return;
      await judge(session, (text) => validate(text, signal), opened && !session.edited);
    });
  });
}

async function judge(session, validate, opened) {
  const isOpen = () => session.planning === null && (session.answer === null || session.outdated !== null);
  if (!isOpen()) return; // planning, or the check of an opened plan, finds the same faults
  const { turn } = session;
  const problem = await problemOf(session.request, validate);
  if (turn !== session.turn || !isOpen()) return;
  if (problem !== null || !opened) session.setProblem(problem); // others, such as of a lost connection, stay
}

/** The problem of a request, or null. */
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
    return errors.length > 0 ? { ...error.problem, errors } : null; // others do not concern the request
  }
}

/** Whether a request has no robots yet, as when a map has been opened. */
const isEmpty = (request) => Array.isArray(request?.robots) && request.robots.length === 0;

/** A request without robots is not reported while it is being edited. */
const isWithoutRobots = ({ pointer, code }) => pointer === "/robots" && ["empty", "missing"].includes(code);
