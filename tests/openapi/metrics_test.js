// GET /metrics in the format of Prometheus, checked by promtool.

import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { test } from "node:test";

import { openSession } from "./support/session.js";

const { document, client } = await openSession();

test("promtool accepts the metrics of a service in use", async () => {
  const request = (await client.get("/v1/examples/corridor-swap")).json;
  assert.equal((await client.post("/v1/plan", request)).status, 200);
  assert.equal((await client.get("/v1/nothing")).status, 404);
  const { body } = await client.get("/metrics");
  const check = spawnSync("promtool", ["check", "metrics"], { input: body, encoding: "utf8" });
  assert.ifError(check.error);
  assert.deepEqual([check.status, check.stdout, check.stderr], [0, "", ""]);
});

test("the document's example is part of the metrics of an idle service", async () => {
  const { value } = document.at(["paths", "/metrics", "get", "responses", "200", "content", "text/plain"]);
  const { body } = await client.get("/metrics");
  assert.ok(body.includes(`\n${value.example}`), value.example);
});
