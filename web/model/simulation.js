// Simulations of a plan, see POST /v1/simulate: the request for a form's values, and figures of the answer in words.
// Pure. The form has shares of the speed in percent and offsets in millimetres; the service has SI units.

import { planFile } from "./plan_file.js";

export const POLICIES = [
  { value: "dependencies", label: "Dependencies: robots wait for each other" },
  { value: "clock_stop", label: "Shared clock: all slow down for the latest" },
  { value: "absorb_waits", label: "Planned waits absorb delays" },
  { value: "open_loop", label: "Open loop: no coordination" },
];

/** The values of a new form. */
export const FIRST_FORM = {
  policy: "absorb_waits",
  runs: 200,
  seed: 0,
  slowest: 80, // percent of the planned speed
  stops: 60, // in an hour of motion of a robot
  stop: 2, // seconds, their mean
  start: 0, // seconds before each action, at most
  sideways: 0, // millimetres, the standard deviation
  maxDelay: 1, // seconds, of clock_stop
};

const CORRELATION = 0.5; // metres between independent offsets

/** The disturbance of a form; what it leaves out disturbs nothing. */
export function disturbanceOf({ slowest, stops, stop, start, sideways }) {
  const speed = { min: slowest / 100, max: 1 };
  return {
    ...(slowest < 100 ? { speed, turn: speed } : {}),
    ...(stops > 0 && stop > 0 ? { stops: { rate_per_hour: stops, mean_s: stop } } : {}),
    ...(start > 0 ? { start_delay: { min: 0, max: start } } : {}),
    ...(sideways > 0 ? { cross_track: { sigma: sideways / 1000, correlation_length: CORRELATION } } : {}),
  };
}

/** The body of the request. `trace`: the number of a run whose actions are asked for, or null. */
export function simulationOf(request, answer, form, dependencies, trace = null) {
  const { policy, runs, seed, maxDelay } = form;
  return {
    ...planFile(request, answer),
    dependencies,
    policy,
    runs: trace === null ? runs : trace + 1,
    seed,
    disturbance: disturbanceOf(form),
    ...(policy === "clock_stop" ? { max_delay: maxDelay } : {}),
    ...(trace === null ? {} : { trace }),
  };
}

/** The robots of an answer with the largest delays in one of ten runs, descending, at most so many. */
export function mostDelayed(robots, most) {
  return robots
    .filter(({ delay }) => delay !== null && delay.p90 > 0)
    .sort((a, b) => b.delay.p90 - a.delay.p90)
    .slice(0, most);
}

/** A run as an answer that can be played instead of the plan. */
export function answerOfRun(answer, trace) {
  const { verified: _, min_clearance: __, lower_bound: ___, ...rest } = answer;
  const costs = trace.plans.map(({ cost }) => cost);
  return {
    ...rest,
    plans: trace.plans.map((plan) => ({ ...plan, visits: undefined })),
    flowtime: costs.reduce((sum, cost) => sum + cost, 0),
    makespan: Math.max(0, ...costs),
    warnings: [`This is execution ${trace.run} of a simulation, not the plan.`],
  };
}

/** A share in percent, with a digit where it matters. */
export function percent(share) {
  const value = share * 100;
  return `${Number(value.toFixed(value < 10 ? 1 : 0))} %`;
}

/** A change in percent, with its sign. */
export function change(share) {
  return share < 0 ? `\u2212${percent(-share)}` : `+${percent(share)}`;
}
