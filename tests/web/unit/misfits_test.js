import assert from "node:assert/strict";
import { test } from "node:test";

import { misfitErrors, standingAtGoals, standingAtStarts } from "../../../web/model/misfits.js";

const [a, b, c] = [
  { id: "a", start: { x: 0.5, y: 0.5 }, goal: { x: 2.5, y: 0.5, theta: 1 } },
  { id: "b", start: { x: 1.5, y: 0.5 } },
  { id: "c", start: { x: 2.5, y: 0.5 }, goal: { x: 0.5, y: 0.5 } },
];
const REQUEST = { map: { rows: ["..."] }, robots: [a, b, c] };

test("robots stand at their starts, and those that have goals at these", () => {
  assert.deepEqual(standingAtStarts(REQUEST), { ...REQUEST, plans: [], tolerance: 1e-9 });
  const { robots, plans } = standingAtGoals(REQUEST);
  assert.deepEqual(
    [robots, plans],
    [
      [
        { ...a, start: a.goal },
        { ...c, start: c.goal },
      ],
      [],
    ],
  );
  assert.equal(standingAtGoals({ ...REQUEST, robots: [b] }), null);
});

test("a robot in a wall is told at its start, or at its goal", () => {
  const violation = { kind: "obstacle_collision", robots: ["c"], distance: 0.1, required: 0.3 };
  const [error] = misfitErrors(REQUEST, [violation], "start");
  assert.equal(error.pointer, "/robots/2/start");
  assert.match(error.detail, /start does not fit: 0.1 m where 0.3 m is needed/);
  assert.equal(misfitErrors(REQUEST, [violation], "goal")[0].pointer, "/robots/2/goal");
});

test("two robots that overlap are told at the later one", () => {
  const violation = { kind: "robot_collision", robots: ["c", "a"], distance: 0.2, required: 0.6 };
  const [error] = misfitErrors(REQUEST, [violation], "goal");
  assert.equal(error.pointer, "/robots/2/goal");
  assert.match(error.detail, /goal overlaps with that of a: 0.2 m where 0.6 m/);
});
