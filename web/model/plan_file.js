// Plan files: a request and its answer in one JSON document, as POST /v1/validate takes it.

import { robotsOf } from "./listed.js";
import { FileError, quoted } from "./problem.js";

const TYPES = ["rotate", "translate", "wait"];

/** The document: the members of the answer (or null) beside the members of the request. */
export function planFile(request, answer) {
  return { ...request, plans: [], ...answer };
}

/**
 * Splits a parsed JSON document: {request, answer}, one of which may be null. A request may be faulty, because the
 * service reports its faults. An answer can be shown. Its costs are computed from its plans. It has no `verified`,
 * because it has not been checked yet. Throws FileError for other documents.
 */
export function readDocument(document) {
  if (document === null || typeof document !== "object" || Array.isArray(document)) throw notOurs();
  const isRequest = "map" in document || "robots" in document;
  if (!("plans" in document)) {
    if (isRequest) return { request: document, answer: null };
    if (document.errors !== undefined && document.title !== undefined)
      throw new FileError(
        `It is an error of the service: ${document.title}. Open the request that it is about.`,
      );
    throw notOurs();
  }
  const request = {};
  /** @type {any} */
  const answer = {};
  for (const [key, value] of Object.entries(document)) {
    const owner = Object.hasOwn(OF_ANSWERS, key) ? answer : request;
    owner[key] = value;
  }
  checkAnswer(answer);
  return { request: isRequest ? request : null, answer: completed(answer) };
}

/** Whether a parsed JSON document is a request of POST /v1/advance: a request, its plans and what robots report. */
export function isOfAdvance(document) {
  const { request, plans, ...rest } = document ?? {};
  return request !== null && typeof request === "object" && isList(plans) && !("map" in rest);
}

/** Whether every robot of the answer is one of the request. */
export function belongsTo(answer, request) {
  const ids = new Set(robotsOf(request).map((robot) => robot?.id));
  return [...answer.plans, ...answer.unplanned].every(({ robot }) => ids.has(robot));
}

function notOurs() {
  return new FileError(
    'It is JSON, but neither a request (with "map" and "robots") nor a plan (with "plans" as well).',
  );
}

/** The answer with all figures that follow from its plans. Figures in the document do not count. */
function completed({ verified: _, ...answer }) {
  const plans = answer.plans.map((plan) => ({ ...plan, cost: plan.actions.at(-1)?.t_end ?? 0 }));
  const { unplanned = [], warnings = [] } = answer;
  const outcome = unplanned.length === 0 ? "solved" : "partial";
  return {
    status: plans.length === 0 ? "none" : outcome,
    ...answer,
    plans,
    unplanned,
    flowtime: plans.reduce((sum, { cost }) => sum + cost, 0),
    makespan: plans.reduce((most, { cost }) => Math.max(most, cost), 0),
    warnings,
  };
}

/** The members of an answer, with a check of the value of each. */
export const OF_ANSWERS = {
  status: isText,
  request_id: isText,
  plans: isList,
  unplanned: isList,
  flowtime: isNumber,
  makespan: isNumber,
  lower_bound: (value) => isNumber(value?.flowtime) && isNumber(value.makespan),
  verified: isFlag,
  min_clearance: (value) => value === null || isNumber(value),
  deterministic: isFlag,
  objective_value: isNumber,
  lattice_spacing: isNumber,
  search: (value) => isNumber(value?.expansions),
  timings_ms: (value) => isNumber(value?.plan) && isNumber(value.total),
  unavoidable: isList,
  dependencies: (value) => value === null || isList(value),
  tight: (value) => value === null || isList(value),
  estimated: (value) => isNumber(value?.flowtime) && isNumber(value.makespan),
  warnings: (value) => isList(value) && value.every((each) => isText(each?.detail ?? each)),
  tolerance: isNumber, // of the check
};
const OF_BLOCKED = {
  blocked_by: isOptional((value) => isList(value) && value.every(isText)),
  blocked_by_total: isOptional(isNumber),
};
const OF_UNPLANNED = {
  robot: isText,
  reason: isOptional(isText),
  detail: isOptional(isText),
  ...OF_BLOCKED,
  actions: isOptional(isList),
};
const OF_PLANS = {
  robot: isText,
  cost: isOptional(isNumber),
  lower_bound: isOptional(isNumber),
  stuck: isOptional(isFlag),
  ...OF_BLOCKED,
  actions: isList,
};
const OF_ACTIONS = {
  type: (value) => TYPES.includes(value),
  t_start: isNumber,
  t_end: isNumber,
  from: isPose,
  to: isPose,
};

/** Whether a value has what actions have. */
export const isAction = (value) => Object.entries(OF_ACTIONS).every(([key, check]) => check(value?.[key]));

/** Throws FileError unless an answer's members can be shown. */
export function checkAnswer(answer) {
  const known = Object.keys(answer).filter((key) => Object.hasOwn(OF_ANSWERS, key));
  checkMembers(answer, known, OF_ANSWERS, "");
  for (const [index, entry] of (answer.unplanned ?? []).entries()) {
    const place = `unplanned[${index}].`;
    checkMembers(entry, Object.keys(OF_UNPLANNED), OF_UNPLANNED, place);
    checkActions(entry.actions ?? [], place);
  }
  const seen = new Set();
  for (const [index, plan] of answer.plans.entries()) {
    const place = `plans[${index}]`;
    checkMembers(plan, Object.keys(OF_PLANS), OF_PLANS, `${place}.`);
    if (seen.has(plan.robot))
      throw new FileError(`${place} is a second plan of ${plan.robot}; a robot has one.`);
    seen.add(plan.robot);
    checkActions(plan.actions, `${place}.`);
  }
}

function checkActions(actions, place) {
  for (const [number, action] of actions.entries()) {
    checkMembers(action, Object.keys(OF_ACTIONS), OF_ACTIONS, `${place}actions[${number}].`);
  }
}

function checkMembers(value, keys, shape, place) {
  const wrong = keys.find((key) => !shape[key](value?.[key]));
  if (wrong === undefined) return;
  const found = value?.[wrong] === undefined ? "missing" : quoted(value[wrong]);
  throw new FileError(`${place}${wrong} is ${found}, which is not valid in an answer.`);
}

function isPose(value) {
  return isNumber(value?.x) && isNumber(value.y) && isNumber(value.theta);
}

function isOptional(check) {
  return (value) => value === undefined || check(value);
}

function isText(value) {
  return typeof value === "string";
}

function isFlag(value) {
  return typeof value === "boolean";
}

function isList(value) {
  return Array.isArray(value);
}

function isNumber(value) {
  return Number.isFinite(value);
}
