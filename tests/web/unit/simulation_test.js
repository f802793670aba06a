import assert from "node:assert/strict";
import { test } from "node:test";

import {
  answerOfRun,
  disturbanceOf,
  FIRST_FORM,
  mostDelayed,
  percent,
  simulationOf,
} from "../../../web/model/simulation.js";

const CALM = { ...FIRST_FORM, slowest: 100, stops: 0, start: 0, sideways: 0 };
const REQUEST = { map: { rows: [".."] }, robots: [] };
const ANSWER = {
  status: "solved",
  plans: [{ robot: "a", cost: 3, actions: [], visits: [] }],
  verified: true,
};

test("what a form leaves out disturbs nothing", () => {
  assert.deepEqual(disturbanceOf(CALM), {});
});

test("disturbances are in SI units", () => {
  assert.deepEqual(disturbanceOf({ ...CALM, slowest: 80, stops: 30, stop: 4, start: 0.5, sideways: 20 }), {
    speed: { min: 0.8, max: 1 },
    turn: { min: 0.8, max: 1 },
    stops: { rate_per_hour: 30, mean_s: 4 },
    start_delay: { min: 0, max: 0.5 },
    cross_track: { sigma: 0.02, correlation_length: 0.5 },
  });
});

test("a simulation has the plan and the form, and a limit of delay only with the clock", () => {
  const body = simulationOf(REQUEST, ANSWER, { ...CALM, runs: 50, seed: 7 }, undefined);
  assert.deepEqual([body.runs, body.seed, body.policy, "max_delay" in body], [50, 7, "absorb_waits", false]);
  assert.equal(body.plans, ANSWER.plans);
  const clocked = simulationOf(REQUEST, ANSWER, { ...CALM, policy: "clock_stop", maxDelay: 2 }, undefined);
  assert.equal(clocked.max_delay, 2);
});

test("a run is asked for with those before it, as its number decides its delays", () => {
  const { runs, trace } = simulationOf(REQUEST, ANSWER, { ...CALM, runs: 50 }, undefined, 7);
  assert.deepEqual([runs, trace], [8, 7]);
});

test("the most delayed robots come first; those on time are left out", () => {
  const robot = (name, p90) => ({ robot: name, delay: { p90 } });
  const listed = mostDelayed([robot("a", 1), robot("b", 0), robot("c", 3), robot("d", 2)], 2);
  assert.deepEqual(
    listed.map(({ robot }) => robot),
    ["c", "d"],
  );
});

test("a run is played as an answer that nobody verified", () => {
  const played = answerOfRun(ANSWER, { run: 4, plans: [{ robot: "a", cost: 5, actions: [] }] });
  assert.deepEqual([played.makespan, played.flowtime, "verified" in played], [5, 5, false]);
  assert.match(played.warnings[0], /execution 4/);
});

test("shares are percentages with a digit below ten", () => {
  assert.deepEqual([0, 0.0123, 0.5, 1].map(percent), ["0 %", "1.2 %", "50 %", "100 %"]);
});
