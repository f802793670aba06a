// The differences between two plans of the same robots. Pure. Seconds and metres.

import { robotsOf } from "./listed.js";
import { pathOf } from "./timeline.js";

/** @import {Action, Plan} from "./types.js" */

const SAME = 1e-6; // metres, seconds and radians

/**
 * The change of a robot's plan: other times on the same path, another path, or a plan in only one of the two.
 *
 * @typedef {"same" | "times" | "path" | "only here" | "only there"} Change
 * @typedef {{id: string, cost: number | null, other: number | null, difference: number | null, change: Change}} Row
 */

/**
 * The differences of `plans` from `others`, robot by robot. Changed robots come first, by the size of the difference of
 * their costs.
 * @param {Plan[]} plans
 * @param {Plan[]} others
 * @returns {Row[]}
 */
export function differences(plans, others) {
  const there = new Map(others.map((plan) => [plan.robot, plan]));
  const here = new Set(plans.map(({ robot }) => robot));
  const rows = [
    ...plans.map((plan) => rowOf(plan.robot, plan, there.get(plan.robot) ?? null)),
    ...others.filter(({ robot }) => !here.has(robot)).map((plan) => rowOf(plan.robot, null, plan)),
  ];
  const size = ({ change, difference }) => (change === "same" ? -1 : Math.abs(difference ?? Infinity));
  return rows.sort((a, b) => (size(a) === size(b) ? 0 : size(b) - size(a)));
}

/** @returns {Row} */
function rowOf(id, plan, other) {
  const [cost, otherCost] = [plan?.cost ?? null, other?.cost ?? null];
  const difference = cost === null || otherCost === null ? null : cost - otherCost;
  return { id, cost, other: otherCost, difference, change: changeOf(plan, other) };
}

/** @returns {Change} */
function changeOf(plan, other) {
  if (other === null) return "only here";
  if (plan === null) return "only there";
  if (sameActions(plan.actions, other.actions)) return "same";
  return samePoints(pathOf(plan.actions), pathOf(other.actions)) ? "times" : "path";
}

/**
 * @param {Action[]} actions
 * @param {Action[]} others
 */
function sameActions(actions, others) {
  return (
    actions.length === others.length &&
    actions.every((action, at) => {
      const other = others[at];
      return (
        action.type === other.type &&
        near(action.t_end, other.t_end) &&
        near(action.to.theta, other.to.theta) &&
        samePoints([action.to], [other.to])
      );
    })
  );
}

function samePoints(points, others) {
  return (
    points.length === others.length &&
    points.every(({ x, y }, at) => near(x, others[at].x) && near(y, others[at].y))
  );
}

const near = (a, b) => Math.abs(a - b) <= SAME;

/** The sums: {changed, robots, flowtime, makespan}, the last two as differences, seconds. */
export function summed(rows) {
  const both = rows.filter(({ difference }) => difference !== null);
  const most = (name) => Math.max(0, ...both.map((row) => row[name]));
  return {
    robots: rows.length,
    changed: rows.filter(({ change }) => change !== "same").length,
    flowtime: both.reduce((sum, { difference }) => sum + (difference ?? 0), 0),
    makespan: most("cost") - most("other"),
  };
}

/** The previous plans of a request as plans, or null if it has none. */
export function previousPlans(request) {
  const plans = robotsOf(request)
    .filter((robot) => Array.isArray(robot?.previous))
    .map(({ id, previous }) => ({ robot: id, cost: previous.at(-1)?.t_end ?? 0, actions: previous }));
  return plans.length > 0 ? plans : null;
}
