// Checks that deploy/compose.yaml, the Dockerfile and the configuration of HAProxy agree with the server.

import assert from "node:assert/strict";
import { test } from "node:test";

import { bytesOf, memoryOfReplica, outputOf, settingNames, textOf, yamlOf } from "./support/files.js";

const { services } = yamlOf("deploy/compose.yaml");
const replicas = Object.keys(services).filter((name) => name.startsWith("fleetplan"));
const replica = services[replicas[0]];
const dockerfile = textOf("Dockerfile");
const haproxy = textOf("deploy/haproxy/haproxy.cfg");
const prometheus = yamlOf("deploy/prometheus/prometheus.yml");

const MIB = 1 << 20;
const inConfiguration = (pattern) => Number(pattern.exec(haproxy)[1]);

test("every service has limits of memory, threads and log", () => {
  for (const [name, service] of Object.entries(services)) {
    assert.ok(bytesOf(service.mem_limit) > 0, name);
    assert.equal(service.memswap_limit, service.mem_limit, `${name} must not swap`);
    assert.ok(service.pids_limit > 0, name);
    const { "max-size": size, "max-file": files } = service.logging.options;
    assert.ok(bytesOf(size) * Number(files) <= 100 * MIB, name);
  }
});

test("bodies and plans fit into the memory of a replica", () => {
  const {
    FLEETPLAN_MAX_BODY: maxBody,
    FLEETPLAN_MAX_PLAN_MEMORY: maxPlanMemory,
    FLEETPLAN_MAP_CACHE: mapCache,
    FLEETPLAN_MAX_UNSENT: maxUnsent,
  } = replica.environment;
  const most = memoryOfReplica({ workers: replica.cpus, maxBody, maxPlanMemory, mapCache, maxUnsent });
  assert.ok(most <= bytesOf(replica.mem_limit), `${most / MIB} MiB`);
});

test("a replica may have a thread for each of its connections", () => {
  const [, connections] = /--connections \D*(\d+)/.exec(outputOf("--help"));
  assert.ok(replica.pids_limit > Number(connections) + 100);
});

test("the buffers of the balancer's connections fit into its memory", () => {
  const buffers = 2 * inConfiguration(/^ {2}maxconn (\d+)$/m) * inConfiguration(/^ {2}tune\.bufsize (\d+)$/m);
  assert.ok(bytesOf(services.balancer.mem_limit) > buffers + 200 * MIB);
});

test("the label of the image has the version", () => {
  const [, version] = /image\.version="([^"]*)"/.exec(dockerfile);
  assert.equal(`fleetplan ${version}`, outputOf("--version").trim());
});

test("the environments contain only settings", () => {
  const known = settingNames();
  const inImage = dockerfile.match(/^ENV .*$/m)[0].match(/FLEETPLAN_[A-Z_]+/g);
  for (const name of [...inImage, ...Object.keys(replica.environment)]) assert.ok(known.has(name), name);
});

test("the balancer and Prometheus know the same replicas as the stack", () => {
  const balanced = [...haproxy.matchAll(/^ {2}server (\S+) (\S+):8080$/gm)].map(([, name, host]) => {
    assert.equal(name, host);
    return name;
  });
  assert.deepEqual(balanced, replicas);
  const { targets } = prometheus.scrape_configs.find(({ job_name: name }) => name === "fleetplan")
    .static_configs[0];
  assert.deepEqual(
    targets,
    replicas.map((name) => `${name}:8081`),
  );
});

test("replicas have more time to stop than delay and drain together", () => {
  const { FLEETPLAN_DRAIN_DELAY_MS: delay, FLEETPLAN_DRAIN_MS: drain } = replica.environment;
  assert.ok(Number.parseInt(replica.stop_grace_period, 10) * 1000 > delay + drain + 5000);
});

test("the balancer waits longer than the longest plan", () => {
  const [, seconds] = /^ {2}timeout server (\d+)s$/m.exec(haproxy);
  const [, longest] = /--max-budget-ms \D*(\d+)/.exec(outputOf("--help"));
  assert.ok(Number(seconds) * 1000 > Number(longest));
});
