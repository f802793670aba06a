// What the history keeps: a request as it was opened, with its edits, and the answer that is shown with it. Immutable.

import { changedRobots } from "./kept_plan.js";

const EMPTY = { name: "", example: null, text: "", request: null };

/** The document of what was opened, {name, example, text, request}; nothing by default. */
export function documentOf(opened = EMPTY) {
  return { opened, request: opened.request, answer: null, planned: null };
}

/** The document with another request. Its answer is kept as the answer to the request before. */
export function edited(document, request) {
  return { ...document, request };
}

/** The document with an answer of its request, or none (null). */
export function answered(document, answer) {
  return { ...document, answer, planned: answer === null ? null : document.request };
}

/**
 * The robots whose plans do not hold in an edited document, as far as their own parts of the request tell. Null if
 * there is no answer, or if it is the answer to the present request.
 */
export function outdatedIn({ answer, planned, request }) {
  return answer === null || planned === request ? null : changedRobots(answer, planned, request);
}
