import assert from "node:assert/strict";
import { test } from "node:test";

import { blockersOf, stuckOf } from "../../../web/model/stuck.js";
import { groupsOf, longerBudget } from "../../../web/panels/unplanned_card.js";

const LIMITS = { max_budget_ms: 60_000 };
const answer = (reason, search = {}) => ({ unplanned: [{ robot: "a", reason }], search });

test("robots without a plan are grouped by reason, the most frequent one first", () => {
  const entry = (robot, reason) => ({ robot, reason });
  const unplanned = [entry("a", "invalid"), entry("b", "goal_blocked"), entry("c", "goal_blocked")];
  assert.deepEqual(groupsOf(unplanned), [
    ["goal_blocked", [unplanned[1], unplanned[2]]],
    ["invalid", [unplanned[0]]],
  ]);
});

test("more time is offered where it may help, up to the limit of the service", () => {
  assert.equal(longerBudget(answer("budget_exhausted"), 5, LIMITS), 20);
  assert.equal(longerBudget(answer("blocked_by_robots"), 5, LIMITS), 20);
  assert.equal(longerBudget(answer("budget_exhausted"), 30, LIMITS), 60);
  assert.equal(longerBudget(answer("budget_exhausted"), 60, LIMITS), null);
  assert.equal(longerBudget(answer("budget_exhausted"), null, LIMITS), null);
  assert.equal(longerBudget(answer("budget_exhausted", { exhausted: true }), 5, LIMITS), null);
  assert.equal(longerBudget(answer("goal_unreachable"), 5, LIMITS), null);
  assert.equal(longerBudget(answer("budget_exhausted"), 5, {}), 20, "before the limits are known");
  assert.equal(
    longerBudget({ unplanned: answer("budget_exhausted").unplanned }, 5, LIMITS),
    null,
    "of a file",
  );
});

test("robots that are stuck are listed with those in their way", () => {
  const plans = [
    { robot: "a", cost: 9, actions: [] },
    { robot: "b", cost: 9, actions: [], stuck: true, blocked_by: ["a"], blocked_by_total: 1 },
  ];
  assert.deepEqual(stuckOf({ plans }), [
    { robot: "b", reason: "stuck", blocked_by: ["a"], blocked_by_total: 1 },
  ]);
  assert.deepEqual(stuckOf(null), []);
});

test("who is in the way of a robot without a plan, or of one that is stuck, is known by its track", () => {
  assert.deepEqual(blockersOf({ unplanned: { blocked_by: ["a"] }, stuck: null }), ["a"]);
  assert.deepEqual(blockersOf({ unplanned: null, stuck: { blocked_by: ["b"] } }), ["b"]);
  assert.deepEqual(blockersOf({ unplanned: null, stuck: null }), []);
  assert.deepEqual(blockersOf(undefined), []);
});
