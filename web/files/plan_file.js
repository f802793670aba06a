// Plan files: a request and its answer in one JSON document, as POST /v1/validate takes it.

import { FileError, quoted } from "./file_text.js";

const OF_ANSWERS = {
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
  search: (value) => isNumber(value?.expansions),
  timings_ms: (value) => isNumber(value?.plan) && isNumber(value.total),
  warnings: isList,
  tolerance: isNumber, // of the check, which comes with the plans
};
const TYPES = ["rotate", "translate", "wait"];

/** The document: the members of the answer (or null) beside those of the request. */
export function planFile(request, answer) {
  return { ...request, plans: [], ...answer };
}

/**
 * What a parsed JSON document is, taken apart: {request, answer}, one of which may be null. A faulty request is a
 * request, for the service to tell its faults. An answer's plans and figures can be shown; of what a document lacks,
 * what follows from its plans is filled in; whether it is `verified` is left out, as only a check can tell. Throws
 * FileError for what is neither.
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
  const answer = {};
  for (const [key, value] of Object.entries(document)) {
    const owner = Object.hasOwn(OF_ANSWERS, key) ? answer : request;
    owner[key] = value;
  }
  checkAnswer(answer);
  return { request: isRequest ? request : null, answer: completed(answer) };
}

/** Whether every robot of the answer is one of the request. */
export function belongsTo(answer, request) {
  const listed = Array.isArray(request?.robots) ? request.robots : [];
  const ids = new Set(listed.map((robot) => robot?.id));
  return [...answer.plans, ...answer.unplanned].every(({ robot }) => ids.has(robot));
}

function notOurs() {
  return new FileError(
    'It is JSON, but neither a request (with "map" and "robots") nor a plan (with "plans" as well).',
  );
}

function completed({ verified: _, ...answer }) {
  const plans = answer.plans.map((plan) => ({ cost: plan.actions.at(-1)?.t_end ?? 0, ...plan }));
  const costs = plans.map(({ cost }) => cost);
  const { unplanned = [], warnings = [] } = answer;
  const outcome = unplanned.length === 0 ? "solved" : "partial";
  return {
    status: plans.length === 0 ? "none" : outcome,
    flowtime: costs.reduce((sum, cost) => sum + cost, 0),
    makespan: costs.reduce((most, cost) => Math.max(most, cost), 0),
    ...answer,
    plans,
    unplanned,
    warnings,
  };
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

function checkAnswer(answer) {
  for (const [key, value] of Object.entries(answer)) {
    if (!OF_ANSWERS[key](value))
      throw new FileError(`${key} is not what an answer has there: ${quoted(value)}.`);
  }
  checkPlans(answer.plans);
  checkUnplanned(answer.unplanned ?? []);
}

function checkUnplanned(unplanned) {
  for (const [index, entry] of unplanned.entries()) {
    if (typeof entry?.robot !== "string") throw new FileError(`unplanned[${index}] names no robot.`);
  }
}

/** Whatever is drawn of plans must be there. Whether they are any good is the service's to tell. */
function checkPlans(plans) {
  const seen = new Set();
  for (const [index, plan] of plans.entries()) {
    const place = `plans[${index}]`;
    if (typeof plan?.robot !== "string") throw new FileError(`${place} names no robot.`);
    if (seen.has(plan.robot))
      throw new FileError(`${place} is a second plan of ${plan.robot}; a robot has one.`);
    seen.add(plan.robot);
    if (plan.cost !== undefined && !isNumber(plan.cost))
      throw new FileError(`${place}.cost must be a number.`);
    if (!Array.isArray(plan.actions))
      throw new FileError(`${place}, of ${plan.robot}, has no list of actions.`);
    for (const [number, action] of plan.actions.entries()) checkAction(action, `${place}.actions[${number}]`);
  }
}

function checkAction(action, place) {
  if (!TYPES.includes(action?.type)) throw new FileError(`${place} has no type of ${TYPES.join(", ")}.`);
  for (const time of ["t_start", "t_end"]) {
    if (!Number.isFinite(action[time])) throw new FileError(`${place}.${time} must be a number of seconds.`);
  }
  for (const end of ["from", "to"]) {
    for (const coordinate of ["x", "y", "theta"]) {
      if (Number.isFinite(action[end]?.[coordinate])) continue;
      throw new FileError(`${place}.${end}.${coordinate} must be a number.`);
    }
  }
}
