import assert from "node:assert/strict";
import { test } from "node:test";

import {
  advanceGoal,
  appendAlternative,
  appendGoal,
  removeAlternative,
  removeGoalAt,
  setAlternative,
  setGoal,
} from "../../../web/model/edit_goals.js";

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

test("a second pose turns a goal into one with alternatives, and removing it turns it back", () => {
  const two = appendAlternative(REQUEST, 1, 1, { ...at(7), theta: 0, bias: 4 });
  assert.deepEqual(robot(two, 1).goals[1], { any_of: [at(2), { ...at(7), theta: 0, bias: 4 }], service: 3 });
  assert.deepEqual(removeAlternative(two, 1, 1, 1), REQUEST);
  assert.deepEqual(robot(removeAlternative(two, 1, 1, 0), 1).goals[1], { ...at(7), theta: 0, service: 3 });
  const three = appendAlternative(two, 1, 1, at(8));
  assert.deepEqual(robot(removeAlternative(three, 1, 1, 1), 1).goals[1], {
    any_of: [at(2), at(8)],
    service: 3,
  });
  assert.equal(robot(two, 0), REQUEST.robots[0]);
});

test("members of an alternative pose are set and removed", () => {
  const two = appendAlternative(REQUEST, 0, 0, { ...at(2), theta: 1 });
  const set = setAlternative(two, 0, 0, 1, { theta: undefined, bias: 2 });
  assert.deepEqual(robot(set, 0).goal, { any_of: [at(1), { ...at(2), bias: 2 }] });
  assert.deepEqual(robot(setAlternative(two, 0, 0, 0, { y: 9 }), 0).goal.any_of[0], { x: 1, y: 9 });
});
