import assert from "node:assert/strict";
import { test } from "node:test";

import {
  kindInWords,
  placementErrors,
  standingAtGoals,
  standingAtStarts,
  violationsAt,
  watchRequest,
} from "../../../web/model/checks.js";
import { ProblemError } from "../../../web/model/problem.js";
import { Session } from "../../../web/model/session.js";

const motion = (...knots) => ({
  radius: 0.5,
  knots: Float64Array.from(knots),
  ramps: new Float64Array(knots.length / 3),
  radii: [],
});

test("a kind of violation is described in words, an unknown one by its name", () => {
  assert.equal(kindInWords("robot_collision"), "Robots collide");
  assert.equal(kindInWords("haunted"), "haunted");
});

test("a violation is shown around its moment", () => {
  const violations = [{ kind: "speed", robots: ["a"], t: 4 }];
  const seen = (time) => violationsAt(violations, time, new Map()).length;
  assert.deepEqual([seen(3.7), seen(3.8), seen(4.2), seen(4.3)], [0, 1, 1, 0]);
});

test("a collision is shown for as long as the robots overlap", () => {
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

const [a, b, c] = [
  { id: "a", start: { x: 0.5, y: 0.5 }, goal: { x: 2.5, y: 0.5, theta: 1 } },
  { id: "b", start: { x: 1.5, y: 0.5 } },
  { id: "c", start: { x: 2.5, y: 0.5 }, goal: { x: 0.5, y: 0.5 } },
];
const THREE_ROBOTS = { map: { rows: ["..."] }, robots: [a, b, c] };

test("checked robots stand at their starts, or at their goals if they have any", () => {
  assert.deepEqual(standingAtStarts(THREE_ROBOTS), { ...THREE_ROBOTS, plans: [], tolerance: 5e-7 });
  const { robots, plans } = standingAtGoals(THREE_ROBOTS);
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
  assert.equal(standingAtGoals({ ...THREE_ROBOTS, robots: [b] }), null);
});

test("robots stand at their last goals with their last radii", () => {
  const place = { x: 2.5, y: 0.5 };
  const goals = [
    { x: 1.5, y: 0.5, radius_after: 0.4 },
    { ...place, service: 2 },
  ];
  const robot = { id: "a", radius: 0.3, start: { x: 0.5, y: 0.5 } };
  const standing = (list) => standingAtGoals({ robots: [{ ...robot, goals: list }] }).robots[0];
  assert.deepEqual(standing(goals), { ...robot, radius: 0.4, start: place, goal: place });
  const last = { ...place, radius_after: 0.2 };
  assert.deepEqual(standing([goals[0], last]), { ...robot, radius: 0.2, start: place, goal: place });
});

test("only the pose of a goal is a start, and goals at one of several poses are not checked", () => {
  const pose = { x: 2.5, y: 0.5, theta: 1 };
  const robot = { id: "a", radius: 0.3, weight: 2, start: { x: 0.5, y: 0.5 } };
  const request = { robots: [{ ...robot, goal: { ...pose, due: 3, service: 1, not_before: 2 } }] };
  assert.deepEqual(standingAtGoals(request).robots, [{ ...robot, start: pose, goal: pose }]);
  assert.equal(
    standingAtGoals({ robots: [{ ...robot, goal: { any_of: [pose, { ...pose, x: 1 }] } }] }),
    null,
  );
});

test("a robot in a wall is reported at its start or goal", () => {
  const violation = { kind: "obstacle_collision", robots: ["c"], distance: 0.1, required: 0.3 };
  const [error] = placementErrors(THREE_ROBOTS, [violation], "start");
  assert.equal(error.pointer, "/robots/2/start");
  assert.equal(error.detail, "c does not fit at its start: it needs 0.2 m more than is free.");
  assert.equal(placementErrors(THREE_ROBOTS, [violation], "goal")[0].pointer, "/robots/2/goal");
});

test("goals of robots that yield may overlap, starts may not, and walls are in the way of all", () => {
  const violation = { kind: "robot_collision", robots: ["a", "c"], t: 0, distance: 0, required: 0.6 };
  const [a, b, c] = THREE_ROBOTS.robots;
  for (const robots of [
    [{ ...a, idle: "yield" }, b, c],
    [a, b, { ...c, idle: "yield" }],
  ]) {
    const errors = (violation, pose) => placementErrors({ ...THREE_ROBOTS, robots }, [violation], pose);
    assert.deepEqual(errors(violation, "goal"), []);
    assert.equal(errors(violation, "start").length, 1);
    assert.equal(errors({ ...violation, kind: "obstacle_collision", robots: ["a"] }, "goal").length, 1);
  }
  const returning = [a, b, { ...c, idle: "return" }];
  assert.equal(placementErrors({ ...THREE_ROBOTS, robots: returning }, [violation], "goal").length, 1);
});

test("overlapping robots are reported at the later one", () => {
  const violation = { kind: "robot_collision", robots: ["c", "a"], distance: 0.2, required: 0.6 };
  const [error] = placementErrors(THREE_ROBOTS, [violation], "goal");
  assert.equal(error.pointer, "/robots/2/goal");
  assert.equal(error.detail, "c and a overlap at their goals, by 0.4 m.");
});

const ROBOT = { id: "a", radius: 0.3, start: { x: 0.5, y: 0.5 }, goal: { x: 2.5, y: 0.5 } };
const REQUEST = { map: { rows: ["..."] }, robots: [ROBOT] };
const OPENED = { name: "one", example: null, text: JSON.stringify(REQUEST), request: REQUEST };
const FITS = { violations: [] };

/**
 * The problem of a session after an edit has been checked by `validate(number of checks so far)`, and the requests
 * that were checked.
 */
async function afterEdit(validate, request = { ...REQUEST, options: { seed: 1 } }) {
  const { session, checked } = watched(validate);
  session.open(OPENED);
  session.edit(request);
  session.edit({ ...request });
  await rest();
  return { problem: session.problem, checked };
}

function watched(validate) {
  const session = new Session({}, () => {});
  const checked = [];
  watchRequest(session, async (text) => validate(checked.push(JSON.parse(text))), 0);
  return { session, checked };
}

async function rest() {
  for (let turn = 0; turn < 3; turn += 1) await new Promise((done) => setTimeout(done, 0));
}

const refuse = (problem) => () => {
  throw new ProblemError(problem);
};

test("after edits, starts and goals are checked once each", async () => {
  const { problem, checked } = await afterEdit(() => FITS);
  assert.equal(problem, null);
  assert.deepEqual(
    checked.map(({ robots, plans }) => [robots[0].start, plans]),
    [
      [ROBOT.start, []],
      [ROBOT.goal, []],
    ],
  );
});

test("faults that the service reports are shown, except that there are no robots yet", async () => {
  const radius = { pointer: "/robots/0/radius", code: "out_of_range", detail: "No." };
  const none = { pointer: "/robots", code: "empty", detail: "None." };
  const state = await afterEdit(refuse({ title: "Invalid", errors: [radius, none] }));
  assert.deepEqual(state.problem, { title: "Invalid", errors: [radius] });
  assert.equal((await afterEdit(refuse({ title: "Invalid", errors: [none] }))).problem, null);
  assert.equal((await afterEdit(refuse({ title: "Overloaded", status: 503 }))).problem, null);
});

test("starts and goals that do not fit are reported together", async () => {
  const violation = { kind: "obstacle_collision", robots: ["a"], distance: 0, required: 0.3 };
  const { problem } = await afterEdit(() => ({ violations: [violation] }));
  const pointers = problem.errors.map(({ pointer }) => pointer);
  assert.deepEqual(pointers, ["/robots/0/start", "/robots/0/goal"]);
});

test("an opened request is checked at once, an unchanged example is not", async () => {
  const { session, checked } = watched(() => FITS);
  session.open({ ...OPENED, example: "one" });
  await rest();
  assert.equal(checked.length, 0);
  session.edit({ ...REQUEST });
  session.open({ ...OPENED, name: "two" });
  await rest();
  assert.equal(checked.length, 2, "at starts and at goals");
  session.undo();
  await rest();
  assert.equal(checked.length, 4);
  session.open(OPENED, { plans: [] });
  await rest();
  session.open({ ...OPENED, request: { ...REQUEST, robots: [] } });
  await rest();
  assert.equal(checked.length, 4, "a plan is checked instead, and a map alone has nothing to check");
});

test("an opened request without faults leaves another problem alone", async () => {
  const { session } = watched(() => FITS);
  session.open(OPENED);
  const problem = { title: "No answer" };
  session.setProblem(problem);
  await rest();
  assert.equal(session.problem, problem);
  session.edit({ ...REQUEST });
  await rest();
  assert.equal(session.problem, null);
});
