// A plan as a stream of events: each event matches the document, and the last one is the answer.

import assert from "node:assert/strict";
import { test } from "node:test";

import { openSession } from "./support/session.js";

const { client } = await openSession();
const EVENTS = { Accept: "text/event-stream" };

const example = async (name) => (await client.get(`/v1/examples/${name}`)).json;
const withoutRunDetails = ({ timings_ms, request_id, ...rest }) => rest;

test("a long-running plan sends its progress, better plans and the answer", async () => {
  const request = await example("warehouse");
  request.options = { ...request.options, mode: "anytime", max_iterations: null, time_budget_ms: 2500 };
  const { status, events } = await client.post("/v1/plan", request, EVENTS);
  assert.equal(status, 200);
  const kinds = events.map(({ event }) => event);
  assert.ok(kinds.filter((kind) => kind === "progress").length >= 4, kinds.join(" "));
  assert.equal(kinds.at(-1), "plan");
  assert.equal(kinds.filter((kind) => ["plan", "problem"].includes(kind)).length, 1);

  const progress = events.filter(({ event }) => event === "progress").map(({ data }) => data);
  for (const { planned, robots } of progress)
    assert.ok(planned <= robots && robots === request.robots.length);
  const elapsed = progress.map(({ elapsed_ms }) => elapsed_ms);
  assert.deepEqual(
    elapsed,
    [...elapsed].sort((a, b) => a - b),
  );

  const answers = events.filter(({ event }) => event !== "progress");
  const flowtimes = answers.map(({ data }) => data.flowtime);
  assert.deepEqual(
    flowtimes,
    [...flowtimes].sort((a, b) => b - a),
  );
  for (const { data } of answers) {
    const verdict = await client.post("/v1/validate", { ...request, ...data });
    assert.deepEqual(verdict.json.violations, []);
  }
});

test("the last event equals the answer without events", async () => {
  const request = await example("corridor-swap");
  const { events } = await client.post("/v1/plan", request, EVENTS);
  const { json } = await client.post("/v1/plan", request);
  assert.deepEqual(withoutRunDetails(events.at(-1).data), withoutRunDetails(json));
});

test("faults found before planning are ordinary answers", async () => {
  for (const [body, status] of [
    ["{", 400],
    [{}, 422],
  ]) {
    const answer = await client.post("/v1/plan", body, EVENTS);
    assert.equal(answer.status, status);
    assert.equal(answer.headers["content-type"], "application/problem+json");
  }
});
