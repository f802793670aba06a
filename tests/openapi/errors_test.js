// Provokes every error of the table and compares its status, code, header fields and body with the document.

import assert from "node:assert/strict";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, test } from "node:test";
import { gzipSync } from "node:zlib";

import { startService } from "../web/support/service.js";
import { Client } from "./support/client.js";
import { openSession } from "./support/session.js";

const MAX_BODY = 20_000;
const { document, client } = await openSession(["--max-body", String(MAX_BODY), "--read-timeout-ms", "300"]);
const POSTS = ["/v1/plan", "/v1/validate"];
const JSON_FIELDS = "Host: localhost\r\nContent-Type: application/json\r\n";
const seen = new Set();
const texts = new Set();

/** The text of a problem without numbers and without the request's id. */
function textOf({ request_id, ...problem }) {
  return JSON.stringify(problem).replaceAll(/\d+/g, "#");
}

/** Asserts that an answer is a problem with this status and code. */
function expectProblem(answer, status, code) {
  assert.deepEqual([answer.status, answer.json.code], [status, code], answer.body);
  seen.add(code);
  texts.add(textOf(answer.json));
}

/** A request whose planning uses its whole budget. */
const BUSY = {
  map: { rows: Array(12).fill(".".repeat(12)) },
  robot_defaults: { radius: 0.4, linear_speed: 1, angular_speed: 1 },
  robots: Array.from({ length: 10 }, (_, i) => ({
    id: `r${i}`,
    start: { x: 0.5, y: i + 0.5 },
    goal: { x: 11.5, y: 10.5 - i },
  })),
  options: { mode: "anytime", time_budget_ms: 2000 },
};

test("404: unknown paths and examples are not found", async () => {
  expectProblem(await client.get("/v1/nothing"), 404, "not_found");
  expectProblem(await client.get("/v1/examples/corridor"), 404, "not_found");
  expectProblem(await client.post("/v1/plans", {}), 404, "not_found");
});

test("405: every path accepts only its documented methods", async () => {
  for (const [template, operations] of Object.entries(document.root.paths)) {
    const path = template.replace("{name}", "crossing");
    const allowed = operations.post ? ["POST"] : ["GET", "HEAD"];
    for (const method of ["GET", "HEAD", "POST", "PUT", "PATCH", "DELETE", "BREW"]) {
      if (allowed.includes(method) || method === "HEAD") continue;
      const answer = await client.send(method, path);
      expectProblem(answer, 405, "method_not_allowed");
      assert.equal(answer.headers.allow, allowed.join(", "));
    }
  }
});

test("403: a request from a page of another origin is rejected", async () => {
  for (const path of POSTS) {
    for (const Origin of ["https://other.example", "null"]) {
      expectProblem(await client.post(path, {}, { Origin }), 403, "foreign_origin");
    }
  }
});

test("421: a request to a foreign name of a service on loopback is rejected", async () => {
  for (const path of POSTS) {
    expectProblem(await client.post(path, {}, { Host: "rebound.example" }), 421, "wrong_host");
  }
  expectProblem(await client.get("/v1/limits", { Host: "rebound.example:8080" }), 421, "wrong_host");
});

test("406: a plan in an unsupported media type is rejected", async () => {
  for (const accept of ["text/html", "image/*, application/json;q=0", "application/xml"]) {
    expectProblem(await client.post("/v1/plan", BUSY, { Accept: accept }), 406, "not_acceptable");
  }
});

test("408: a head or a body that does not arrive in time is rejected", async () => {
  const head = `POST /v1/plan HTTP/1.1\r\n${JSON_FIELDS}`;
  expectProblem(await client.sendRaw("POST", "/v1/plan", head), 408, "request_timeout");
  const body = `${head}Content-Length: 10\r\n\r\n{`;
  expectProblem(await client.sendRaw("POST", "/v1/plan", body), 408, "request_timeout");
});

test("413: a body that is too large is rejected, declared, in chunks or after decompression", async () => {
  const large = " ".repeat(MAX_BODY + 1);
  for (const path of POSTS) {
    expectProblem(await client.post(path, large), 413, "body_too_large");
    const head = `POST ${path} HTTP/1.1\r\n${JSON_FIELDS}Connection: close\r\nTransfer-Encoding: chunked\r\n\r\n`;
    const chunk = `${large.length.toString(16)}\r\n${large}\r\n0\r\n\r\n`;
    expectProblem(await client.sendRaw("POST", path, head + chunk), 413, "body_too_large");
    const zipped = gzipSync(large);
    expectProblem(await client.post(path, zipped, { "Content-Encoding": "gzip" }), 413, "body_too_large");
  }
});

test("414: a target that is too long is rejected", async () => {
  const query = "x".repeat(9000);
  for (const path of ["/v1/limits", "/healthz"]) {
    expectProblem(await client.get(`${path}?${query}`), 414, "target_too_long");
  }
});

test("415: a body of another type or coding is rejected", async () => {
  for (const path of POSTS) {
    for (const type of [
      "text/plain",
      "application/x-www-form-urlencoded",
      "application/json; charset=utf-16",
    ]) {
      expectProblem(await client.post(path, "{}", { "Content-Type": type }), 415, "unsupported_media_type");
    }
    const untyped = await client.send("POST", path, { body: "{}" });
    expectProblem(untyped, 415, "unsupported_media_type");
    const coded = await client.post(path, "{}", { "Content-Encoding": "br" });
    expectProblem(coded, 415, "unsupported_media_type");
    assert.equal(coded.headers["accept-encoding"], "gzip");
  }
});

test("431: a head with too many fields or bytes is rejected", async () => {
  const many = Object.fromEntries(Array.from({ length: 120 }, (_, i) => [`X-Field-${i}`, "1"]));
  expectProblem(await client.get("/v1/limits", many), 431, "head_too_large");
  const one = { "X-Long": "x".repeat(40_000) };
  expectProblem(await client.get("/v1/limits", one), 431, "head_too_large");
});

test("400: malformed JSON, framing and gzip, and too deep nesting are rejected", async () => {
  for (const path of POSTS) {
    for (const body of ["", "{", '{"a":NaN}', "{'a':1}", '{"a":1,}', "\u{feff}[1] 2", '"\\ud800"']) {
      expectProblem(await client.post(path, body), 400, "malformed_json");
    }
    expectProblem(await client.post(path, Uint8Array.of(0x22, 0xff, 0x22)), 400, "malformed_json");
    expectProblem(await client.post(path, "[".repeat(33) + "]".repeat(33)), 400, "too_deep");
    expectProblem(await client.post(path, "[".repeat(10_000)), 400, "too_deep");
    expectProblem(await client.post(path, "{}", { "Content-Encoding": "gzip" }), 400, "malformed_request");
    const framing = `${JSON_FIELDS}Content-Length: 2\r\nTransfer-Encoding: chunked`;
    const both = await client.sendRaw("POST", path, `POST ${path} HTTP/1.1\r\n${framing}\r\n\r\n0\r\n\r\n`);
    expectProblem(both, 400, "malformed_request");
  }
  const version = await client.sendRaw("GET", "/v1/limits", "GET /v1/limits HTTP/3.0\r\n\r\n");
  expectProblem(version, 400, "malformed_request");
});

test("422: an invalid request is rejected", async () => {
  for (const path of POSTS) expectProblem(await client.post(path, {}), 422, "invalid_request");
  const robots = [
    { id: "amr-1", linear_speed: 0, start: { x: 3.5, y: 1.5 } },
    { id: "amr-2", radius: 0.2, start: { x: 12, y: 0.5 } },
  ];
  expectProblem(await client.post("/v1/plan", { ...BUSY, robots }), 422, "invalid_request");
});

/** A request with plans of these many robots, which overlap at all times. */
function overlappingPlans(robots) {
  const ids = Array.from({ length: robots }, (_, index) => `r${index}`);
  const [from, to] = [5, 5.005].map((x) => ({ x, y: 5, theta: 0 }));
  const actions = [{ type: "translate", t_start: 0, t_end: 0.01, from, to }];
  return {
    ...BUSY,
    options: { time_budget_ms: 1 },
    robots: ids.map((id) => ({ id, start: from })),
    plans: ids.map((robot) => ({ robot, actions })),
  };
}

test("422: a check that exceeds its time budget is reported", async () => {
  const { client: limited } = await separateService(["--default-budget-ms", "1"]);
  // Small enough to be read without a look at the clock, so that a busy machine does not end that first. The check of
  // so many pairs takes ten times the budget.
  expectProblem(await limited.post("/v1/validate", overlappingPlans(100)), 422, "check_unfinished");
});

test("422: a request that takes too long to read is reported", async () => {
  const { client: limited } = await separateService(["--default-budget-ms", "1"]);
  const actions = Array.from({ length: 2_400_000 }, () => "{}").join();
  const body = `{"map": {"rows": ["."]}, "robots": [], "plans": [{"robot": "a", "actions": [${actions}]}]}`;
  expectProblem(await limited.post("/v1/validate", body), 422, "parse_unfinished");
});

test("422: a request that needs more memory than it is granted is reported", async () => {
  const { client: limited } = await separateService(["--max-plan-memory", "1MiB"]);
  const rows = Array.from({ length: 1000 }, () => ".".repeat(1000));
  for (const path of POSTS) {
    const answer = await limited.post(path, { ...BUSY, map: { rows, resolution: 1 }, plans: [] });
    expectProblem(answer, 422, "memory_exceeded");
  }
});

/** A separate service, which is stopped after the tests at the latest. */
async function separateService(flags) {
  const service = await startService(flags);
  const own = new Client(service.url, document);
  let stopped;
  const stop = () => (stopped ??= service.stop());
  after(async () => {
    own.close();
    await stop();
  });
  return { client: own, stop };
}

test("401: a missing or wrong token is rejected on every path except health and readiness", async () => {
  const folder = mkdtempSync(join(tmpdir(), "openapi-"));
  after(() => rmSync(folder, { recursive: true }));
  const file = join(folder, "token");
  writeFileSync(file, "open-sesame\n");
  const { client: guest } = await separateService(["--auth-token-file", file]);
  for (const [template, operations] of Object.entries(document.root.paths)) {
    const path = template.replace("{name}", "crossing");
    const method = operations.post ? "POST" : "GET";
    const isOpen = operations[method.toLowerCase()].security?.length === 0;
    for (const headers of [{}, { Authorization: "Bearer open-barley" }]) {
      const answer = await guest.send(method, path, { headers });
      if (isOpen) assert.equal(answer.status, 200, path);
      else expectProblem(answer, 401, "unauthorized");
    }
    const basic = `Basic ${Buffer.from("ali:open-sesame").toString("base64")}`;
    for (const Authorization of ["Bearer open-sesame", basic]) {
      const answer = await guest.send(method, path, { headers: { Authorization } });
      assert.notEqual(answer.status, 401, path);
    }
  }
});

test("503: requests are rejected while the queue is full", async () => {
  const { client: busy } = await separateService(["--workers", "1", "--queue", "1"]);
  const answers = await Promise.all(Array.from({ length: 24 }, () => busy.post("/v1/plan", BUSY)));
  const rejected = answers.filter(({ status }) => status !== 200);
  assert.ok(rejected.length > 0 && rejected.length < answers.length, `${rejected.length} were rejected`);
  for (const answer of rejected) expectProblem(answer, 503, "overloaded");
});

test("503: large bodies that exceed the reserved memory are rejected", async () => {
  const flags = ["--workers", "1", "--queue", "0", "--max-body", "1MiB", "--read-timeout-ms", "2000"];
  const { client: busy } = await separateService(flags);
  const head = `POST /v1/plan HTTP/1.1\r\n${JSON_FIELDS}Content-Length: 1000000\r\n\r\n`;
  const unfinished = head + " ".repeat(900_000);
  const sent = Array.from({ length: 16 }, () => busy.sendRaw("POST", "/v1/plan", unfinished));
  const rejected = (await Promise.all(sent)).filter(({ status }) => status !== 408);
  assert.ok(rejected.length > 0 && rejected.length < sent.length, `${rejected.length} were rejected`);
  for (const answer of rejected) expectProblem(answer, 503, "overloaded");
});

test("503: new requests are rejected during shutdown, and running ones are answered", async () => {
  const { client: last, stop } = await separateService([]);
  const running = last.post("/v1/plan", BUSY);
  await new Promise((resolve) => setTimeout(resolve, 300));
  const stopped = stop();
  let ready = await last.get("/readyz");
  while (ready.status === 200) ready = await last.get("/readyz");
  expectProblem(ready, 503, "draining");
  expectProblem(await last.post("/v1/plan", BUSY), 503, "draining");
  expectProblem(await last.post("/v1/validate", {}), 503, "draining");
  assert.equal((await running).status, 200);
  await stopped;
});

test("every error of the table except internal_error was provoked", () => {
  const codes = [...document.problemCodes().keys()].filter((code) => code !== "internal_error");
  assert.deepEqual([...seen].sort(), codes.sort());
});

test("the document's examples equal answers of the service, except for numbers", () => {
  for (const example of document.problems()) {
    if (example.code === "internal_error") continue;
    assert.ok(texts.has(textOf(example)), `not among the answers: ${example.detail}`);
  }
});
