// A fleet that keeps running, in rounds: plays a plan, advances its request to the end of the round, and plans the next
// one meanwhile (see docs/fleet_loop.md). Robots that have arrived go to their start and back.
//
// If a robot is held or released, the round ends as soon as the next one may be planned. If the next plan is not ready
// by then, nothing moves until it is. No DOM; the service is passed in. Seconds.

import { goalsOf, lastGoalOf } from "./goals.js";
import { robotsOf } from "./listed.js";
import { Signals } from "./signals.js";
import { stuckOf } from "./stuck.js";

const SERVICE = 2; // seconds at the start before a robot goes back
const BUDGET_SHARE = 0.9; // of a round
const LEAST_BUDGET_MS = 200;
const SMOOTHED = 5; // rounds whose goals count for the throughput
const LEAST_LEAD = 0.2; // of the wall clock, from a hold to the end of the round
const LEAD_SHARE = 1.5; // of the time that recent rounds took to plan, in addition
const NO_LISTENER = { progress() {}, incumbent() {}, waiting() {} };

/** The request with the options of a running fleet: it is planned in time, and only what must change. */
export function runningRequest(request, period) {
  const budget = Math.max(LEAST_BUDGET_MS, Math.round(period * 1000 * BUDGET_SHARE));
  return {
    ...request,
    options: { ...request.options, mode: "first", replan: "where_needed", time_budget_ms: budget },
  };
}

/** The goals of robots that have arrived by a time: to their start, where they are served, and back. */
export function goalsAfter(plans, places, t) {
  const arrived = plans.filter(({ robot, cost }) => cost <= t && places.has(robot));
  return arrived.map(({ robot }) => {
    const { start, goal } = places.get(robot);
    return { robot, goals: [{ ...start, service: SERVICE }, goal] };
  });
}

/** How many goals robots reach by a time. */
export function reachedBy(plans, t) {
  const isIn = (at) => at > 0 && at <= t;
  return plans.reduce((sum, { cost, visits }) => {
    const reached = visits?.filter(({ t_arrive }) => t_arrive !== null);
    const times = reached?.map(({ t_leave }) => t_leave ?? cost) ?? [cost];
    return sum + times.filter(isIn).length;
  }, 0);
}

/** Where each robot with a goal goes: id -> {start, goal}, the poses alone. */
export function placesOf(request) {
  const pose = ({ x, y, theta }) => ({ x, y, ...(theta === undefined ? {} : { theta }) });
  const moving = robotsOf(request).filter((robot) => goalsOf(robot).length > 0);
  return new Map(
    moving.map((robot) => [robot.id, { start: pose(robot.start), goal: pose(lastGoalOf(robot)) }]),
  );
}

/** The goals reached a minute, after each round, in the last few rounds. */
export function throughput(rounds) {
  return rounds.map((_, at) => {
    const recent = rounds.slice(Math.max(0, at + 1 - SMOOTHED), at + 1);
    const sumOf = (name) => recent.reduce((sum, round) => sum + round[name], 0);
    const length = sumOf("length");
    return length > 0 ? (sumOf("reached") / length) * 60 : 0;
  });
}

export class FleetRun {
  #session;
  #service;
  #now;
  #signals = new Signals();
  #turn = 0; // counts starts, stops and holds, so that late answers are dropped
  #places = new Map();
  #holds = new Map(); // id -> seconds from the start of the round
  #present = /** @type {any} */ (null); // {request, answer} of the round
  #end = 0; // of the round, seconds
  /** @type {Promise<any> | null} */
  #next = null; // of the request and answer of the next round
  #planning = new AbortController(); // of the next round
  #isProceeding = false;
  #plays = true; // after that
  #isCut = false; // the round ends by a hold

  running = false;
  period = 2; // seconds of a round that is not ended by a hold
  /** @type {{length: number, reached: number, latency: number, unplanned: number,
   * stuck: number}[]} */
  rounds = []; // that have ended

  /** `now()` is the wall clock in milliseconds. */
  constructor(session, service, now) {
    this.#session = session;
    this.#service = service;
    this.#now = now;
    session.on("time playback", () => this.#watch());
    session.on("playback", () => this.#onPlayback());
    session.on("request", ({ proceeded }) => proceeded || this.stop());
    this.onChange(() => session.hold(this.running ? this.#holds.keys() : []));
  }

  /** `listener` is called when it starts, stops, ends a round, or holds other robots. */
  onChange(listener) {
    this.#signals.on("change", listener);
  }

  /** The held robots: [{robot, left}], with the seconds that are left from now on. */
  get holds() {
    const { time } = this.#session.player;
    return [...this.#holds].map(([robot, until]) => ({ robot, left: Math.max(0, until - time) }));
  }

  /** Starts from the session's request and plan, which must be there. */
  start(period) {
    this.stop();
    this.period = period;
    this.rounds = [];
    this.#holds.clear();
    this.#places = placesOf(this.#session.request);
    this.running = true;
    this.#turn += 1;
    this.#begin(runningRequest(this.#session.request, period), this.#session.answer);
  }

  stop() {
    if (!this.running) return;
    this.running = false;
    this.#turn += 1;
    this.#planning.abort();
    this.#next = null;
    this.#isProceeding = false;
    this.#session.pause();
    this.#signals.emit("change");
  }

  /** Holds a robot for so many seconds; 0 releases it. From now on, or a moment later while the fleet is played. */
  hold(robot, duration) {
    const { player } = this.#session;
    const begin = player.time + (this.running && player.playing ? this.#lead : 0);
    if (duration > 0) this.#holds.set(robot, begin + duration);
    else this.#holds.delete(robot);
    this.#signals.emit("change");
    if (!this.running) return;
    this.#turn += 1;
    this.#planNext(begin);
    this.#isCut = player.playing;
    if (player.playing) this.#isProceeding = false;
    else this.#proceed(this.#isProceeding && this.#plays);
  }

  /** How long the fleet is played until a hold begins, because its plan takes some time. */
  get #lead() {
    const latency = Math.max(0, ...this.rounds.slice(-SMOOTHED).map((round) => round.latency)) / 1000;
    return (LEAST_LEAD + LEAD_SHARE * latency) * this.#session.player.speed;
  }

  /** Plans the next round while this one is played. */
  #begin(request, answer, plays = true) {
    this.#present = { request, answer };
    this.#isCut = false;
    this.#planNext(this.period);
    this.#signals.emit("change");
    if (plays) this.#session.play();
    this.#watch();
  }

  /** Plans the round that begins when this one, in its second `end`, has ended. */
  #planNext(end) {
    this.#end = end;
    this.#planning.abort();
    this.#planning = new AbortController();
    this.#next = this.#plan(this.#present, end, this.#planning.signal);
    this.#next.catch(() => {}); // it is awaited at the end of the round
  }

  async #plan({ request, answer: { plans } }, at, signal) {
    const holds = [...this.#holds]
      .filter(([, until]) => until > at)
      .map(([robot, until]) => ({ robot, until: until - at }));
    const goals = goalsAfter(plans, this.#places, at);
    const advanced = await this.#service.advance(
      JSON.stringify({ request, plans, at, commit: this.period, goals, holds }),
    );
    signal.throwIfAborted();
    const asked = this.#now();
    const answer = await this.#service.plan(JSON.stringify(advanced), signal, NO_LISTENER);
    const latency = this.#now() - asked;
    const reached = reachedBy(plans, at);
    const figures = {
      length: at,
      reached,
      latency,
      unplanned: answer.unplanned.length,
      stuck: stuckOf(answer).length,
    };
    return { request: advanced, answer, figures };
  }

  /** Ends the round when it has been played. */
  #watch() {
    const { time, duration } = this.#session.player;
    const end = Math.min(this.#end, duration);
    if (!this.running || this.#isProceeding || time < end) return;
    this.#isProceeding = true;
    if (this.#isCut) {
      this.#session.seek(end);
      this.#session.pause();
    }
    this.#proceed(true);
  }

  /**
   * If the user pauses while the next round is late, the next round is paused, too. A pause before a hold does not come
   * from the user.
   */
  #onPlayback() {
    const { playing, time, duration } = this.#session.player;
    if (this.#isProceeding && !this.#isCut && !playing && time < duration) this.#plays = false;
  }

  /** Goes on with the next round as soon as it is planned. */
  async #proceed(plays) {
    const turn = this.#turn;
    this.#isProceeding = true;
    this.#plays = plays;
    let next;
    try {
      next = await this.#next;
    } catch (error) {
      if (turn !== this.#turn) return;
      this.stop();
      this.#session.fail(error);
      return;
    }
    if (turn !== this.#turn) return;
    const { time, playing } = this.#session.player;
    const late = Math.max(0, time - this.#end);
    this.rounds = [...this.rounds, next.figures];
    for (const [robot, until] of this.#holds) {
      if (until > this.#end) this.#holds.set(robot, until - this.#end);
      else this.#holds.delete(robot);
    }
    this.#session.proceed(next.request, next.answer);
    this.#session.seek(Math.min(late, this.period / 2));
    this.#isProceeding = false;
    this.#begin(next.request, next.answer, this.#plays || playing);
  }
}
