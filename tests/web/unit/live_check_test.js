import assert from "node:assert/strict";
import { test } from "node:test";

import { watchEdits } from "../../../web/model/live_check.js";
import { Session } from "../../../web/model/session.js";
import { ProblemError } from "../../../web/service/problem.js";

const ROBOT = { id: "a", radius: 0.3, start: { x: 0.5, y: 0.5 }, goal: { x: 2.5, y: 0.5 } };
const REQUEST = { map: { rows: ["..."] }, robots: [ROBOT] };
const OPENED = { name: "one", example: null, text: JSON.stringify(REQUEST), request: REQUEST };
const FITS = { violations: [] };

/**
 * The problem that a session has when an edit has been judged by `validate(how often it was asked)`; and what
 * was asked.
 */
async function afterEdit(validate, request = { ...REQUEST, options: { seed: 1 } }) {
  const { session, asked } = watched(validate);
  session.open(OPENED);
  session.edit(request);
  session.edit({ ...request });
  await rest();
  return { problem: session.problem, asked };
}

function watched(validate) {
  const session = new Session({}, () => {});
  const asked = [];
  watchEdits(session, async (text) => validate(asked.push(JSON.parse(text))), 0);
  return { session, asked };
}

async function rest() {
  for (let turn = 0; turn < 3; turn += 1) await new Promise((done) => setTimeout(done, 0));
}

const refuse = (problem) => () => {
  throw new ProblemError(problem);
};

test("after edits the service is asked once about the starts and once about the goals", async () => {
  const { problem, asked } = await afterEdit(() => FITS);
  assert.equal(problem, null);
  assert.deepEqual(
    asked.map(({ robots, plans }) => [robots[0].start, plans]),
    [
      [ROBOT.start, []],
      [ROBOT.goal, []],
    ],
  );
});

test("what the service refuses is the problem, but not that there are no robots yet", async () => {
  const radius = { pointer: "/robots/0/radius", code: "out_of_range", detail: "No." };
  const none = { pointer: "/robots", code: "empty", detail: "None." };
  const told = await afterEdit(refuse({ title: "Invalid", errors: [radius, none] }));
  assert.deepEqual(told.problem, { title: "Invalid", errors: [radius] });
  assert.equal((await afterEdit(refuse({ title: "Invalid", errors: [none] }))).problem, null);
  assert.equal((await afterEdit(refuse({ title: "Overloaded", status: 503 }))).problem, null);
});

test("starts and goals that do not fit are told together", async () => {
  const violation = { kind: "obstacle_collision", robots: ["a"], distance: 0, required: 0.3 };
  const { problem } = await afterEdit(() => ({ violations: [violation] }));
  const pointers = problem.errors.map(({ pointer }) => pointer);
  assert.deepEqual(pointers, ["/robots/0/start", "/robots/0/goal"]);
});

test("what is opened is not judged, unless undo brought back an edit", async () => {
  const { session, asked } = watched(() => FITS);
  session.open(OPENED);
  await rest();
  assert.equal(asked.length, 0);
  session.edit({ ...REQUEST });
  session.open({ ...OPENED, name: "two" });
  await rest();
  assert.equal(asked.length, 0);
  session.undo();
  await rest();
  assert.equal(asked.length, 2);
});
