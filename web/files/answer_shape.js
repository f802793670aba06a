// What an answer has to be like to be shown. Whether its plans are any good is the service's to tell.

import { FileError, quoted } from "./file_text.js";

/** The members of an answer, each with what its value must be. */
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
  search: (value) => isNumber(value?.expansions),
  timings_ms: (value) => isNumber(value?.plan) && isNumber(value.total),
  warnings: (value) => isList(value) && value.every((each) => isText(each?.detail ?? each)),
  tolerance: isNumber, // of the check, which comes with the plans
};
const OF_UNPLANNED = {
  robot: isText,
  reason: isOptional(isText),
  detail: isOptional(isText),
  blocked_by: isOptional((value) => isList(value) && value.every(isText)),
};
const OF_PLANS = {
  robot: isText,
  cost: isOptional(isNumber),
  lower_bound: isOptional(isNumber),
  actions: isList,
};
const OF_ACTIONS = {
  type: (value) => TYPES.includes(value),
  t_start: isNumber,
  t_end: isNumber,
  from: isPose,
  to: isPose,
};
const TYPES = ["rotate", "translate", "wait"];

/** Throws FileError unless an answer's members can be shown. */
export function checkAnswer(answer) {
  checkMembers(answer, Object.keys(answer), OF_ANSWERS, "");
  for (const [index, entry] of (answer.unplanned ?? []).entries()) {
    checkMembers(entry, Object.keys(OF_UNPLANNED), OF_UNPLANNED, `unplanned[${index}].`);
  }
  const seen = new Set();
  for (const [index, plan] of answer.plans.entries()) {
    const place = `plans[${index}]`;
    checkMembers(plan, Object.keys(OF_PLANS), OF_PLANS, `${place}.`);
    if (seen.has(plan.robot))
      throw new FileError(`${place} is a second plan of ${plan.robot}; a robot has one.`);
    seen.add(plan.robot);
    for (const [number, action] of plan.actions.entries()) {
      checkMembers(action, Object.keys(OF_ACTIONS), OF_ACTIONS, `${place}.actions[${number}].`);
    }
  }
}

function checkMembers(value, keys, shape, place) {
  const wrong = keys.find((key) => !shape[key](value?.[key]));
  if (wrong === undefined) return;
  const found = value?.[wrong] === undefined ? "missing" : quoted(value[wrong]);
  throw new FileError(`${place}${wrong} is ${found}, which is not what an answer has there.`);
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
