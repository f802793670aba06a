// Services by the actions alone: of runs of simulations, and of robots without a plan.

import assert from "node:assert/strict";
import { test } from "node:test";

import { answerOfRun } from "../../../web/model/simulation.js";
import { readScene, readTracks } from "../../../web/model/scene.js";

const at = (x, theta = 0) => ({ x, y: 0, theta });
const drive = (t_start, t_end, from, to) => ({
  type: "translate",
  t_start,
  t_end,
  from: at(from),
  to: at(to),
});
const wait = (t_start, t_end, x, goal) => ({
  type: "wait",
  t_start,
  t_end,
  from: at(x),
  to: at(x),
  ...(goal === undefined ? {} : { goal }),
});

const GOALS = [
  { x: 2, y: 0, service: 3, radius_after: 0.6, linear_acceleration_after: 0.25 },
  { x: 4, y: 0, radius_after: 0.5 },
  { x: 6, y: 0, service: 1, radius_after: 0.4 },
];
const requestOf = (goals) => ({
  map: { rows: ["........"] },
  robots: [{ id: "a", radius: 0.4, linear_acceleration: 1, start: at(0), goals }],
});
const ACTIONS = [
  drive(0, 2, 0, 2),
  wait(2, 5, 2, 0),
  drive(5, 7, 2, 4),
  drive(7, 9, 4, 6),
  wait(9, 10, 6, 2),
];

const tracksOf = (goals, answer) => readTracks(readScene(requestOf(goals)), answer);
const radiiOf = (goals, answer) => tracksOf(goals, answer).get("a").radii;
const planOf = (actions, more) => ({ plans: [{ robot: "a", cost: 10, actions, ...more }] });
const stopped = (actions) => ({
  plans: [],
  unplanned: [{ robot: "a", reason: "blocked_by_robots", actions }],
});

test("a plan without visits changes the radius where its actions serve goals", () => {
  const visits = [
    { goal: 0, t_arrive: 2, t_leave: 5 },
    { goal: 1, t_arrive: 7, t_leave: 7 },
    { goal: 2, t_arrive: 9, t_leave: null },
  ];
  const expected = [
    { t: 5, radius: 0.6 },
    { t: 7, radius: 0.5 },
    { t: 10, radius: 0.4 },
  ];
  assert.deepEqual(radiiOf(GOALS, planOf(ACTIONS, { visits })), expected);
  assert.deepEqual(radiiOf(GOALS, planOf(ACTIONS)), expected);
});

test("a run of a simulation has the loads of the plan, a little later and beside the goals", () => {
  const run = {
    run: 0,
    plans: [
      { robot: "a", cost: 11, actions: [drive(0, 3, 0, 2.01), wait(3, 6, 2.01, 0), drive(6, 8, 2.01, 4)] },
    ],
  };
  run.plans[0].actions[2].profile = { start: 0, cruise: 0.25, end: 0 };
  const plan = { ...planOf(ACTIONS, { visits: [] }), unplanned: [] };
  const track = tracksOf(GOALS, answerOfRun(plan, run)).get("a");
  assert.deepEqual(track.radii, [
    { t: 6, radius: 0.6 },
    { t: 8, radius: 0.5 },
  ]);
  assert.deepEqual(track.actions[2].changes, { rise: 1, fall: 1 });
});

test("a robot without a plan serves what its committed actions serve, but not its last goal", () => {
  assert.deepEqual(radiiOf(GOALS, stopped(ACTIONS.slice(0, 2))), [{ t: 5, radius: 0.6 }]);
  assert.deepEqual(radiiOf(GOALS, stopped([ACTIONS[0], wait(2, 4, 2, 0)])), []);
  assert.deepEqual(radiiOf([GOALS[0]], stopped(ACTIONS.slice(0, 2))), []);
  assert.deepEqual(radiiOf([{ ...GOALS[0], x: 0, service: 0 }, GOALS[1]], stopped([])), []);
});

test("a goal is served from its time on, in its heading, or at one of several poses", () => {
  const [first, ...others] = GOALS;
  const brief = ACTIONS.slice(0, 2);
  assert.deepEqual(radiiOf([{ ...first, not_before: 3 }, ...others], stopped(brief)), []);
  const early = [drive(0, 2, 0, 2), wait(2, 6, 2, 0)];
  assert.deepEqual(radiiOf([{ ...first, not_before: 3 }, ...others], stopped(early)), [
    { t: 6, radius: 0.6 },
  ]);
  const unmarked = [drive(0, 2, 0, 2), wait(2, 5, 2)];
  assert.deepEqual(radiiOf([{ ...first, theta: 1 }, ...others], stopped(unmarked)), []);
  const { x: _, y: __, ...either } = first;
  const poses = [
    { x: 9, y: 0 },
    { x: 2, y: 0 },
  ];
  assert.deepEqual(radiiOf([{ ...either, any_of: poses }, ...others], stopped(unmarked)), [
    { t: 5, radius: 0.6 },
  ]);
});
