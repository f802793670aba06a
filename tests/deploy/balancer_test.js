// Runs HAProxy with the configuration of deploy/haproxy before replicas that fail as real ones do.

import assert from "node:assert/strict";
import { after, test } from "node:test";

import { startService } from "../web/support/service.js";
import { exchange, startBalancer, startReplica } from "./support/balancer.js";

const cleanups = [];
after(async () => {
  for (const cleanup of cleanups.reverse()) await cleanup();
});

/** A balancer with three replicas; `handles`: one for all, or one for each. */
async function startStack(...handles) {
  const replicas = await Promise.all([0, 1, 2].map((i) => startReplica(handles[i] ?? handles[0])));
  for (const replica of replicas) cleanups.push(replica.close);
  const balancer = await startBalancer(replicas.map(({ port }) => port));
  cleanups.push(balancer.stop);
  const url = new URL("/v1/plan", `http://127.0.0.1:${balancer.port}`);
  const post = (body = "{}", headers = {}) => fetch(url, { method: "POST", body, headers });
  const attempts = () => replicas.reduce((sum, { requests }) => sum + requests.length, 0);
  return { balancer, replicas, post, attempts };
}

function accept(request, body, response) {
  response.setHeader("X-Request-Id", request.headers["x-request-id"]);
  response.end("planned");
}

function refuse(request, body, response) {
  response.statusCode = 503;
  response.end();
}

const endIfDeadly = (request, body, response) =>
  body === "deadly" ? request.socket.destroy() : accept(request, body, response);

test("a request that ends its replica is not sent to another one", async () => {
  const { post, attempts } = await startStack(endIfDeadly);
  const answer = await post("deadly");
  assert.equal(answer.status, 502);
  assert.match(answer.headers.get("X-Request-Id"), /^[0-9a-f-]{36}$/);
  assert.equal(attempts(), 1);
  assert.equal((await post()).status, 200);
});

test("a request that a full replica refuses is sent to another one", async () => {
  const { post, replicas, attempts } = await startStack(refuse, accept, accept);
  for (let i = 0; i < 30; ++i) assert.equal((await post()).status, 200);
  const [full] = replicas;
  assert.ok(full.requests.length > 0, "the full one was never asked");
  assert.equal(attempts(), 30 + full.requests.length);
});

test("a request that a replica refuses to connect for is sent to another one", async () => {
  const { post, replicas } = await startStack(accept);
  replicas[0].close();
  for (let i = 0; i < 6; ++i) assert.equal((await post()).status, 200);
});

test("when all replicas are full, sending again has a budget", async () => {
  const { post, attempts } = await startStack(refuse);
  const requests = 200;
  for (let i = 0; i < requests; ++i) assert.equal((await post()).status, 503);
  assert.ok(attempts() > requests, "nothing was sent again");
  assert.ok(attempts() <= requests + 10, `${attempts()} attempts`);
});

test("a request is sent at most twice", async () => {
  const { post, attempts } = await startStack(refuse);
  assert.equal((await post()).status, 503);
  assert.equal(attempts(), 2);
});

test("the log of the balancer has the id that the replica gets, and the forwarded addresses", async () => {
  const { balancer, post, replicas } = await startStack(accept);
  const received = () => replicas.flatMap(({ requests }) => requests).at(-1).headers;
  const trace = "00-0af7651916cd43dd8448eb211c80319c-b7ad6b7169203331-01";

  const kept = await post("{}", {
    "X-Request-Id": "order-7",
    "X-Forwarded-For": "192.0.2.7",
    traceparent: trace,
  });
  assert.equal(kept.headers.get("X-Request-Id"), "order-7");
  const { "x-request-id": id, "x-forwarded-for": address, traceparent } = received();
  assert.deepEqual([id, address, traceparent], ["order-7", "127.0.0.1", trace]);
  await balancer.logged(`{order-7|192.0.2.7|${trace}}`);

  for (const headers of [
    {},
    { "X-Request-Id": "not an id" },
    [
      ["X-Request-Id", "a"],
      ["X-Request-Id", "b"],
    ],
  ]) {
    const made = (await post("{}", headers)).headers.get("X-Request-Id");
    assert.match(made, /^[0-9a-f-]{36}$/);
    await balancer.logged(`{${made}|`);
  }
});

test("only public paths pass, however they are written", async () => {
  const service = await startService();
  cleanups.push(service.stop);
  const port = Number(new URL(service.url).port);
  const balancer = await startBalancer([port, port, port]);
  cleanups.push(balancer.stop);
  const get = (target) =>
    exchange(balancer.port, `GET ${target} HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n`);

  for (const target of [
    "/metrics",
    "/%6Detrics",
    "/%6detric%73",
    "/metrics?a",
    "/metrics/",
    "//metrics",
    "/./metrics",
    "/v1/../metrics",
    "/v1/%2e%2e/metrics",
    "/v1//metrics",
    "/metrics;a",
    "/metrics#a",
    "/METRICS",
    "http://localhost/metrics",
    "http://localhost/%6Detrics",
  ]) {
    const answer = await get(target);
    assert.match(answer, /^HTTP\/1\.1 40[04] /, target);
    assert.ok(!answer.includes("fleetplan_"), target);
  }

  const page = await (await fetch(service.url)).text();
  const parts = [...page.matchAll(/(?:src|href)="\.?\/?([\w-]+\.\w+)"/g)].map(([, name]) => `/${name}`);
  assert.ok(parts.length > 1);
  const api = ["/v1/limits", "/v1/openapi.json", "/v1/examples", "/v1/examples/hall-100", "/%761/limits"];
  for (const target of ["/", "/?a=b", "/healthz", "/readyz", ...api, ...parts]) {
    assert.match(await get(target), /^HTTP\/1\.1 200 /, target);
  }
});
