import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { test } from "node:test";

import { belongsTo, isOfAdvance, OF_ANSWERS, planFile, readDocument } from "../../../web/model/plan_file.js";

const pose = (x) => ({ x, y: 0.5, theta: 0 });
const REQUEST = {
  map: { rows: [".."] },
  robot_defaults: { radius: 0.3 },
  robots: [{ id: "a", start: pose(0.5), goal: pose(1.5) }],
  options: { seed: 1 },
};
const ANSWER = {
  status: "solved",
  plans: [
    {
      robot: "a",
      cost: 1,
      actions: [{ type: "translate", t_start: 0, t_end: 1, from: pose(0.5), to: pose(1.5) }],
    },
  ],
  unplanned: [],
  flowtime: 1,
  makespan: 1,
  warnings: [],
};
const changed = (change) => {
  const document = structuredClone(planFile(REQUEST, ANSWER));
  change(document);
  return document;
};

test("a request is recognised, even if it is faulty or only a map", () => {
  assert.deepEqual(readDocument(REQUEST), { request: REQUEST, answer: null });
  for (const document of [{ map: 7 }, { robots: [] }, { map: { rows: ["."] }, status: "x" }])
    assert.equal(readDocument(document).request, document);
});

test("every member of the service's answers is one of an answer", async () => {
  const { schemas } = JSON.parse(
    await readFile(new URL("../../../api/openapi.json", import.meta.url), "utf8"),
  ).components;
  const [answer, request] = ["PlanAnswer", "PlanRequest"].map((name) =>
    Object.keys(schemas[name].properties),
  );
  const both = ["metadata", "unavoidable"]; // the metadata of an answer equal the metadata of its request
  for (const name of answer) {
    assert.equal(request.includes(name), both.includes(name), name);
    assert.equal(Object.hasOwn(OF_ANSWERS, name), name !== "metadata", name);
  }
});

test("dependencies, and pairs without slack, belong to the answer", () => {
  for (const found of [[], null]) {
    const answer = { ...ANSWER, dependencies: found, tight: found };
    assert.deepEqual(readDocument(planFile(REQUEST, answer)), { request: REQUEST, answer });
  }
});

test("a plan file is split into its request and answer", () => {
  assert.deepEqual(readDocument(planFile(REQUEST, ANSWER)), { request: REQUEST, answer: ANSWER });
  const strict = { ...ANSWER, tolerance: 1e-3 };
  assert.deepEqual(readDocument(planFile(REQUEST, strict)), { request: REQUEST, answer: strict });
});

test("a plan file without an answer has an empty list of plans", () => {
  assert.deepEqual(planFile(REQUEST, null), { ...REQUEST, plans: [] });
});

test("costs of an answer are computed from its plans", () => {
  const actions = [{ type: "wait", t_start: 0, t_end: 2.5, from: pose(1.5), to: pose(1.5) }];
  const plans = [
    { robot: "a", cost: 7, actions: ANSWER.plans[0].actions },
    { robot: "b", actions },
    { robot: "c", actions: [] },
  ];
  const { request, answer } = readDocument({ ...REQUEST, plans });
  assert.deepEqual(request, REQUEST);
  assert.deepEqual(
    answer.plans.map(({ cost }) => cost),
    [1, 2.5, 0],
  );
  const { status, flowtime, makespan, unplanned, warnings } = answer;
  assert.deepEqual(
    { status, flowtime, makespan, unplanned, warnings },
    {
      status: "solved",
      flowtime: 3.5,
      makespan: 2.5,
      unplanned: [],
      warnings: [],
    },
  );
  assert.equal(readDocument({ plans: [], unplanned: [{ robot: "a" }] }).answer.status, "none");
  assert.equal(readDocument({ plans, unplanned: [{ robot: "d" }] }).answer.status, "partial");
});

test("unknown members stay in the request, so that the service reports them", () => {
  const { request } = readDocument({ ...planFile(REQUEST, ANSWER), colour: "red" });
  assert.equal(request.colour, "red");
});

test("an answer alone has no request", () => {
  assert.deepEqual(readDocument(ANSWER), { request: null, answer: ANSWER });
});

test("an answer matches a request that has all its robots", () => {
  const { answer } = readDocument(ANSWER);
  assert.equal(belongsTo(answer, REQUEST), true);
  assert.equal(belongsTo(answer, { ...REQUEST, robots: [{ id: "b" }] }), false);
  assert.equal(belongsTo({ plans: [], unplanned: [{ robot: "b" }] }, REQUEST), false);
  assert.equal(belongsTo(answer, { robots: 7 }), false);
  assert.equal(belongsTo(answer, null), false);
});

test("other JSON is rejected with the expected format", () => {
  for (const document of [null, 7, "map", [REQUEST], {}, { type: "Feature" }])
    assert.throws(() => readDocument(document), /neither a request \(with "map" and "robots"\) nor a plan/);
  const problem = { title: "Invalid request", errors: [] };
  assert.throws(() => readDocument(problem), /error of the service: Invalid request/);
});

test("answers that cannot be shown are rejected with the place of the fault", () => {
  const refused = [
    [(document) => (document.plans = {}), /plans is {}, which is not/],
    [(document) => (document.plans = [null]), /plans\[0\].robot is missing/],
    [(document) => document.plans.push(document.plans[0]), /plans\[1\] is a second plan of a/],
    [(document) => (document.plans[0].cost = null), /plans\[0\].cost is null/],
    [(document) => (document.plans[0].lower_bound = "1"), /plans\[0\].lower_bound is "1"/],
    [(document) => (document.plans[0].stuck = "yes"), /plans\[0\].stuck is "yes"/],
    [(document) => (document.plans[0].blocked_by = "b"), /plans\[0\].blocked_by is "b"/],
    [(document) => delete document.plans[0].actions, /plans\[0\].actions is missing/],
    [({ plans }) => (plans[0].actions[0] = 7), /plans\[0\].actions\[0\].type is missing/],
    [({ plans }) => (plans[0].actions[0].type = "fly"), /plans\[0\].actions\[0\].type is "fly"/],
    [({ plans }) => (plans[0].actions[0].t_end = "1"), /plans\[0\].actions\[0\].t_end is "1"/],
    [({ plans }) => delete plans[0].actions[0].to.theta, /plans\[0\].actions\[0\].to is {"x":1.5/],
    [({ plans }) => (plans[0].actions[0].from = null), /plans\[0\].actions\[0\].from is null/],
    [(document) => (document.unplanned = 7), /unplanned is 7/],
    [(document) => (document.unplanned = [{}]), /unplanned\[0\].robot is missing/],
    [(document) => (document.unplanned = [{ robot: "b", blocked_by: "a" }]), /unplanned\[0\].blocked_by/],
    [(document) => (document.warnings = [null]), /warnings is \[null\]/],
    [(document) => (document.flowtime = "long"), /flowtime is "long"/],
    [(document) => (document.lower_bound = { flowtime: 1 }), /lower_bound is {"flowtime":1}/],
  ];
  for (const [change, message] of refused) assert.throws(() => readDocument(changed(change)), message);
});

test("a request of a later moment has a request and its plans, and no map of its own", () => {
  const { plans } = ANSWER;
  assert.ok(isOfAdvance({ request: REQUEST, plans, at: 2, states: [] }));
  for (const other of [REQUEST, ANSWER, planFile(REQUEST, ANSWER), { request: null, plans }, null, []]) {
    assert.equal(isOfAdvance(other), false, JSON.stringify(other));
  }
});
