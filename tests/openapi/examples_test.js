// The example requests, the document's examples and the answers to them match the schemas.

import assert from "node:assert/strict";
import { readdirSync, readFileSync } from "node:fs";
import { test } from "node:test";

import { openSession } from "./support/session.js";

const SCENARIOS = new URL("../scenarios/", import.meta.url);
const scenarios = readdirSync(SCENARIOS)
  .filter((file) => file.endsWith(".json") && file !== "index.json")
  .map((file) => file.replace(".json", ""));

const { document, client } = await openSession();
const { paths } = document.root;

/** An answer without the members that differ between runs or with every change of the search. */
function withoutRunDetails({ timings_ms, request_id, search, ...rest }) {
  return rest;
}

test("every scenario is an example request and listed", async () => {
  const list = await client.get("/v1/examples");
  assert.deepEqual(list.json.examples.map(({ name }) => name).sort(), scenarios.sort());
  for (const name of scenarios) {
    const { json } = await client.get(`/v1/examples/${name}`);
    assert.deepEqual(json, JSON.parse(readFileSync(new URL(`${name}.json`, SCENARIOS), "utf8")));
  }
});

for (const name of scenarios) {
  test(`${name}: the request, the answer, and both combined for validation match the schemas`, async () => {
    const request = JSON.parse(readFileSync(new URL(`${name}.json`, SCENARIOS), "utf8"));
    assert.deepEqual(document.faultsOfComponent("PlanRequest", request), []);
    const answer = await client.post("/v1/plan", request);
    assert.equal(answer.status, 200);
    const both = { ...request, ...answer.json };
    assert.deepEqual(document.faultsOfComponent("ValidateRequest", both), []);
    const verdict = await client.post("/v1/validate", both);
    assert.equal(verdict.status, 200);
    assert.equal(verdict.json.valid, true, JSON.stringify(verdict.json.violations));
  });
}

const POSTED = ["plan", "validate", "simulate", "advance", "dependencies", "retime", "matrix", "assign", "export/vda5050", "import/vda5050"];
for (const path of POSTED.map((name) => `/v1/${name}`)) {
  test(`the document's examples for ${path} get the documented answers`, async () => {
    const { requestBody, responses } = paths[path].post;
    const requests = requestBody.content["application/json"].examples;
    const answers = responses["200"].content["application/json"].examples;
    assert.ok(Object.keys(answers).length > 0);
    for (const name of Object.keys(answers)) assert.ok(requests[name], `${name} is not a request`);
    for (const [name, { value }] of Object.entries(requests)) {
      const { status, json } = await client.post(path, value);
      assert.equal(status, 200, name);
      if (answers[name])
        assert.deepEqual(withoutRunDetails(json), withoutRunDetails(answers[name].value), name);
    }
  });
}

test("every path with GET answers GET and HEAD as documented", async () => {
  const traceparent = document.root.components.parameters.TraceParent.example;
  for (const [template, { get }] of Object.entries(paths)) {
    if (get === undefined) continue;
    const path = template.replace("{name}", "corridor-swap");
    const answer = await client.get(path, { "X-Request-Id": "a.b_c-1", traceparent });
    assert.equal(answer.status, 200, path);
    assert.equal(answer.headers["x-request-id"], "a.b_c-1");
    assert.equal(answer.headers.traceparent, traceparent);
    assert.equal((await client.send("HEAD", path)).status, 200, path);
  }
});

test("defaults of the options are those of the service", async () => {
  const request = (await client.get("/v1/examples/corridor-swap")).json;
  const { properties } = document.root.components.schemas.PlanOptions;
  const given = Object.entries(properties).filter(([, option]) => option.default !== undefined);
  const options = Object.fromEntries(given.map(([name, option]) => [name, option.default]));
  assert.equal(given.length, Object.keys(properties).length - 1, "all but the time budget");
  const bare = await client.post("/v1/plan", request);
  const full = await client.post("/v1/plan", { ...request, options });
  assert.deepEqual(withoutRunDetails(full.json), withoutRunDetails(bare.json));
});
