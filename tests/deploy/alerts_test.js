// Checks the configuration and alert rules of Prometheus with promtool, and against the metrics of a running server.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { fileURLToPath } from "node:url";

import { pathOf, promtool, yamlOf } from "./support/files.js";
import { metricsOfServer, seriesIn } from "./support/metrics.js";

const RULES = "deploy/prometheus/alerts.yml";
const rules = yamlOf(RULES).groups.flatMap((group) => group.rules);

test("promtool accepts the configuration and the rules", () => {
  promtool("check", "config", pathOf("deploy/prometheus/prometheus.yml"));
  promtool("check", "rules", "--lint-fatal", pathOf(RULES));
});

test("the alerts fire when they should, and only then", () => {
  promtool("test", "rules", fileURLToPath(new URL("alerts_test.yml", import.meta.url)));
});

test("every alert has a severity, a summary and a description", () => {
  for (const { alert, labels, annotations } of rules) {
    assert.match(labels.severity, /^(warning|critical)$/, alert);
    assert.ok(annotations.summary && annotations.description, alert);
  }
});

test("shares of requests count the routes that do work, and only those", () => {
  const document = JSON.parse(readFileSync(pathOf("api/openapi.json"), "utf8"));
  const selected = [RULES, "deploy/grafana/dashboard.json"].flatMap((file) =>
    [...readFileSync(pathOf(file), "utf8").matchAll(/route=~\\?"([^"\\]+)\\?"/g)].map(([, routes]) => routes),
  );
  assert.ok(selected.length >= 5);
  for (const routes of selected) {
    for (const [path, methods] of Object.entries(document.paths)) {
      assert.equal(new RegExp(`^(?:${routes})$`).test(path), "post" in methods, `${routes}: ${path}`);
    }
  }
});

test("the rules use series that the server has", async () => {
  const metrics = await metricsOfServer();
  const used = rules.flatMap(({ expr }) => seriesIn(expr));
  assert.ok(used.length > 5);
  for (const series of used) assert.ok(metrics.has(series), series);
});
