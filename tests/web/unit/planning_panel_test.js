import assert from "node:assert/strict";
import { test } from "node:test";

import { budgetOf, describeProgress } from "../../../web/panels/planning_panel.js";

const LIMITS = { default_budget_ms: 5000, max_budget_ms: 120_000 };

test("the budget is the request's, the service's default, or its limit", () => {
  assert.equal(budgetOf({ options: { time_budget_ms: 1500 } }, LIMITS), 1.5);
  assert.equal(budgetOf({}, LIMITS), 5);
  assert.equal(budgetOf({ options: { time_budget_ms: 1e9 } }, LIMITS), 120);
});

test("an unknown budget is null", () => {
  assert.equal(budgetOf({}, {}), null);
  assert.equal(budgetOf(null, {}), null);
  assert.equal(budgetOf({ options: { time_budget_ms: "long" } }, LIMITS), null);
  assert.equal(budgetOf({ options: { time_budget_ms: 2000 } }, {}), 2);
});

test("progress is described in words, with both costs once there is a plan, its objective first", () => {
  assert.equal(describeProgress({ planned: 1, robots: 1, best: null }, "flowtime"), "1 of 1 robot planned");
  assert.equal(
    describeProgress({ planned: 1200, robots: 2000, best: { flowtime: 12.345, makespan: 3 } }, "flowtime"),
    "1,200 of 2,000 robots planned, flowtime 12.35 s, makespan 3.00 s",
  );
  assert.equal(
    describeProgress({ planned: 2, robots: 2, best: { flowtime: 12, makespan: 3 } }, "makespan"),
    "2 of 2 robots planned, makespan 3.00 s, flowtime 12.00 s",
  );
});
