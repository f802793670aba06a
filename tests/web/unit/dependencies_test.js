import assert from "node:assert/strict";
import { test } from "node:test";

import { dependenciesOfAction, momentOf } from "../../../web/model/dependencies.js";

const place = (robot, action, progress) => ({ robot, action, progress });
const late = { gate: place("b", 2, 0.8), until: place("a", 4, 1), slack: 1 };
const early = { gate: place("b", 2, 0.35), until: place("c", 0, 0.5), slack: 2 };
const given = { gate: place("c", 3, 0), until: place("b", 2, 0.6), slack: 1 };
const other = { gate: place("b", 3, 0.1), until: place("a", 5, 1), slack: 1 };

test("an action waits for others at its gates, in order, and others wait for it", () => {
  const found = dependenciesOfAction([late, early, given, other], "b", 2);
  assert.deepEqual(found, { waitsFor: [early, late], heldFor: [given] });
  assert.deepEqual(dependenciesOfAction([late], "a", 3), { waitsFor: [], heldFor: [] });
});

test("progress is a moment and a place of the plan", () => {
  const at = (x) => ({ x, y: 1, theta: 0 });
  const actions = [
    { type: "wait", t_start: 0, t_end: 2, from: at(0), to: at(0) },
    { type: "translate", t_start: 2, t_end: 6, from: at(0), to: at(8) },
  ];
  assert.deepEqual(momentOf(actions, place("a", 1, 0.25)), { x: 2, y: 1, t: 3 });
  assert.deepEqual(momentOf(actions, place("a", 0, 0.5)), { x: 0, y: 1, t: 1 });
  assert.equal(momentOf(actions, place("a", 2, 0)), null);
});
