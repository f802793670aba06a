import assert from "node:assert/strict";
import { test } from "node:test";

import {
  FleetRun,
  goalsAfter,
  placesOf,
  reachedBy,
  runningRequest,
  throughput,
} from "../../../web/model/fleet_run.js";
import { ProblemError } from "../../../web/model/problem.js";
import { Session } from "../../../web/model/session.js";

const at = (x) => ({ x, y: 0.5, theta: 0 });
const drive = (t_start, t_end, from, to) => ({
  type: "translate",
  t_start,
  t_end,
  from: at(from),
  to: at(to),
});
const plan = (robot, cost, from, to) => ({ robot, cost, actions: [drive(0, cost, from, to)] });
const REQUEST = {
  map: { rows: [".........."] },
  robots: [
    { id: "a", radius: 0.3, start: at(0.5), goal: at(2.5) },
    { id: "b", radius: 0.3, start: at(4.5), goals: [{ ...at(5.5), service: 1 }, at(8.5)] },
    { id: "post", radius: 0.3, start: at(9.5) },
  ],
  options: { mode: "anytime", inflation: 0.1 },
};
const ANSWER = { plans: [plan("a", 2, 0.5, 2.5), plan("b", 8, 4.5, 8.5)], unplanned: [] };

test("a running fleet is planned in time, and keeps its other options", () => {
  assert.deepEqual(runningRequest(REQUEST, 2).options, {
    mode: "first",
    inflation: 0.1,
    replan: "where_needed",
    time_budget_ms: 1800,
  });
});

test("who has arrived goes to its start and back; who never had a goal stays", () => {
  const places = placesOf(REQUEST);
  assert.deepEqual([...places.keys()], ["a", "b"]);
  assert.deepEqual(goalsAfter([...ANSWER.plans, { robot: "post", cost: 0 }], places, 2), [
    { robot: "a", goals: [{ ...at(0.5), service: 2 }, at(2.5)] },
  ]);
});

test("goals that are reached in a round count, services included", () => {
  assert.equal(reachedBy(ANSWER.plans, 2), 1);
  const visits = [
    { goal: 0, t_arrive: 0.5, t_leave: 1.5 },
    { goal: 1, t_arrive: 1.8, t_leave: null },
  ];
  assert.equal(reachedBy([{ robot: "a", cost: 1.8, visits }], 2), 2);
  const left = { goal: 1, t_arrive: null, t_leave: null, estimated_t_arrive: 1.9 };
  assert.equal(reachedBy([{ robot: "a", cost: 1.8, visits: [visits[0], left] }], 2), 1);
  assert.equal(reachedBy([{ robot: "a", cost: 0, visits: [{ goal: 0, t_arrive: 0, t_leave: null }] }], 2), 0);
});

test("throughput is of the last few rounds", () => {
  const round = (reached, length) => ({ length, reached, latency: 1, unplanned: 0 });
  const rounds = [4, 0, 0, 0, 0, 5].map((reached) => round(reached, 2));
  assert.deepEqual(throughput(rounds), [120, 60, 40, 30, 24, 30]);
  assert.deepEqual(
    throughput([round(0, 0), round(4, 2), round(1, 0.5)]),
    [0, 120, 120],
    "of cut rounds, too",
  );
});

/** A session that plays the plan, and a run with a service that records what it is asked. */
function begin(service = {}, now = () => 0) {
  const frames = [];
  const session = new Session({}, (callback) => frames.push(callback));
  session.open({ name: "one", example: null, text: "", request: REQUEST }, ANSWER);
  const asked = [];
  const run = new FleetRun(
    session,
    {
      advance: async (text) => {
        asked.push(JSON.parse(text));
        return { ...REQUEST, moment: asked.length };
      },
      plan: async () => ({ ...ANSWER, status: "solved" }),
      ...service,
    },
    now,
  );
  let clock = 0;
  /** Lets so many seconds pass, frame by frame, with the answers that arrive. */
  const pass = async (seconds) => {
    for (let passed = 0; passed < seconds; passed += 0.5) {
      frames.shift()?.((clock += 500));
      await new Promise((done) => setImmediate(done));
    }
  };
  return { session, run, asked, pass };
}

test("rounds follow each other while the plan is played, and the selection stays", async () => {
  const { session, run, asked, pass } = begin();
  session.select("b");
  run.start(2);
  await pass(5.5);
  assert.equal(run.rounds.length, 2);
  assert.deepEqual([asked[0].at, asked[0].commit, asked[0].request.options.replan], [2, 2, "where_needed"]);
  assert.deepEqual(
    asked[0].goals.map(({ robot }) => robot),
    ["a"],
  );
  assert.equal(asked[1].request.moment, 1, "each round goes on from the one before");
  assert.deepEqual([session.selected, session.request.moment, session.player.playing], ["b", 2, true]);
  run.stop();
  await pass(4);
  assert.deepEqual([run.rounds.length, session.player.playing], [2, false]);
});

test("a held robot stops a moment later, while the fleet goes on, and is held for its time, round by round", async () => {
  const { session, run, asked, pass } = begin();
  run.start(2);
  await pass(1.5);
  const end = session.player.time + 0.2; // as rounds take no time to plan
  assert.ok(end > 0.2 && end < 2, "within the round");
  run.hold("a", 3);
  assert.equal(session.player.playing, true);
  await pass(6);
  const sent = asked.map(({ at, commit, holds }) => ({ at, commit, holds }));
  assert.deepEqual(sent.slice(0, 4), [
    { at: 2, commit: 2, holds: [] },
    { at: end, commit: 2, holds: [{ robot: "a", until: 3 }] },
    { at: 2, commit: 2, holds: [{ robot: "a", until: 1 }] },
    { at: 2, commit: 2, holds: [] },
  ]);
  assert.deepEqual(
    run.rounds.slice(0, 2).map(({ length }) => length),
    [end, 2],
  );
});

test("a fleet is played until the hold of a robot begins, which is later if planning takes long", async () => {
  let clock = 0;
  const service = {
    plan: async () => {
      clock += 400; // milliseconds
      return { ...ANSWER, status: "solved" };
    },
  };
  const { session, run, asked, pass } = begin(service, () => clock);
  run.start(2);
  await pass(3.5);
  const before = session.player.time;
  session.player.speed = 2;
  run.hold("a", 3);
  const end = before + 2 * (0.2 + 1.5 * 0.4);
  assert.equal(asked.at(-1).at, end);
  const shown = [];
  session.on("time playback", () => shown.push([session.player.time, session.player.playing]));
  await pass(0.5);
  assert.deepEqual(shown.at(-1), [before + 1, true], "it goes on meanwhile");
  await pass(0.5);
  assert.ok(
    shown.some(([time]) => time === end),
    "as far as the hold, and no further",
  );
  assert.ok(shown.every(([time]) => time <= end));
  assert.equal(session.player.playing, true);
});

test("the plan that a hold replaces is aborted, and its answer dropped", async () => {
  const asked = [];
  const plan = (text, signal) =>
    new Promise((answer) => asked.push({ signal, answer: () => answer({ ...ANSWER, status: "solved" }) }));
  const { session, run, pass } = begin({ plan });
  run.start(2);
  await pass(1);
  run.hold("a", 3);
  await pass(1);
  assert.deepEqual(
    asked.map(({ signal }) => signal.aborted),
    [true, false],
  );
  asked[0].answer();
  await pass(1);
  assert.equal(run.rounds.length, 0);
  assert.equal(session.player.playing, false, "nothing moves until the held robot is planned");
  asked[1].answer();
  await pass(1);
  assert.equal(run.rounds.length, 1);
  assert.equal(session.player.playing, true);
});

test("a robot that is held while the fleet is paused is planned at once, and the fleet stays paused", async () => {
  const { session, run, asked, pass } = begin();
  run.start(2);
  await pass(1.5);
  session.pause();
  run.hold("b", 3);
  run.hold("b", 0);
  run.hold("a", 3);
  await pass(1);
  assert.equal(run.rounds.length, 1, "the last of them");
  assert.deepEqual(run.holds, [{ robot: "a", left: 3 }]);
  assert.equal(session.player.playing, false);
  run.hold("a", 0);
  await pass(1);
  assert.deepEqual([run.holds, asked.at(-2).holds], [[], []]);
  run.hold("a", 3);
  session.play();
  await pass(1);
  assert.equal(session.player.playing, true, "unless it is played meanwhile");
});

test("a fleet that is paused while the next round is late stays paused", async () => {
  const late = [];
  const plan = () => new Promise((answer) => late.push(() => answer({ ...ANSWER, status: "solved" })));
  const { session, run, pass } = begin({ plan });
  run.start(2);
  await pass(3);
  assert.ok(session.player.playing && session.player.time > 2, "the old plan is played meanwhile");
  session.pause();
  late[0]();
  await pass(1);
  assert.deepEqual([run.rounds.length, session.player.playing], [1, false]);
  session.play();
  await pass(1);
  assert.equal(session.player.playing, true);
});

test("a failure, or another request, stops the run", async () => {
  const problem = { title: "Service Unavailable" };
  const failing = begin({ plan: async () => Promise.reject(new ProblemError(problem)) });
  failing.run.start(2);
  await failing.pass(3);
  assert.deepEqual([failing.run.running, failing.session.problem], [false, problem]);

  const other = begin();
  other.run.start(2);
  other.session.edit({ ...REQUEST, robots: [] });
  assert.equal(other.run.running, false);
});
