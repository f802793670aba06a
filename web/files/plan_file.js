// Plan files: a request and its answer in one JSON document, as POST /v1/validate takes it.

import { checkAnswer, OF_ANSWERS } from "./answer_shape.js";
import { FileError } from "./file_text.js";

/** The document: the members of the answer (or null) beside those of the request. */
export function planFile(request, answer) {
  return { ...request, plans: [], ...answer };
}

/**
 * What a parsed JSON document is, taken apart: {request, answer}, one of which may be null. A faulty request is
 * a request, for the service to tell its faults. An answer can be shown and has all that follows from its plans,
 * but is not called `verified`, as only a check can tell. Throws FileError for what is neither.
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

/** What follows from the plans is taken from there, whatever the document says of it. */
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
