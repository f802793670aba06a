// Checks the dashboard of Grafana: its layout, its queries with promtool, and its series against a running server.

import assert from "node:assert/strict";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";

import { promtool, textOf, yamlOf } from "./support/files.js";
import { metricsOfServer, seriesIn } from "./support/metrics.js";

const dashboard = JSON.parse(textOf("deploy/grafana/dashboard.json"));
const { panels, templating } = dashboard;
const charts = panels.filter(({ type }) => type !== "row");
const expressions = charts.flatMap(({ targets }) => targets.map(({ expr }) => expr));

/** An expression as Prometheus gets it: with the values that Grafana puts in place of variables. */
function filledIn(expression) {
  const values = { job: "fleetplan", instance: ".*", __rate_interval: "1m" };
  return expression.replaceAll(
    /\$(\w+)/g,
    (whole, name) => values[name] ?? assert.fail(`${whole} in ${expression}`),
  );
}

test("Grafana can load the dashboard", () => {
  assert.ok(Number.isInteger(dashboard.schemaVersion) && dashboard.schemaVersion >= 36);
  assert.ok(dashboard.title && dashboard.uid);
  const variables = templating.list.map(({ name }) => name);
  assert.deepEqual(variables, ["datasource", "job", "instance"]);
  for (const { title, datasource } of charts) assert.equal(datasource.uid, "${datasource}", title);
  const [{ job_name: job }] = yamlOf("deploy/prometheus/prometheus.yml").scrape_configs;
  assert.equal(templating.list[1].current.value, job);
});

test("every chart has a title of its own, a description, a unit and queries", () => {
  assert.equal(new Set(panels.map(({ id }) => id)).size, panels.length);
  assert.equal(new Set(panels.map(({ title }) => title)).size, panels.length);
  assert.ok(charts.length > 10);
  for (const { title, description, fieldConfig, targets } of charts) {
    assert.ok(description && fieldConfig.defaults.unit && targets.length > 0, title);
    assert.equal(new Set(targets.map(({ refId }) => refId)).size, targets.length, title);
  }
});

test("panels lie in the grid and do not overlap", () => {
  const taken = new Set();
  for (const { title, gridPos } of panels) {
    assert.ok(gridPos.x + gridPos.w <= 24, title);
    for (let x = gridPos.x; x < gridPos.x + gridPos.w; ++x) {
      for (let y = gridPos.y; y < gridPos.y + gridPos.h; ++y) {
        assert.ok(!taken.has(`${x} ${y}`), title);
        taken.add(`${x} ${y}`);
      }
    }
  }
});

test("promtool accepts the queries", () => {
  const folder = mkdtempSync(join(tmpdir(), "dashboard-"));
  try {
    const rules = expressions.map((expr, i) => ({ record: `query:${i}`, expr: filledIn(expr) }));
    const file = join(folder, "rules.json"); // JSON is YAML
    writeFileSync(file, JSON.stringify({ groups: [{ name: "queries", rules }] }));
    promtool("check", "rules", file);
  } finally {
    rmSync(folder, { recursive: true });
  }
});

test("the queries use series that the server has", async () => {
  const metrics = await metricsOfServer();
  for (const series of expressions.flatMap(seriesIn)) {
    const name = series.replace(/\{.*/, "");
    assert.ok(metrics.has(name), name);
  }
});

test("everything that causes an alert is on the dashboard", () => {
  const metricOf = (series) => series.replace(/\{.*/, "").replace(/_(bucket|count|sum)$/, "");
  const shown = new Set(expressions.flatMap(seriesIn).map(metricOf));
  const rules = yamlOf("deploy/prometheus/alerts.yml").groups.flatMap((group) => group.rules);
  for (const metric of rules.flatMap(({ expr }) => seriesIn(expr)).map(metricOf)) {
    assert.ok(shown.has(metric) || metric === "process_start_time_seconds", metric);
  }
});
