import assert from "node:assert/strict";
import { test } from "node:test";

import { advanceGoal, appendGoal, removeGoalAt, setGoal } from "../../../web/model/edit_goals.js";

const at = (x) => ({ x, y: 0.5 });
const REQUEST = {
  robots: [
    { id: "a", start: at(0), goal: at(1) },
    { id: "b", start: at(0), goals: [at(1), { ...at(2), service: 3 }, at(3)] },
  ],
};
const robot = (request, index) => request.robots[index];

test("a second goal turns one goal into a list, and removing it turns it back", () => {
  const two = appendGoal(REQUEST, 0, at(2));
  assert.deepEqual(robot(two, 0), { id: "a", start: at(0), goals: [at(1), at(2)] });
  assert.deepEqual(removeGoalAt(two, 0, 1), REQUEST);
  assert.deepEqual(robot(removeGoalAt(REQUEST, 0, 0), 0), { id: "a", start: at(0) });
  assert.equal(robot(two, 1), REQUEST.robots[1]);
});

test("members of a goal are set and removed", () => {
  const later = setGoal(REQUEST, 1, 1, { not_before: 10, service: undefined });
  assert.deepEqual(robot(later, 1).goals[1], { ...at(2), not_before: 10 });
  assert.deepEqual(robot(setGoal(REQUEST, 0, 0, { service: 2 }), 0).goal, { ...at(1), service: 2 });
});

test("a goal is visited earlier", () => {
  assert.deepEqual(
    robot(advanceGoal(REQUEST, 1, 2), 1).goals.map(({ x }) => x),
    [1, 3, 2],
  );
  assert.equal(advanceGoal(REQUEST, 1, 0), REQUEST);
});
