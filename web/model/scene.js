// What to draw of a request and its answer. Faulty requests are drawn as far
// as possible; the service reports their faults.

import { asRows } from "./drawn_map.js";
import { alternativesOf, goalsOf } from "./goals.js";
import { preparedCells, readRows } from "./grid_cells.js";
import { robotsOf } from "./listed.js";
import { radiusAt } from "./motion.js";
import { readObstacles } from "./moving_obstacles.js";
import { inertiaAfter, inertiaOf, withChanges } from "./profile.js";
import { servicesOf } from "./services.js";
import { stuckOf } from "./stuck.js";
import { doingAt, pathOf, poseAt } from "./timeline.js";
import { readZones } from "./zones.js";

/** @import {Answer, Grid, Robot, Scene, Track} from "./types.js" */

/**
 * The map as {map, lines, columns, rows, resolution, origin, blocked, bounds}; blocked[row * columns +
 * column], top row first. `previous` saves reading unchanged parts.
 * @param {Grid | null} previous
 * @returns {Grid | null}
 */
export function readGrid(map, previous) {
  if (previous !== null && map === previous.map) return previous;
  const drawn = asRows(map);
  const lines = drawn?.rows.filter((row) => typeof row === "string") ?? [];
  const columns = lines.reduce((most, row) => Math.max(most, row.length), 0);
  if (drawn === null || columns === 0) return null;
  const resolution = positive(drawn.resolution) ? drawn.resolution : 1;
  const origin = { x: finiteOr(drawn.origin?.x, 0), y: finiteOr(drawn.origin?.y, 0) };
  const bounds = {
    left: origin.x,
    bottom: origin.y,
    right: origin.x + columns * resolution,
    top: origin.y + lines.length * resolution,
  };
  const blocked = preparedCells(drawn.rows) ?? readCells(lines, columns, previous);
  return { map, lines, columns, rows: lines.length, resolution, origin, blocked, bounds };
}

function readCells(lines, columns, previous) {
  const alike = previous?.columns === columns && previous.rows === lines.length;
  const blocked = alike ? previous.blocked.slice() : new Uint8Array(columns * lines.length);
  for (let row = 0; row < lines.length; row += 1) {
    if (!alike || lines[row] !== previous.lines[row]) readRows(lines, columns, blocked, row, row + 1);
  }
  return blocked;
}

/** @returns {Robot[]} */
function readRobots(request) {
  const robots = [];
  robotsOf(request).forEach((robot, index) => {
    const radius = robot?.radius ?? request.robot_defaults?.radius;
    const start = readPose(robot?.start);
    if (!start || !positive(radius)) return;
    const id = typeof robot.id === "string" ? robot.id : `#${index}`;
    const goals = goalsOf(robot).map(readPose);
    const goal = goals.at(-1) ?? null;
    const committed = pathOf(readActions(robot.committed));
    robots.push({
      index,
      id,
      radius,
      start: { ...start, theta: start.theta ?? 0 },
      goal,
      via: goals.slice(0, -1),
      alternatives: goalsOf(robot).map((each) => alternativesOf(each).map(readPose)),
      radiiAfter: goalsOf(robot).map((each) => (positive(each?.radius_after) ? each.radius_after : null)),
      services: goalsOf(robot).map((each) => ({
        service: finiteOr(each?.service, 0),
        notBefore: finiteOr(each?.not_before, 0),
      })),
      committed,
      vicinity: vicinityOf(robot, request.robot_defaults),
      yields: robot.idle === "yield",
      makesWay: robot.idle === "yield" || robot.idle === "return",
      ...inertiasOf(robot, request.robot_defaults),
    });
  });
  return robots;
}

/** What a robot needs to change its speed, and after each of its goals. */
function inertiasOf(robot, defaults) {
  const inertia = inertiaOf(robot, defaults);
  let latest = inertia;
  const inertiasAfter = goalsOf(robot).map((goal) => (latest = inertiaAfter(goal, latest)));
  return { inertia, inertiasAfter };
}

/** The distance that a robot keeps from others, metres. */
function vicinityOf(robot, defaults) {
  const vicinity = robot?.vicinity ?? defaults?.vicinity;
  return positive(vicinity) ? vicinity : 0;
}

/** The actions that can be drawn. */
function readActions(listed) {
  if (!Array.isArray(listed)) return [];
  return listed.filter((action) => readPose(action?.from) !== null && readPose(action.to) !== null);
}

function readPose(pose) {
  if (!Number.isFinite(pose?.x) || !Number.isFinite(pose?.y)) return null;
  return { x: pose.x, y: pose.y, theta: Number.isFinite(pose.theta) ? pose.theta : null };
}

/**
 * The scene of a parsed request: {grid, robots, obstacles, zones}; the grid is null when there is no map to draw. `previous`,
 * the scene of an earlier request, makes it cheap to read an edited one.
 * @param {Scene | null} previous
 * @returns {Scene}
 */
export function readScene(request, previous = null) {
  const robots = readRobots(request);
  const shared = commonPrefixLength(robots.map(({ id }) => id));
  for (const robot of robots) robot.label = robot.id.slice(shared);
  const grid = readGrid(request?.map, previous?.grid ?? null);
  return { grid, robots, obstacles: readObstacles(request), zones: readZones(request, grid) };
}

/**
 * The track of each robot of the scene, by id: {status, actions, chosen, radii, path, cost, lowerBound, late,
 * unplanned, stuck, former}.
 *
 * - `status` before there is an answer: "ready"
 * - `status` after that: "planned"; "parked" (it has no goal and does not move); "unplanned" (it executes its committed
 *   actions, if any); or "outdated" (it stands at its start, because its plan no longer holds)
 * - `former`: the actions of an outdated plan; then the path belongs to them
 * - `chosen`: by goal, the pose that the plan takes of a goal with alternatives; null for other goals
 * - `radii`: the radii that it has later, as [{t, radius}], each from its t on
 * - `lowerBound`: the lower bound of its cost (seconds); null if the answer lacks it
 * - `late`: the goals at which it arrives after they were due: [{goal, seconds}]
 * - `stuck`: which robots block it, if it gains nothing within the horizon, see stuckOf
 *
 * @param {Scene} scene
 * @param {Answer | null} answer
 * @param {Set<string> | null} outdated the ids of robots whose plans no longer hold
 * @returns {Map<string, Track>}
 */
export function readTracks(scene, answer, outdated = null) {
  const plans = new Map((answer?.plans ?? []).map((plan) => [plan.robot, plan]));
  const failures = new Map((answer?.unplanned ?? []).map((entry) => [entry.robot, entry]));
  const stuck = new Map(stuckOf(answer).map((entry) => [entry.robot, entry]));
  const tracks = new Map();
  for (const robot of scene.robots) {
    if (outdated?.has(robot.id)) {
      tracks.set(robot.id, outdatedTrack(plans.get(robot.id)));
      continue;
    }
    const listed = (plans.get(robot.id) ?? failures.get(robot.id))?.actions ?? [];
    const leaves = leavesOf(robot, plans.get(robot.id), listed);
    const loads = leaves.map(({ goal, t }) => ({ t, inertia: robot.inertiasAfter[goal] ?? robot.inertia }));
    const actions = withChanges(listed, robot.inertia, loads);
    tracks.set(robot.id, {
      status: statusOf(robot, plans, failures),
      actions,
      chosen: chosenOf(robot, plans.get(robot.id)),
      radii: radiiOf(robot, leaves),
      path: pathOf(actions),
      cost: plans.get(robot.id)?.cost ?? null,
      lowerBound: plans.get(robot.id)?.lower_bound ?? null,
      late: lateOf(plans.get(robot.id)),
      unplanned: failures.get(robot.id) ?? null,
      stuck: stuck.get(robot.id) ?? null,
      former: [],
    });
  }
  return tracks;
}

/** The track of a robot whose plan, if it has one, no longer holds. */
function outdatedTrack(plan) {
  const former = plan?.actions ?? [];
  const nothing = {
    actions: [],
    chosen: [],
    radii: [],
    cost: null,
    lowerBound: null,
    late: [],
    unplanned: null,
    stuck: null,
  };
  return { status: plan === undefined ? "ready" : "outdated", ...nothing, path: pathOf(former), former };
}

function chosenOf({ alternatives }, plan) {
  const visits = Array.isArray(plan?.visits) ? plan.visits : [];
  const choices = new Map(visits.map(({ goal, choice }) => [goal, choice]));
  return alternatives.map((poses, goal) => poses[choices.get(goal)] ?? null);
}

function lateOf(plan) {
  const visits = Array.isArray(plan?.visits) ? plan.visits : [];
  return visits.filter(({ late_by }) => late_by > 0).map(({ goal, late_by }) => ({ goal, seconds: late_by }));
}

/**
 * When services at goals end, in their order: [{goal, t}]. For a robot without a plan, the services of its committed
 * actions.
 */
function leavesOf(robot, plan, actions) {
  if (!Array.isArray(plan?.visits)) return servicesOf(robot, actions, plan !== undefined);
  const reached = plan.visits.filter(({ t_arrive }) => t_arrive !== null);
  return reached
    .map(({ goal, t_leave }) => ({ goal, t: t_leave ?? plan.cost }))
    .filter(({ t }) => Number.isFinite(t));
}

/** The radii that goals change, from the ends of their services. */
function radiiOf({ radiiAfter }, leaves) {
  const changes = leaves.map(({ goal, t }) => ({ t, radius: radiiAfter[goal] ?? null }));
  return changes.filter(({ radius }) => radius !== null);
}

function statusOf(robot, plans, failures) {
  if (failures.has(robot.id)) return "unplanned";
  const plan = plans.get(robot.id);
  const hasGoal = robot.goal || robot.alternatives.at(-1)?.length > 0;
  if (!hasGoal && !(plan?.actions.length > 0)) return "parked";
  return plan === undefined ? "ready" : "planned";
}

/** The pose of a robot at t on its track. */
export function robotPoseAt(robot, track, t) {
  return poseAt(track.actions, robot.start, t);
}

/** The radius of a robot at t on its track. */
export function robotRadiusAt({ radius }, { radii }, t) {
  return radiusAt({ radius, radii }, t);
}

/** The state of a robot at t, one word. */
export function robotStateAt(track, t) {
  return track.status === "planned" ? doingAt(track.actions, t) : track.status;
}

/** The length of the common prefix of all ids, without splitting a number or leaving an id empty. */
function commonPrefixLength(ids) {
  if (ids.length < 2) return 0;
  let length = 0;
  while (
    length < ids[0].length - 1 &&
    ids.every((id) => id.length > length + 1 && id[length] === ids[0][length])
  ) {
    length += 1;
  }
  while (length > 0 && /\d/.test(ids[0][length - 1])) length -= 1;
  return length;
}

function positive(value) {
  return Number.isFinite(value) && value > 0;
}

function finiteOr(value, otherwise) {
  return Number.isFinite(value) ? value : otherwise;
}
