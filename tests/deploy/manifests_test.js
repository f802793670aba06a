// Checks deploy/kubernetes against the schemas of Kubernetes, and what no schema covers.

import assert from "node:assert/strict";
import { test } from "node:test";

import {
  bytesOf,
  memoryOfReplica,
  namesIn,
  outputOf,
  settingNames,
  textOf,
  yamlOf,
} from "./support/files.js";
import { metricsOfServer } from "./support/metrics.js";
import { faultsOf, resourcesOf } from "./support/manifests.js";

const BASE = "deploy/kubernetes/base";
const listed = yamlOf(`${BASE}/kustomization.yaml`).resources;
const resources = listed.flatMap((name) => resourcesOf(textOf(`${BASE}/${name}`)));
const named = (kind) => resources.find((resource) => resource.kind === kind);
const deployment = named("Deployment");
const pod = deployment.spec.template;
const [container] = pod.spec.containers;

test("the base lists every file of its folder", () => {
  assert.deepEqual([...listed, "kustomization.yaml"].sort(), namesIn(BASE));
});

test("the base conforms to the schemas", () => {
  assert.deepEqual(faultsOf(resources), []);
});

test("wrong types, unknown members, unknown and incomplete resources are found", () => {
  const misspelt = structuredClone(deployment);
  misspelt.spec.template.spec.containers[0].readinesProbe = {};
  const wrong = structuredClone(named("HorizontalPodAutoscaler"));
  wrong.spec.minReplicas = "3";
  const incomplete = structuredClone(named("Service"));
  delete incomplete.spec.ports[0].port;
  for (const [resource, what] of [
    [misspelt, /Deployment fleetplan: .*readinesProbe/],
    [wrong, /HorizontalPodAutoscaler fleetplan: .*minReplicas must be integer/],
    [incomplete, /Service fleetplan: .*required property port/],
    [{ ...deployment, apiVersion: "apps/v7" }, /there is no Deployment in apps\/v7/],
    [{ ...deployment, kind: "Deploiment" }, /there is no Deploiment in apps\/v1/],
  ]) {
    assert.match(faultsOf([resource]).join("\n"), what);
  }
});

test("everything selects the pods of the deployment", () => {
  const { labels } = pod.metadata;
  assert.deepEqual(deployment.spec.selector.matchLabels, labels);
  assert.deepEqual(named("Service").spec.selector, labels);
  assert.deepEqual(named("PodDisruptionBudget").spec.selector.matchLabels, labels);
  assert.deepEqual(named("NetworkPolicy").spec.podSelector.matchLabels, labels);
  const { kind, name } = named("HorizontalPodAutoscaler").spec.scaleTargetRef;
  assert.deepEqual([kind, name], ["Deployment", deployment.metadata.name]);
});

test("port names refer to ports of the container", () => {
  const names = new Set(container.ports.map((port) => port.name));
  const used = [
    ...named("Service").spec.ports.map((port) => port.targetPort),
    ...named("NetworkPolicy").spec.ingress.flatMap((rule) => rule.ports.map((port) => port.port)),
    ...["startupProbe", "readinessProbe", "livenessProbe"].map((probe) => container[probe].httpGet.port),
  ];
  for (const name of used) assert.ok(names.has(name), name);
});

test("the autoscaler scales by a metric that the adapter makes of one that the server has", async () => {
  const { custom } = yamlOf("deploy/kubernetes/prometheus-adapter.yaml").rules;
  const made = new Map(custom.map(({ name, seriesQuery }) => [name.as, /^\w+/.exec(seriesQuery)[0]]));
  const { text: metrics } = await metricsOfServer();
  for (const { type, pods } of named("HorizontalPodAutoscaler").spec.metrics) {
    assert.equal(type, "Pods");
    const series = made.get(pods.metric.name);
    assert.ok(series, `the adapter does not make ${pods.metric.name}`);
    assert.match(metrics, new RegExp(`^${series} `, "m"));
  }
});

test("the environment of the pods contains only settings, which variables for services cannot overwrite", () => {
  const known = settingNames();
  const overlay = yamlOf("deploy/kubernetes/overlays/example/token.yaml").spec.template.spec.containers[0];
  for (const { name } of [...container.env, ...overlay.env]) assert.ok(known.has(name), name);
  assert.equal(pod.spec.enableServiceLinks, false);
});

test("bodies and plans fit into the memory of a pod", () => {
  const overlay = yamlOf("deploy/kubernetes/overlays/example/larger-replicas.yaml").spec.template.spec
    .containers[0];
  const overlaid = new Map(
    [...container.env, ...overlay.env].map(({ name, value }) => [name, { name, value }]),
  );
  for (const { env, resources } of [
    container,
    { env: [...overlaid.values()], resources: overlay.resources },
  ]) {
    const setting = (name) => env.find((entry) => entry.name === name).value;
    const most = memoryOfReplica({
      workers: Number(resources.limits.cpu),
      maxBody: setting("FLEETPLAN_MAX_BODY"),
      maxPlanMemory: setting("FLEETPLAN_MAX_PLAN_MEMORY"),
      mapCache: setting("FLEETPLAN_MAP_CACHE"),
      maxUnsent: setting("FLEETPLAN_MAX_UNSENT"),
    });
    assert.ok(most <= bytesOf(resources.limits.memory), `${most / 2 ** 20} MiB`);
  }
});

test("pods have more time to stop than delay and drain together", () => {
  const ms = (name) => Number(container.env.find((entry) => entry.name === name).value);
  const drain = ms("FLEETPLAN_DRAIN_DELAY_MS") + ms("FLEETPLAN_DRAIN_MS");
  assert.ok(pod.spec.terminationGracePeriodSeconds * 1000 > drain + 5000);
});

test("the example uses the image of this version", () => {
  const [{ newTag }] = yamlOf("deploy/kubernetes/overlays/example/kustomization.yaml").images;
  assert.equal(`fleetplan ${newTag}`, outputOf("--version").trim());
});
