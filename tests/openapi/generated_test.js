// Valid and invalid requests of every POST endpoint, generated from the document's schemas and from plans that the
// service makes. Every request gets a documented answer other than 500, in time, and the service accepts and rejects
// as the schemas do. FLEETPLAN_RUNS sets the number of requests of each kind, FLEETPLAN_SEED the seed.

import assert from "node:assert/strict";
import { test } from "node:test";
import fc from "fast-check";

import { cpuWaits } from "../web/support/service.js";
import { valuesOfComponent } from "./support/arbitraries.js";
import { Executions, plannedFleets } from "./support/executions.js";
import { plausiblePlans, plausibleRequests, usualRequests } from "./support/fleets.js";
import { mutatedBytes, mutatedValues } from "./support/mutations.js";
import { misplaced } from "./support/pointer.js";
import { openSession } from "./support/session.js";
import { parsed, textOf } from "./support/text.js";

const RUNS = Number(process.env.FLEETPLAN_RUNS ?? 300);
const SEED = Number(process.env.FLEETPLAN_SEED ?? 2019);
const MAX_DEPTH = 32;
const DEFAULT_BUDGET_MS = 20;
const MAX_BUDGET_MS = 1000;
/** Beyond its budget, and while threads waited for a CPU, an answer may take this long. */
const BUSY_MACHINE_MS = 1500;
/** Each fleet is planned once, and used by many requests. */
const FLEETS = Math.ceil(Math.min(1000, Math.max(80, RUNS / 10)));

/** Matches pointers that match one of these patterns. */
function anyOf(...patterns) {
  return new RegExp(`^(${patterns.join("|")})$`);
}

/** Faults that no schema can express, with the places where they may occur. */
const BEYOND_SCHEMA = {
  duplicate: /^/, // ids, plans for one robot; keys, which a schema never sees
  unknown_robot: anyOf(
    "/(plans|states|progress|poses|holds|goals|base)/\\d+/robot",
    "/messages/\\d+/serialNumber",
    "/dependencies/\\d+/(gate|until)/robot",
    "/unavoidable/\\d+/robots?(/\\d)?",
    "/zones/\\d+/robots/\\d+",
    "/tasks/\\d+/robots/\\d+",
  ),
  empty: /^\/disturbance$/, // nothing is disturbed
  bad_map_row: /^\/map\/rows\/\d+$/, // rows of different lengths
  bad_image: /^(\/map\/image|\/zones\/\d+\/mask)\/(pgm|png)$/,
  bad_movingai: /^\/map\/movingai$/,
  bad_polygon: /^\/zones\/\d+\/polygon(\/\d+)?$/,
  wrong_size: /^(\/map\/occupancy_grid\/data|\/zones\/\d+\/mask)$/, // of another number of cells
  out_of_range: anyOf(
    // settings of the server; sizes in metres; order; numbers of actions, nodes and runs; numbers beyond doubles
    "/map/(rows|movingai|resolution)",
    "/map/image/(pgm|png|resolution|origin/2|occupied_thresh|free_thresh)",
    "/zones/\\d+/mask(/(pgm|png|origin/2|occupied_thresh|free_thresh))?",
    "/map/occupancy_grid/info/(width|resolution|origin/orientation)",
    "/options/lattice_spacing",
    "/robots",
    "/obstacles/\\d+/motion/\\d+/t",
    "/disturbance/(speed|turn|start_delay)/max",
    "/trace",
    "/(runs|aim)", // fewer than the aim needs
    "/try/(interval_margin|inflation|wait_before_move)(/\\d+)?", // lists that do not ascend
    "/try", // too many combinations
    "/plans/\\d+/visits/\\d+/(choice|place)", // of another goal
    "(/robots/\\d+/goal(s/\\d+)?|/(goals|tasks)/\\d+/goals/\\d+)/(choice|place)", // of no pose of any_of; beyond the tolerance
    "(/robots?(/\\d+(/goal(s/\\d+)?)?)?|/(goals|tasks)/\\d+/goals/\\d+)?/metadata",
    "(/robots/\\d+/goal(s/\\d+)?|/(goals|tasks)/\\d+/goals/\\d+)/(actions|service|due|linear_(acc|dec)eleration_after)", // actions need a service; due before not_before; loads of robots without accelerations
    "/states/\\d+/released(/action)?", // behind the robot
    "/base/\\d+/order/nodes", // of which none is released
    "/release_ahead", // of plans that would have too many nodes
    "/timestamp", // a time with an offset
    "/(states|progress)/\\d+/action",
    "/progress/\\d+/last_released_sequence_id",
  ),
  // of a policy, of an order
  missing: anyOf(
    "/(max_delay|dependencies|progress/\\d+/(order_update_id|last_released_sequence_id))",
    "/states/\\d+/[xy]", // of a measured pose
    "(/robots/\\d+/goal(s/\\d+)?|/(goals|tasks)/\\d+/goals/\\d+)/service", // of actions
  ),
  wrong_type: /^\/dependencies$/, // null, with the policy that needs them
  unknown_value: /^\/progress\/\d+\/order_id$/, // of an order that differs from the order of base
  // `goal` of an action that is no wait; `reverse` of an action that is no translation; serial number of no robot; what
  // is left of no service; waits that a policy does not have
  unknown_key:
    /\/((committed|previous|actions)\/\d+\/(goal|reverse|profile)|(serial_numbers|map_ids|manufacturers)\/[^/]*|states\/\d+\/service_left|try\/wait_before_move)$/,
  unknown_obstacle: /^\/unavoidable\/\d+\/obstacle$/,
  discontinuity: /^\/(robots\/\d+\/(committed|previous)|plans\/\d+\/actions)\/\d+\/\w+$/,
  speed: anyOf(
    "/(robots/\\d+/(committed|previous)|plans/\\d+/actions)/\\d+(/reverse)?",
    "/obstacles/\\d+/motion/\\d+",
  ),
  // speeds that do not fit the action, the robot or their neighbours
  profile: anyOf(
    "(/robots/\\d+/(committed|previous)|/plans/\\d+/actions)/\\d+(/profile(/start)?)?",
    "/robots/\\d+/(committed|previous|start/speed)",
  ),
  committed_collision: /^\/robots\/\d+\/committed\/\d+$/,
  committed_in_zone: /^\/robots\/\d+\/committed\/\d+$/,
  start_in_obstacle: /^\/(robots\/\d+\/start|from\/\d+)$/,
  // of a robot that returns to its start, where it overlaps a wall by no more than start_overlap
  goal_in_obstacle: /^\/(robots\/\d+\/(start|goal(s\/\d+)?(\/any_of)?)|to\/\d+)$/,
  starts_overlap: /^\/robots\/\d+\/start$/,
  goals_overlap: /^\/robots\/\d+\/(start|goal(s\/\d+)?(\/any_of)?)$/,
  dependency: /^\/dependencies\/\d+(\/slack|\/(gate|until)\/\w+)?$/,
  invalid_plan: /^\/(plans\/\d+(\/actions\/\d+)?|robots\/\d+)$/,
};

const { document, client, service } = await openSession([
  ...["--default-budget-ms", `${DEFAULT_BUDGET_MS}`],
  ...["--max-budget-ms", `${MAX_BUDGET_MS}`],
]);
const executions = new Executions(
  document,
  await plannedFleets(client, usualRequests(document), FLEETS, SEED),
);

/**
 * For each endpoint: the schema of its requests; requests of every possible kind; requests that it has to accept, if
 * they differ from these. Also the conditions for an answer 200, and for an answer to a request that it has to accept.
 */
const KINDS = {
  "/v1/plan": {
    component: "PlanRequest",
    plausible: plausibleRequests(document),
    acceptable: executions.requests(),
    sound: expectSound,
  },
  "/v1/validate": {
    component: "ValidateRequest",
    plausible: plausiblePlans(document),
    acceptable: executions.checks(),
    promised: ({ json }) => assert.deepEqual(json.violations, []),
  },
  "/v1/dependencies": { component: "ValidateRequest", acceptable: executions.checks() },
  "/v1/simulate": { component: "SimulateRequest", acceptable: executions.simulations() },
  "/v1/margins": {
    component: "MarginsRequest",
    acceptable: executions.margins(),
    within: "/request",
    sound: expectTheTest,
  },
  "/v1/retime": { component: "RetimeRequest", acceptable: executions.retimings() },
  "/v1/matrix": { component: "MatrixRequest", acceptable: executions.matrices(), sound: expectWhole },
  "/v1/assign": {
    component: "AssignRequest",
    acceptable: executions.assignments(),
    within: "/request",
    sound: expectEachTaskOnce,
  },
  "/v1/export/vda5050": { component: "Vda5050Request", acceptable: executions.orders() },
  "/v1/import/vda5050": { component: "Vda5050Import", acceptable: executions.reports() },
  "/v1/advance": {
    component: "AdvanceRequest",
    acceptable: executions.moments(),
    within: "/request", // where the faults of the fleet are
    promised: expectPlannable,
  },
};

/** Problems that a time budget may cause where all else is right, on a machine that is very busy. */
const UNFINISHED = {
  check_unfinished: [
    "/v1/validate",
    "/v1/dependencies",
    "/v1/simulate",
    "/v1/margins",
    "/v1/matrix",
    "/v1/assign",
  ],
  parse_unfinished: Object.keys(KINDS),
};

/** The statuses that the document allows for these bytes; for JSON also the value and whether it fits the schema. */
function expectation(component, bytes) {
  const json = parsed(bytes);
  if (json === undefined || json.depth > MAX_DEPTH) return { statuses: [400] };
  const fits = document.faultsOfComponent(component, json.value).length === 0;
  return { value: json.value, fits, statuses: fits ? [200, 422] : [422] };
}

/** `within`: the place of the fleet. */
function expectPlausibleFaults(errors, { value, fits }, within) {
  assert.ok(errors.length > 0);
  const repeated = errors.some(({ code, pointer }) => code === "duplicate" && !/\/(id|robot)$/.test(pointer));
  for (const fault of errors) {
    // Of members with one key the service reads the first, JSON.parse the last.
    if (!repeated) assert.equal(misplaced(fault, value), undefined);
    if (!fits) continue;
    const places = BEYOND_SCHEMA[fault.code];
    const pointer = fault.pointer.startsWith(`${within}/`)
      ? fault.pointer.slice(within.length)
      : fault.pointer;
    assert.ok(places?.test(pointer), `the schema does not report: ${JSON.stringify(fault)}`);
  }
}

/** Every cost is at least its lower bound; the answer's bounds are their sum and maximum. */
function expectBounded({ plans, lower_bound }) {
  for (const plan of plans) assert.ok(plan.lower_bound <= plan.cost, JSON.stringify(plan));
  const bounds = plans.map((plan) => plan.lower_bound);
  assert.equal(
    lower_bound.flowtime,
    bounds.reduce((sum, bound) => sum + bound, 0),
  );
  assert.equal(lower_bound.makespan, Math.max(0, ...bounds));
}

/** A plan for a valid request is complete, in order, bounded, and valid according to /v1/validate. */
async function expectSound({ options = {}, unavoidable: earlier, ...fleet }, answer) {
  const planned = answer.plans.map(({ robot }) => robot);
  const all = fleet.robots.map(({ id }) => id);
  const unplanned = answer.unplanned.map(({ robot }) => robot);
  assert.deepEqual([...planned, ...unplanned].sort(), [...all].sort());
  assert.deepEqual(
    planned,
    all.filter((id) => planned.includes(id)),
  );
  expectBounded(answer);
  const { start_overlap, goal_overlap, invalid_robots, horizon } = options; // what the check depends on
  const verdict = await client.post("/v1/validate", {
    ...fleet,
    ...answer,
    options: { start_overlap, goal_overlap, invalid_robots, horizon, time_budget_ms: 1000 },
  });
  assert.deepEqual(verdict.json.violations, []);
}

/** The answer at the end of a stream of events. */
function lastOf(events) {
  const { event, data } = events.at(-1);
  if (event === "problem") assert.ok(data.code in UNFINISHED, JSON.stringify(data));
  return data;
}

/** The request of a later moment can be planned, unless its budget is spent before. */
async function expectPlannable({ body }) {
  const { status, json } = await client.post("/v1/plan", body);
  if (!UNFINISHED[json.code]?.includes("/v1/plan"))
    assert.equal(status, 200, `${JSON.stringify(json)} to ${body}`);
}

/** A matrix has a row for each pose of `from`, and in it a number for each pose of `to`. */
function expectWhole({ from, to }, { seconds, metres }) {
  for (const rows of [seconds, metres]) {
    assert.equal(rows.length, from.length);
    for (const row of rows) assert.equal(row.length, to.length);
  }
}

/** Each task is in one of the lists, and no robot has two. */
function expectEachTaskOnce({ tasks }, { assigned, unassigned }) {
  const told = [...assigned, ...unassigned].map(({ task }) => task);
  assert.deepEqual(told.sort(), tasks.map(({ id }) => id).sort());
  assert.equal(new Set(assigned.map(({ robot }) => robot)).size, assigned.length);
}

/** The best candidate is met and has the plan; each share is within its interval. */
function expectTheTest(_request, { met, best, plan, tried }) {
  assert.equal(met, best !== null);
  assert.equal(met, plan !== null);
  if (met) assert.equal(tried[best].status, "met");
  for (const { runs, bad, share, share_low, share_high } of tried.filter(({ runs }) => runs > 0)) {
    assert.equal(share, bad / runs);
    assert.ok(share_low <= share && share <= share_high);
  }
}

/** The milliseconds that the service may take for a request. */
function budgetOf(value) {
  const given = (value?.request ?? value)?.options?.time_budget_ms;
  return given >= DEFAULT_BUDGET_MS ? Math.min(given, MAX_BUDGET_MS) : DEFAULT_BUDGET_MS;
}

/** How long threads waited for a CPU since then, in milliseconds: that is the machine's fault. */
function waitedSince(waits) {
  let sum = 0;
  for (const [pid, before] of waits) {
    for (const [thread, waited] of cpuWaits(pid)) sum += waited - (before.get(thread) ?? 0);
  }
  return sum;
}

/** Sends bytes and compares the answer, which the client has checked against the document, with the expectation. */
async function checkAnswer(path, bytes, { accepts = false, headers = {} }, counts) {
  const { component, within = "", sound, promised } = KINDS[path];
  const expected = expectation(component, bytes);
  const waits = [service.pid, process.pid].map((pid) => [pid, cpuWaits(pid)]);
  const answer = await client.post(path, bytes, headers);
  const { status, took_ms, json = lastOf(answer.events) } = answer;
  counts.set(status, (counts.get(status) ?? 0) + 1);
  const most = budgetOf(expected.value) + BUSY_MACHINE_MS;
  const late_ms = took_ms > most ? took_ms - most - waitedSince(waits) : 0;
  assert.ok(late_ms <= 0, `late by ${late_ms} ms: ${took_ms} ms, ${most} expected; ${status}`);
  assert.ok(
    expected.statuses.includes(status),
    `${status} instead of ${expected.statuses}: ${JSON.stringify(json)}`,
  );
  if (UNFINISHED[json?.code]?.includes(path)) return;
  if (status === 422) expectPlausibleFaults(json.errors, expected, within);
  if (accepts) assert.equal(status, 200, JSON.stringify(json));
  if (status === 200) await sound?.(expected.value, json);
  if (accepts) await promised?.(answer);
}

/**
 * Sends many requests; each of the statuses must occur in at least a tenth of the answers. `how`: whether all of them
 * have to be accepted, and header fields.
 */
function property(name, path, requests, statuses, how = {}) {
  test(`${path}: ${name}`, async (t) => {
    const counts = new Map();
    const check = fc.asyncProperty(requests, (bytes) => checkAnswer(path, Buffer.from(bytes), how, counts));
    await fc.assert(check, { numRuns: RUNS, seed: SEED, includeErrorInReport: true });
    t.diagnostic(`seed ${SEED}, ${[...counts].map(([status, count]) => `${count} x ${status}`).join(", ")}`);
    for (const status of statuses) assert.ok(counts.get(status) >= RUNS / 10, `too few answers ${status}`);
  });
}

for (const [path, { component, plausible, acceptable }] of Object.entries(KINDS)) {
  const raw = valuesOfComponent(document, component);
  const any = plausible ? fc.oneof(plausible, acceptable) : acceptable;
  property("requests about plans of the service are served", path, acceptable.map(textOf), [200], {
    accepts: true,
  });
  if (plausible) property("plausible requests are served", path, plausible.map(textOf), [200]);
  property("requests of any values that fit the schema are answered as documented", path, raw.map(textOf), [
    422,
  ]);
  property(
    "requests that are invalid at one place are rejected with a pointer to it",
    path,
    mutatedValues(any),
    [400, 422],
  );
  property("requests with modified bytes are rejected", path, mutatedBytes(any), [400]);
}

const EVENTS = { accepts: true, headers: { Accept: "text/event-stream" } };
for (const path of ["/v1/plan", "/v1/simulate", "/v1/margins"])
  property("requests are served with events", path, KINDS[path].acceptable.map(textOf), [200], EVENTS);
