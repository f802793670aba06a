import assert from "node:assert/strict";
import { test } from "node:test";

import { ConnectionLost, ProblemError } from "../../../web/model/problem.js";
import { Session } from "../../../web/model/session.js";

const ROBOT = { id: "a", radius: 0.3, start: { x: 0.5, y: 0.5 }, goal: { x: 2.5, y: 0.5 } };
const REQUEST = { map: { rows: ["..."] }, robots: [ROBOT] };
const OPENED = { name: "one", example: null, text: JSON.stringify(REQUEST, null, 2), request: REQUEST };
const ANSWER = {
  plans: [
    {
      robot: "a",
      cost: 2,
      actions: [
        {
          type: "translate",
          t_start: 0,
          t_end: 2,
          from: { x: 0.5, y: 0.5, theta: 0 },
          to: { x: 2.5, y: 0.5, theta: 0 },
        },
      ],
    },
  ],
};

/** A session with a service that returns the given answers, and a record of its signals. */
function begin(service = {}) {
  const frames = [];
  const session = new Session(service, (callback) => frames.push(callback));
  const heard = [];
  for (const name of [
    "request",
    "answer",
    "incumbent",
    "planning",
    "problem",
    "check",
    "marks",
    "time",
    "playback",
    "announcement",
  ]) {
    session.on(name, (detail) =>
      heard.push(detail === undefined ? name : `${name} ${JSON.stringify(detail)}`),
    );
  }
  return { session, heard, frames };
}

/** A promise and what settles it. */
function deferred() {
  const made = {};
  made.promise = new Promise((resolve, reject) => Object.assign(made, { resolve, reject }));
  return made;
}

test("an opened request is sent unchanged until it is edited", () => {
  const { session } = begin();
  session.open(OPENED);
  assert.equal(session.text, OPENED.text);
  const edited = { ...REQUEST, options: { seed: 1 } };
  session.edit(edited);
  assert.equal(session.text, JSON.stringify(edited));
  session.undo();
  assert.equal(session.text, OPENED.text);
  session.redo();
  assert.equal(session.request, edited);
});

test("a request counts as an example only while it is unchanged", () => {
  const { session } = begin();
  session.open({ ...OPENED, example: "one" });
  session.edit({ ...REQUEST });
  assert.equal(session.example, null);
  session.undo();
  assert.equal(session.example, "one");
});

test("undo brings an edited request back after another one was opened", () => {
  const { session, heard } = begin();
  const edited = { ...REQUEST, options: { seed: 1 } };
  const other = { name: "two", example: "two", text: "{}", request: {} };
  session.open(OPENED);
  session.edit(edited);
  session.open(other);
  heard.length = 0;
  session.undo();
  assert.deepEqual([session.request, session.name, session.edited], [edited, "one", true]);
  assert.ok(heard.includes('request {"opened":true,"restored":true}'));
  assert.equal(heard.at(-1), 'announcement "Undone: one is open again."');
  session.undo();
  assert.equal(session.text, OPENED.text);
  session.redo();
  session.redo();
  assert.deepEqual([session.text, session.example, session.canRedo], ["{}", "two", false]);
});

test("opening one request after another without an edit leaves nothing to undo", () => {
  const { session } = begin();
  session.open(OPENED);
  session.open({ ...OPENED, request: { ...REQUEST } });
  assert.equal(session.canUndo, false);
});

test("an edit keeps the answer and its time, and signals the request before the answer", () => {
  const { session, heard } = begin();
  session.open(OPENED);
  session.adopt(ANSWER);
  session.seek(1);
  heard.length = 0;
  session.edit({ ...REQUEST, options: {} });
  assert.deepEqual([session.answer, session.player.duration, session.player.time], [ANSWER, 2, 1]);
  assert.deepEqual([...session.outdated], []);
  assert.equal(session.poseOf("a").x, 1.5, "its plan still holds");
  assert.deepEqual(heard, ["check", 'request {"opened":false}', "answer", "marks"]);
});

test("a robot that was edited stands at its start, its plan outdated", () => {
  const { session } = begin();
  session.open(OPENED, ANSWER);
  session.seek(1);
  session.edit({ ...REQUEST, robots: [{ ...ROBOT, start: { x: 1.5, y: 0.5 } }] });
  assert.deepEqual([...session.outdated], ["a"]);
  assert.equal(session.stateOf("a"), "outdated");
  assert.deepEqual(session.poseOf("a"), { x: 1.5, y: 0.5, theta: 0 });
});

test("undo and redo restore the request with its answer", () => {
  const { session } = begin();
  const later = { ...ANSWER, flowtime: 7 };
  session.open(OPENED, ANSWER);
  session.edit({ ...REQUEST, robots: [{ ...ROBOT, goal: { x: 1.5, y: 0.5 } }] });
  session.adopt(later);
  session.undo();
  assert.deepEqual([session.request, session.answer, session.outdated], [REQUEST, ANSWER, null]);
  session.redo();
  assert.deepEqual([session.answer, session.outdated], [later, null]);
  session.edit({ ...REQUEST, robots: [] });
  session.undo();
  assert.deepEqual([session.answer, session.outdated, session.canRedo], [later, null, true]);
});

test("planning that ends without any plan leaves the one before", async () => {
  const { session } = begin({ plan: () => new Promise(() => {}) });
  session.open(OPENED, ANSWER);
  session.edit({ ...REQUEST, options: {} });
  session.plan();
  assert.equal(session.answer, null);
  session.cancel();
  assert.deepEqual([session.answer, session.outdated?.size], [ANSWER, 0]);
});

test("robots whose plans are found to be broken are outdated as well", () => {
  const { session, heard } = begin();
  session.open(OPENED, ANSWER);
  session.edit({ ...REQUEST, map: { rows: [".#."] } });
  heard.length = 0;
  session.outdate(["a"]);
  assert.equal(session.stateOf("a"), "outdated");
  assert.deepEqual(heard, ["answer", "marks"]);
});

test("a robot stays selected after an edit if it still exists", () => {
  const { session } = begin();
  session.open(OPENED);
  session.select("a");
  session.edit({ ...REQUEST, options: {} });
  assert.equal(session.selected, "a");
  session.edit({ ...REQUEST, robots: [{ ...ROBOT, id: "b" }] });
  assert.equal(session.selected, null);
});

test("planning records progress and costs, and ends with its answer", async () => {
  const answer = deferred();
  let listening;
  const { session } = begin({
    plan: (text, signal, listeners) => {
      listening = listeners;
      return answer.promise;
    },
  });
  session.open(OPENED);
  const done = session.plan(5);
  for (const [elapsed_ms, flowtime] of [
    [1, null],
    [2, 9],
    [3, 9],
    [4, 7],
  ]) {
    const best = flowtime === null ? null : { flowtime, makespan: 1 };
    listening.progress({ elapsed_ms, attempt: 1, planned: 1, robots: 1, best });
  }
  assert.deepEqual(
    session.planning.costs.map(({ elapsed_ms, flowtime }) => [elapsed_ms, flowtime]),
    [
      [2, 9],
      [4, 7],
    ],
  );
  answer.resolve(ANSWER);
  assert.equal(await done, true);
  assert.deepEqual([session.planning, session.answer], [null, ANSWER]);
});

test("cancelling keeps the best plan so far and drops late answers", async () => {
  const answer = deferred();
  let signal;
  const { session } = begin({
    plan: (text, given, { incumbent }) => {
      signal = given;
      incumbent(JSON.stringify(ANSWER));
      return answer.promise;
    },
  });
  session.open(OPENED);
  const done = session.plan();
  session.cancel();
  assert.equal(signal.aborted, true);
  assert.deepEqual(session.answer, ANSWER);
  answer.reject(new Error("aborted"));
  assert.equal(await done, false);
  assert.deepEqual(session.answer, ANSWER);
});

test("an edit stops planning and shows no plan of the older request", async () => {
  const answer = deferred();
  const { session } = begin({ plan: () => answer.promise });
  session.open(OPENED);
  const done = session.plan();
  session.edit({ ...REQUEST, options: {} });
  answer.resolve(ANSWER);
  assert.equal(await done, false);
  assert.equal(session.answer, null);
});

test("a failure of planning is shown as a problem until the next attempt", async () => {
  const problem = { title: "No", errors: [] };
  let refuses = true;
  const { session } = begin({
    plan: async () => {
      if (refuses) throw new ProblemError(problem);
      return ANSWER;
    },
  });
  session.open(OPENED);
  assert.equal(await session.plan(), false);
  assert.equal(session.problem, problem);
  refuses = false;
  assert.equal(await session.plan(), true);
  assert.equal(session.problem, null);
});

test("planning that fails keeps the best plan so far, and says so", async () => {
  const { session, heard } = begin({
    plan: async (text, signal, { incumbent }) => {
      incumbent(JSON.stringify({ ...ANSWER, flowtime: 3 }));
      incumbent(JSON.stringify(ANSWER));
      throw new ConnectionLost();
    },
  });
  session.open(OPENED);
  assert.equal(await session.plan(), true);
  assert.deepEqual(session.answer, ANSWER);
  assert.match(session.problem.detail, /The connection failed.* The best plan found until then is shown/);
  assert.equal(session.planning, null);
  assert.equal(heard.at(-1), "problem");
});

test("a check of a plan that is no longer shown is dropped", async () => {
  const check = deferred();
  let sent;
  const { session } = begin({
    validate: (text) => {
      sent = JSON.parse(text);
      return check.promise;
    },
  });
  session.open(OPENED, ANSWER);
  const first = session.validate();
  assert.deepEqual(sent, { ...REQUEST, ...ANSWER });
  session.edit({ ...REQUEST, options: {} });
  check.resolve({ valid: true, violations: [] });
  await first;
  assert.equal(session.check, null);
});

test("playing requests one frame at a time and signals each moment until the end", () => {
  const { session, heard, frames } = begin();
  session.open(OPENED, ANSWER);
  heard.length = 0;
  session.play();
  session.play();
  let clock = 0;
  while (frames.length > 0) {
    assert.equal(frames.length, 1);
    frames.shift()((clock += 800));
  }
  assert.deepEqual(heard.slice(0, 2), ["playback", "playback"]);
  assert.deepEqual(heard.slice(2), ["time", "time", "time", "time", "playback"]);
  assert.deepEqual([session.player.time, session.player.playing], [2, false]);
});

test("several robots are highlighted together, with the first selected", () => {
  const { session } = begin();
  session.open({ ...OPENED, request: { ...REQUEST, robots: [ROBOT, { ...ROBOT, id: "b" }] } });
  session.highlight(["b", "a"]);
  assert.deepEqual([session.selected, [...session.marked].sort()], ["b", ["a", "b"]]);
  session.select(null);
  assert.equal(session.marked.size, 0);
});

test("better plans are shown while planning goes on, and playing continues", async () => {
  const ended = deferred();
  const better = { ...ANSWER, plans: [{ ...ANSWER.plans[0], cost: 1.5 }] };
  const shown = {};
  const { session, heard, frames } = begin({
    plan: (text, signal, { incumbent }) => {
      incumbent(JSON.stringify(ANSWER));
      shown.first = session.answer;
      session.play();
      frames.shift()(1000);
      frames.shift()(1800);
      incumbent(JSON.stringify(better));
      shown.second = session.answer;
      return ended.promise;
    },
  });
  session.open(OPENED);
  const planned = session.plan();
  assert.deepEqual([shown.first, shown.second], [ANSWER, better]);
  assert.deepEqual(
    heard.filter((name) => name.startsWith("incumbent")),
    ["incumbent true", "incumbent false"],
  );
  assert.ok(Math.abs(session.player.time - 0.8) < 1e-9);
  assert.deepEqual([session.player.duration, session.player.playing], [1.5, true]);
  assert.notEqual(session.planning, null);
  ended.resolve(ANSWER);
  assert.equal(await planned, true);
  assert.equal(session.answer, ANSWER);
  assert.ok(Math.abs(session.player.time - 0.8) < 1e-9);
  assert.equal(session.player.playing, true);
});

test("an edit while a better plan is shown ends planning and drops that plan", async () => {
  const { session } = begin({
    plan: (text, signal, { incumbent }) => {
      incumbent(JSON.stringify(ANSWER));
      return new Promise(() => {});
    },
  });
  session.open(OPENED);
  session.plan();
  assert.deepEqual(session.answer, ANSWER);
  session.edit({ ...REQUEST, options: { seed: 1 } });
  assert.deepEqual([session.answer, session.planning], [null, null]);
});
