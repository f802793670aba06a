import assert from "node:assert/strict";
import { test } from "node:test";

import { kindInWords, violationsAt } from "../../../web/model/violations.js";

const motion = (...knots) => ({ radius: 0.5, knots: Float64Array.from(knots) });

test("a kind is told in words, one that is new as it came", () => {
  assert.equal(kindInWords("robot_collision"), "Robots collide");
  assert.equal(kindInWords("haunted"), "haunted");
});

test("a violation is seen about its moment", () => {
  const violations = [{ kind: "speed", robots: ["a"], t: 4 }];
  const seen = (time) => violationsAt(violations, time, new Map()).length;
  assert.deepEqual([seen(3.7), seen(3.8), seen(4.2), seen(4.3)], [0, 1, 1, 0]);
});

test("a collision is seen for as long as the two overlap", () => {
  const motions = new Map([
    ["a", motion(0, 0, 0)],
    ["b", motion(0, 5, 0, 10, -5, 0)],
  ]);
  const violations = [{ kind: "robot_collision", robots: ["a", "b"], t: 5 }];
  const seen = (time) => violationsAt(violations, time, motions).length;
  assert.deepEqual([seen(3.9), seen(4.1), seen(5.9), seen(6.1)], [0, 1, 1, 0]);
  assert.equal(
    violationsAt([{ kind: "robot_collision", robots: ["a", "gone"], t: 9 }], 5, motions).length,
    0,
  );
});
