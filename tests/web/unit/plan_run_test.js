import assert from "node:assert/strict";
import { test } from "node:test";

import { objectiveOf, PlanRun } from "../../../web/model/plan_run.js";

/** The run's costs after progress with these best costs [flowtime, makespan]. */
function costsOf(objective, best) {
  const run = new PlanRun(null, objective);
  best.forEach(([flowtime, makespan], at) =>
    run.record({ elapsed_ms: at, attempt: 1, planned: 1, robots: 1, best: { flowtime, makespan } }),
  );
  return run.costs.map(({ flowtime, makespan }) => [flowtime, makespan]);
}

test("the objective is the request's, flowtime by default", () => {
  assert.equal(objectiveOf({ options: { objective: "makespan" } }), "makespan");
  assert.equal(objectiveOf({ options: { objective: "other" } }), "flowtime");
  assert.equal(objectiveOf({}), "flowtime");
  assert.equal(objectiveOf(null), "flowtime");
});

test("costs are recorded when the objective falls, whatever the other cost does", () => {
  const best = [
    [11881, 300],
    [12215, 280],
    [12100, 280],
    [12300, 270],
  ];
  assert.deepEqual(costsOf("makespan", best), [best[0], best[1], best[3]]);
  assert.deepEqual(costsOf("flowtime", best), [best[0]]);
});
