// Valid and invalid requests generated from the document's schemas. Every request gets a documented answer other than
// 500, and the service accepts and rejects as the schemas do. FLEETPLAN_RUNS sets the number of requests of each kind,
// FLEETPLAN_SEED the seed.

import assert from "node:assert/strict";
import { test } from "node:test";
import fc from "fast-check";

import { plausiblePlans, plausibleRequests, valuesOfComponent } from "./support/arbitraries.js";
import { mutatedBytes, mutatedValues } from "./support/mutations.js";
import { misplaced } from "./support/pointer.js";
import { openSession } from "./support/session.js";
import { parsed, textOf } from "./support/text.js";

const RUNS = Number(process.env.FLEETPLAN_RUNS ?? 1200);
const SEED = Number(process.env.FLEETPLAN_SEED ?? 2019);
const MAX_DEPTH = 32;

/** Matches pointers that match one of these patterns. */
function anyOf(...patterns) {
  return new RegExp(`^(${patterns.join("|")})$`);
}

/** Faults that no schema can express, with the places where they may occur. */
const BEYOND_SCHEMA = {
  duplicate: /^/, // ids, plans for one robot; keys, which a schema never sees
  unknown_robot: /^\/(plans\/\d+\/robot|unavoidable\/\d+\/robots?(\/\d)?|zones\/\d+\/robots\/\d+)$/,
  bad_map_row: /^\/map\/rows\/\d+$/, // rows of different lengths
  bad_image: /^(\/map\/image|\/zones\/\d+\/mask)\/(pgm|png)$/,
  bad_movingai: /^\/map\/movingai$/,
  bad_polygon: /^\/zones\/\d+\/polygon(\/\d+)?$/,
  wrong_size: /^(\/map\/occupancy_grid\/data|\/zones\/\d+\/mask)$/, // of another number of cells
  out_of_range: anyOf(
    // settings of the server; sizes in metres; order
    "/map/(rows|movingai|resolution)",
    "/map/image/(pgm|png|resolution|occupied_thresh|free_thresh)",
    "/zones/\\d+/mask/(pgm|png|occupied_thresh|free_thresh)",
    "/map/occupancy_grid/info/(width|resolution|origin/orientation)",
    "/options/lattice_spacing",
    "/robots",
    "/obstacles/\\d+/motion/\\d+/t",
  ),
  // `goal` of an action that is no wait, `reverse` of one that is no translation
  unknown_key: /\/(committed|previous|actions)\/\d+\/(goal|reverse)$/,
  unknown_obstacle: /^\/unavoidable\/\d+\/obstacle$/,
  discontinuity: /^\/robots\/\d+\/(committed|previous)\/\d+\/\w+$/,
  speed: /^\/(robots\/\d+\/(committed|previous)\/\d+(\/reverse)?|obstacles\/\d+\/motion\/\d+)$/,
  committed_collision: /^\/robots\/\d+\/committed\/\d+$/,
  committed_in_zone: /^\/robots\/\d+\/committed\/\d+$/,
  start_in_obstacle: /^\/robots\/\d+\/start$/,
  goal_in_obstacle: /^\/robots\/\d+\/goal(s\/\d+)?$/,
  starts_overlap: /^\/robots\/\d+\/start$/,
  goals_overlap: /^\/robots\/\d+\/goal(s\/\d+)?$/,
};

const { document, client } = await openSession(["--default-budget-ms", "20", "--max-budget-ms", "1000"]);

const KINDS = {
  "/v1/plan": { component: "PlanRequest", plausible: plausibleRequests(document) },
  "/v1/validate": { component: "ValidateRequest", plausible: plausiblePlans(document) },
};

/** The statuses that the document allows for these bytes; for JSON also the value and whether it fits the schema. */
function expectation(component, bytes) {
  const json = parsed(bytes);
  if (json === undefined || json.depth > MAX_DEPTH) return { statuses: [400] };
  const fits = document.faultsOfComponent(component, json.value).length === 0;
  return { value: json.value, fits, statuses: fits ? [200, 422] : [422] };
}

function expectPlausibleFaults(errors, { value, fits }) {
  assert.ok(errors.length > 0);
  const repeated = errors.some(({ code, pointer }) => code === "duplicate" && !/\/(id|robot)$/.test(pointer));
  for (const fault of errors) {
    // Of members with one key the service reads the first, JSON.parse the last.
    if (!repeated) assert.equal(misplaced(fault, value), undefined);
    if (!fits) continue;
    const places = BEYOND_SCHEMA[fault.code];
    assert.ok(places?.test(fault.pointer), `the schema does not report: ${JSON.stringify(fault)}`);
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
async function expectSound({ options = {}, ...fleet }, answer) {
  const planned = answer.plans.map(({ robot }) => robot);
  const all = fleet.robots.map(({ id }) => id);
  const unplanned = answer.unplanned.map(({ robot }) => robot);
  assert.deepEqual([...planned, ...unplanned].sort(), [...all].sort());
  assert.deepEqual(
    planned,
    all.filter((id) => planned.includes(id)),
  );
  expectBounded(answer);
  const { start_overlap, invalid_robots, horizon } = options; // what the check depends on
  const verdict = await client.post("/v1/validate", {
    ...fleet,
    ...answer,
    options: { start_overlap, invalid_robots, horizon, time_budget_ms: 1000 },
  });
  assert.deepEqual(verdict.json.violations, []);
}

/** The answer at the end of a stream of events. */
function lastOf(events) {
  const { event, data } = events.at(-1);
  assert.equal(event, "plan", JSON.stringify(data));
  return data;
}

/** Sends bytes and compares the answer, which the client has checked against the document, with the expectation. */
async function checkAnswer(path, bytes, counts, headers) {
  const expected = expectation(KINDS[path].component, bytes);
  const { status, json, events } = await client.post(path, bytes, headers);
  counts.set(status, (counts.get(status) ?? 0) + 1);
  assert.ok(
    expected.statuses.includes(status),
    `${status} instead of ${expected.statuses}: ${JSON.stringify(json)}`,
  );
  const isUnfinished = json?.code === "check_unfinished"; // when the machine is very busy
  if (isUnfinished) assert.ok(expected.fits && path === "/v1/validate");
  if (status === 422 && !isUnfinished) expectPlausibleFaults(json.errors, expected);
  if (status === 200 && path === "/v1/plan") await expectSound(expected.value, json ?? lastOf(events));
}

/** Sends many requests; each of the statuses must occur in at least a tenth of the answers. */
function property(name, path, requests, statuses, headers = {}) {
  test(`${path}: ${name}`, async (t) => {
    const counts = new Map();
    const check = fc.asyncProperty(requests, (bytes) =>
      checkAnswer(path, Buffer.from(bytes), counts, headers),
    );
    await fc.assert(check, { numRuns: RUNS, seed: SEED, includeErrorInReport: true });
    t.diagnostic(`seed ${SEED}, ${[...counts].map(([status, count]) => `${count} x ${status}`).join(", ")}`);
    for (const status of statuses) assert.ok(counts.get(status) >= RUNS / 10, `too few answers ${status}`);
  });
}

for (const [path, { component, plausible }] of Object.entries(KINDS)) {
  const raw = valuesOfComponent(document, component);
  property("plausible requests are served", path, plausible.map(textOf), [200]);
  property("requests of any values that fit the schema are answered as documented", path, raw.map(textOf), [
    422,
  ]);
  property(
    "requests that are invalid at one place are rejected with a pointer to it",
    path,
    mutatedValues(plausible),
    [400, 422],
  );
  property("requests with modified bytes are rejected", path, mutatedBytes(plausible), [400]);
}

const plans = KINDS["/v1/plan"].plausible.map(textOf);
property("plausible requests are served with events", "/v1/plan", plans, [200], {
  Accept: "text/event-stream",
});
