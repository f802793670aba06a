// An edited request is judged by the service soon after, so that a fault shows while one edits, not when one plans.

import { planFile } from "../files/plan_file.js";
import { ProblemError } from "../service/problem.js";

const REST_MS = 350; // without a further edit

/** Has the service judge the session's request after edits. `validate(text)`: see service/client.js. */
export function watchEdits(session, validate) {
  let timer = null;
  session.on("request", ({ opened }) => {
    clearTimeout(timer);
    if (!opened) timer = setTimeout(() => judge(session, validate), REST_MS);
  });
}

async function judge(session, validate) {
  const { turn } = session;
  let problem = null;
  try {
    await validate(JSON.stringify(planFile(session.request, null)));
  } catch (error) {
    if (!(error instanceof ProblemError)) throw error;
    problem = error.problem.errors?.length > 0 ? error.problem : null; // others are not about the request
  }
  if (turn === session.turn && session.planning === null && session.answer === null) session.setProblem(problem);
}
