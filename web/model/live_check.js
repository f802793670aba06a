// An edited request is judged by the service soon after, so that a fault shows while one edits, not when one
// plans.

import { ProblemError } from "../service/problem.js";
import { misfitErrors, standingAtGoals, standingAtStarts } from "./misfits.js";

const REST_MS = 350; // without a further edit

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
    const errors = misfitErrors(request, violations, "start");
    const atGoals = standingAtGoals(request);
    if (atGoals) {
      const check = await validate(JSON.stringify(atGoals));
      errors.push(...misfitErrors(request, check.violations, "goal"));
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
