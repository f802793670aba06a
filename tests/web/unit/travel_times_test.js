import assert from "node:assert/strict";
import { test } from "node:test";

import { ConnectionLost, ProblemError } from "../../../web/model/problem.js";
import { Session } from "../../../web/model/session.js";
import { TravelTimes } from "../../../web/model/travel_times.js";

const ROBOT = { id: "a", radius: 0.3, linear_speed: 1, angular_speed: 2, start: { x: 0.5, y: 0.5 } };
const REQUEST = {
  map: { rows: Array(5).fill(".".repeat(10)) },
  robots: [ROBOT, { ...ROBOT, id: "b", start: { x: 9.5, y: 0.5 } }],
};
const opened = (request) => ({ name: "one", example: null, text: "", request });

/** Times of a session whose service answers by `answer(body, signal)`, by default with metres to the start. */
function begin(answer = timesOf) {
  const asked = [];
  const matrix = async (text, signal) => {
    const body = JSON.parse(text);
    asked.push(body);
    return answer(body, signal, asked.length);
  };
  const session = new Session({ matrix }, () => {});
  const times = new TravelTimes(session, { matrix }, () => 0);
  session.open(opened(REQUEST));
  return { session, times, asked };
}

const timesOf = ({ from, to: [start] }) => ({
  seconds: from.map(({ x, y }) => [Math.hypot(x - start.x, y - start.y)]),
});

/** Resolves when the times are in a state. */
const reached = (times, state) =>
  new Promise((resolve) => {
    const look = () => times.state === state && resolve(undefined);
    times.onChange(look);
    look();
  });

test("nothing is asked until it is switched on and a robot is selected", async () => {
  const { session, times, asked } = begin();
  session.select("a");
  times.switch(true);
  await reached(times, "done");
  assert.equal(times.robot, "a");
  assert.equal(asked.flatMap(({ from }) => from).length, 50);
  assert.ok(asked.length > 1, "in parts");
  assert.equal(times.field?.timeAt({ x: 3.5, y: 4.5 })?.seconds, 5);
});

test("the times stay when the robot is deselected, and follow another one that is selected", async () => {
  const { session, times, asked } = begin();
  session.select("a");
  times.switch(true);
  await reached(times, "done");
  const { length } = asked;
  session.select(null);
  session.hover("b");
  assert.deepEqual([times.robot, times.state, asked.length], ["a", "done", length]);
  session.select("b");
  assert.deepEqual([times.robot, times.state, times.field], ["b", "computing", null]);
  await reached(times, "done");
  assert.equal(times.field?.timeAt({ x: 9.5, y: 4.5 })?.seconds, 4);
  session.open(opened(REQUEST));
  assert.deepEqual([times.robot, times.state, times.field], [null, "none", null]);
});

for (const [what, change] of Object.entries({
  "another robot": (session) => session.select("b"),
  "an edit of the map": (session) => session.edit({ ...REQUEST, map: { rows: REQUEST.map.rows.slice(1) } }),
  "the deletion of the robot": (session) => session.edit({ ...REQUEST, robots: [] }),
  "switching it off": (_, times) => times.switch(false),
})) {
  test(`${what} ends the work`, async () => {
    let begun = /** @type {(signal: AbortSignal) => void} */ (() => {});
    const first = new Promise((resolve) => (begun = resolve));
    const { session, times } = begin((body, signal, calls) => {
      if (calls > 1) return timesOf(body);
      begun(signal);
      return new Promise((_, reject) => signal.addEventListener("abort", () => reject(signal.reason)));
    });
    session.select("a");
    times.switch(true);
    const signal = await first;
    change(session, times);
    assert.ok(signal.aborted);
    assert.equal(times.field, null);
    await new Promise((resolve) => setImmediate(resolve));
    assert.equal(session.problem, null);
  });
}

test("an edit that the times do not depend on changes nothing", async () => {
  const { session, times, asked } = begin();
  session.select("a");
  times.switch(true);
  await reached(times, "done");
  const { field } = times;
  const { length } = asked;
  session.edit({ ...REQUEST, robots: [{ ...ROBOT, goal: { x: 5.5, y: 1.5 } }, REQUEST.robots[1]] });
  assert.deepEqual([times.field, times.state, asked.length], [field, "done", length]);
});

test("if the service cannot do so many places at a time, it is asked for fewer", async () => {
  const { session, times, asked } = begin((body) => {
    if (body.from.length > 5)
      throw new ProblemError({ title: "Too many", code: "check_unfinished", errors: [] });
    return timesOf(body);
  });
  session.select("a");
  times.switch(true);
  await reached(times, "done");
  assert.deepEqual(
    asked.slice(0, 3).map(({ from }) => from.length),
    [16, 4, 4],
  );
  assert.equal(times.field?.known, 50);
});

test("a failure is told, what is known stays, and it can be tried again", async () => {
  const { session, times } = begin((body, _, calls) => {
    if (calls === 2) throw new ConnectionLost();
    return timesOf(body);
  });
  session.select("a");
  times.switch(true);
  await reached(times, "failed");
  assert.match(session.problem?.title ?? "", /No response/);
  assert.equal(times.field?.known, 16);
  session.problem?.again?.();
  await reached(times, "done");
  assert.equal(session.problem, null);
});

test("faults are told at their places, and an edit asks again", async () => {
  const fault = { pointer: "/to/0", code: "goal_in_obstacle", detail: "in a wall" };
  const { session, times } = begin((body, _, calls) => {
    if (calls === 1) throw new ProblemError({ title: "Invalid Request", errors: [fault] });
    return timesOf(body);
  });
  session.select("b");
  times.switch(true);
  await reached(times, "failed");
  assert.deepEqual(session.problem?.errors, [{ ...fault, pointer: "/robots/1/start" }]);
  assert.equal(session.problem?.again, undefined);
  session.edit({ ...REQUEST, robots: [ROBOT, { ...REQUEST.robots[1], start: { x: 8.5, y: 0.5 } }] });
  await reached(times, "done");
  assert.equal(session.problem, null);
});
