// The page measures gaps in the same way as the service's check. The plans are of each example, and of random fleets
// with loads. To have robots under way, there are also plans of a moment later, with loads and committed motion.

import assert from "node:assert/strict";
import { after, test } from "node:test";

import { clearanceOf } from "../../../web/model/clearance.js";
import { FleetMotion } from "../../../web/model/fleet_motion.js";
import { planFile } from "../../../web/model/plan_file.js";
import { Shown } from "../../../web/model/shown.js";
import { Signals } from "../../../web/model/signals.js";
import { answerOfRun, FIRST_FORM, simulationOf } from "../../../web/model/simulation.js";
import { startService } from "../support/service.js";

const service = await startService();
after(() => service.stop());

const AGREED = 1e-6; // metres: the service rounds gaps of contact to 0
const LATER = [0.2, 0.5]; // of the time that the plan takes
const COMMIT = 1; // seconds

async function ask(path, body) {
  const init = body && {
    method: "POST",
    headers: { "Content-Type": "application/json" },
    body: JSON.stringify(body),
  };
  const response = await fetch(new URL(path, service.url), init).catch((error) => {
    throw new Error(`${service.url}${path}: ${error.cause}`, { cause: error });
  });
  const answer = await response.json();
  assert.equal(response.status, 200, `${path}: ${JSON.stringify(answer).slice(0, 500)}`);
  return answer;
}

/** The gaps that the page has of a plan: {least, apart} of all pairs, and without those at rest, metres. */
async function gapsOnPage(request, answer) {
  const shown = new Shown();
  shown.showRequest(request);
  shown.showAnswer(answer, null);
  const signals = new Signals();
  const session = Object.assign(shown, { on: (names, listener) => signals.on(names, listener) });
  const fleet = new FleetMotion(session, async (motions) => clearanceOf(motions, undefined, false));
  const computed = new Promise((resolve) => fleet.onCurve(() => fleet.curve && resolve(fleet.curve)));
  signals.emit("answer");
  const { gap } = await computed;
  const all = clearanceOf([...fleet.byId.values()]);
  return { least: all.gap[all.least], apart: gap.reduce((least, each) => Math.min(least, each), Infinity) };
}

async function assertAgree(request, answer) {
  assert.equal(answer.verified, true);
  const { least, apart } = await gapsOnPage(request, answer);
  assert.ok(Math.abs(least - answer.min_clearance) <= AGREED, `${least} is not ${answer.min_clearance}`);
  assert.ok(apart >= -AGREED, `${apart} is marked as an overlap`);
}

/** The request for a later moment of a plan, in which robots are under way. */
async function laterRequest(request, { plans, makespan }, share) {
  const at = Math.round(makespan * share * 1000) / 1000;
  return ask("v1/advance", { request, plans, at, commit: COMMIT });
}

const { examples } = await ask("v1/examples");

for (const { name } of examples) {
  test(`${name}: the page and the service measure the same gaps`, async () => {
    const request = await ask(`v1/examples/${name}`);
    const answer = await ask("v1/plan", request);
    await assertAgree(request, answer);
    for (const share of LATER) {
      const later = await laterRequest(request, answer, share);
      await assertAgree(later, await ask("v1/plan", later));
    }
  });
}

let seed = 4711;
const random = () => (seed = (seed * 48271) % 2147483647) / 2147483647;
const between = (least, most) => least + (most - least) * random();
const SIZE = 16; // of the hall, metres
const CLOSED = { x: 17.5, y: 17.5 }; // a place to which no way leads
const ROWS = [`${".".repeat(SIZE)}#.`, `${".".repeat(SIZE)}##`, ...Array(SIZE).fill(".".repeat(SIZE + 2))];

const placeOf = (at, y) => ({ x: 1.5 + 4 * (at % 4), y: y + 8 * Math.floor(at / 4) });

const goalOf = (place, accelerates) => ({
  ...place,
  ...(random() < 0.5 ? { service: between(0, 3) } : {}),
  ...(random() < 0.3 ? { not_before: between(0, 12) } : {}),
  ...(random() < 0.4 ? { radius_after: between(0.2, 0.5) } : {}),
  ...(accelerates && random() < 0.4 ? { linear_acceleration_after: between(0.2, 1) } : {}),
});

function robotAt(at, last) {
  const accelerates = random() < 0.8;
  const goals = Array.from({ length: Math.floor(3 * random()) }, () =>
    goalOf({ x: between(1, SIZE - 1), y: between(1, SIZE - 1) }, accelerates),
  );
  return {
    id: `${at}`,
    radius: between(0.2, 0.5),
    linear_speed: between(0.5, 2),
    angular_speed: 1,
    ...(accelerates ? { linear_acceleration: between(0.2, 1) } : {}),
    ...(accelerates && random() < 0.5 ? { linear_deceleration: between(0.2, 1) } : {}),
    start: placeOf(at, 3.5),
    goals: [...goals, goalOf(placeOf(last, 7.5), accelerates)],
  };
}

/** A fleet of robots with goals and loads at random; most of them need time to start and to stop. */
function randomRequest() {
  const shift = Math.floor(8 * random());
  const robots = Array.from({ length: 8 }, (_, at) => robotAt(at, (at * 3 + shift) % 8));
  const options = { invalid_robots: "report", time_budget_ms: 10_000 };
  return { map: { rows: ROWS }, robots, options };
}

/** The answer without the times at which goals are served, which the page then finds in the actions. */
const withoutVisits = (answer) => ({
  ...answer,
  plans: answer.plans.map(({ visits: _, ...plan }) => plan),
});

/** The request with a last goal of a robot that it cannot reach: it only executes what is committed. */
function withoutWay(request, at) {
  const robots = request.robots.map((robot, index) => {
    if (index !== at || !robot.goals) return robot;
    return { ...robot, goals: [...robot.goals.slice(0, -1), CLOSED], previous: undefined };
  });
  return { ...request, robots };
}

test("random fleets with loads: the page and the service measure the same gaps, with visits and without", async () => {
  let unplanned = 0;
  for (let fleet = 0; fleet < 20; fleet += 1) {
    let request = randomRequest();
    for (let round = 0; round < 4; round += 1) {
      const answer = await ask("v1/plan", request);
      await assertAgree(request, answer);
      await assertAgree(request, withoutVisits(answer));
      unplanned += answer.unplanned.filter(({ actions }) => actions?.length > 0).length;
      request = withoutWay(await laterRequest(request, answer, 0.2), fleet % 8);
    }
  }
  assert.ok(unplanned > 0, "no robot without a plan executes what is committed");
});

test("runs of simulations: the page and the service measure the same gaps, overlaps as well", async () => {
  const form = { ...FIRST_FORM, runs: 1, stops: 600, policy: "open_loop" };
  let overlaps = 0;
  for (const each of ["forklifts", "warehouse-inertia", null, null, null, null]) {
    const request = each === null ? randomRequest() : await ask(`v1/examples/${each}`);
    const answer = await ask("v1/plan", request);
    const { trace } = await ask("v1/simulate", simulationOf(request, answer, form, undefined, 0));
    const run = answerOfRun(answer, trace);
    const check = await ask("v1/validate", planFile(request, run));
    const { least } = await gapsOnPage(request, run);
    assert.ok(Math.abs(least - check.min_clearance) <= AGREED, `${least} is not ${check.min_clearance}`);
    overlaps += check.min_clearance < 0 ? 1 : 0;
  }
  assert.ok(overlaps > 0);
});
