// The part of a plan that still holds after its request was edited. A robot whose own part of the request changed is
// outdated at once. For the other robots, the service's check of the plan under the edited request decides (POST
// /v1/validate). Outdated robots stand at their starts until the request is planned again. No DOM; the service is
// passed in.

import { goalsOf } from "./goals.js";
import { latestOnly } from "./latest.js";
import { robotsOf } from "./listed.js";
import { ProblemError } from "./problem.js";

const REST_MS = 350; // without a further edit
const MAX_ROUNDS = 20; // of checks: each lists only the first violations

const byId = (request) => new Map(robotsOf(request).map((robot) => [robot?.id, robot]));

/** The ids of the answer's robots that are not in `request` as they were in `before`, the request that it answers. */
export function changedRobots(answer, before, request) {
  const [old, now] = [byId(before), byId(request)];
  const isSame = (id) => now.has(id) && isAlike(old.get(id), now.get(id));
  const answered = [...answer.plans, ...(answer.unplanned ?? [])];
  return new Set(answered.map(({ robot }) => robot).filter((id) => !isSame(id)));
}

/** Whether two parts of requests, or two requests, are the same. */
export const isAlike = (one, other) => one === other || JSON.stringify(one) === JSON.stringify(other);

/** The plan file with the plans that may hold: of the robots that are not outdated. */
export function fileToCheck(request, answer, outdated) {
  return { ...request, plans: answer.plans.filter(({ robot }) => !outdated.has(robot)) };
}

/**
 * The robots of a checked plan file whose plans the violations break. Where two robots meet, one of which stands as it
 * has no plan, this one moves away if it has a goal.
 */
export function brokenBy(violations, { plans, ...request }) {
  const planned = new Set(plans.map(({ robot }) => robot));
  const listed = byId(request);
  const movesAway = (id) => !planned.has(id) && listed.has(id) && goalsOf(listed.get(id)).length > 0;
  const broken = violations.filter(({ robots }) => !robots.some(movesAway)).flatMap(({ robots }) => robots);
  return new Set(broken.filter((id) => planned.has(id)));
}

/**
 * Checks what holds of the session's plan when there was no edit for `rest` milliseconds. `validate(text)`: see
 * service/client.js.
 */
export function watchKeptPlan(session, validate, rest = REST_MS) {
  const later = latestOnly();
  session.on("request", () => {
    later(rest, async (signal) => {
      if (session.outdated !== null) await judge(session, (text) => validate(text, signal));
    });
  });
  session.on("planning", () => later(0, async () => {})); // a new plan replaces it
}

async function judge(session, validate) {
  const { turn, answer, request } = session;
  for (let round = 0; round < MAX_ROUNDS; round += 1) {
    const file = fileToCheck(request, answer, session.outdated);
    const check = file.plans.length === 0 ? null : await checked(file, validate);
    if (check === null || turn !== session.turn || answer !== session.answer) return;
    const broken = brokenBy(check.violations, file);
    if (broken.size > 0) session.outdate(broken);
    const all = (check.violations_total ?? 0) <= check.violations.length;
    if (all || broken.size === 0) return;
  }
}

/** The check, or null if the service has none: the faults of a request are shown elsewhere, see checks.js. */
async function checked(file, validate) {
  try {
    return await validate(JSON.stringify(file));
  } catch (error) {
    if (!(error instanceof ProblemError)) throw error;
    return null;
  }
}
