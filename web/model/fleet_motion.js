// The motions of all robots under the session's answer, and their clearance. No DOM; the computation of the
// curve is passed in.

import { ClearanceSweep } from "./clearance.js";
import { motionOf } from "./motion.js";
import { ProblemError } from "./problem.js";
import { Signals } from "./signals.js";

/** @import {Motion} from "./types.js" */

const NOT_COMPUTED = {
  title: "The gaps over time are not known",
  detail: "The part of the page that computes them did not load, or failed.",
};
const WORKER = new URL("./clearance_worker.js", import.meta.url);

/**
 * The motions of robots by id, in their order.
 * @returns {Map<string, Motion>}
 */
export function motionsOf(robots, tracks) {
  return new Map(
    robots.map((robot) => {
      const { actions, radii } = tracks.get(robot.id);
      return [robot.id, motionOf(robot, actions, radii)];
    }),
  );
}

/** The two robots that are nearest to each other. */
export class NearestPair {
  #ids;
  #sweep;
  /** @type {{time: number | null, pair: {ids: string[], gap: number} | null}} */
  #last = { time: null, pair: null };

  /** `motions`: see motionsOf. */
  constructor(motions) {
    this.#ids = [...motions.keys()];
    this.#sweep = this.#ids.length < 2 ? null : new ClearanceSweep([...motions.values()]);
  }

  /** At a time: {ids, gap}, or null if there are no two. */
  at(time) {
    if (this.#sweep === null) return null;
    if (time !== this.#last.time) {
      const { first, second, gap } = this.#sweep.nearestAt(time);
      this.#last = { time, pair: { ids: idsOf(this.#ids, first, second), gap } };
    }
    return this.#last.pair;
  }
}

const idsOf = (ids, first, second) => [Math.min(first, second), Math.max(first, second)].map((at) => ids[at]);

export class FleetMotion {
  #session;
  #signals = new Signals();
  /** @type {Map<string, Motion> | null} */
  #byId = null;
  /** @type {NearestPair | null} */
  #nearest = null;

  /** The smallest gap over time, see clearanceOf; null without an answer, while that is outdated, and until it is computed. */
  curve = /** @type {any} */ (null);

  /** `compute(motions)` resolves to the curve, unless it is called again before. */
  constructor(session, compute) {
    this.#session = session;
    session.on("answer", () => {
      const { answer } = session;
      this.#byId = this.#nearest = this.curve = null;
      this.#signals.emit("curve");
      if (answer !== null && !session.outdated) this.#compute(compute);
    });
  }

  async #compute(compute) {
    const { answer } = this.#session;
    try {
      const curve = await compute([...this.byId.values()]);
      if (answer !== this.#session.answer) return;
      this.curve = curve;
      this.#signals.emit("curve");
    } catch (error) {
      const isShown = answer === this.#session.answer && !this.#session.problem;
      if (isShown) this.#session.fail(error, () => this.#compute(compute));
    }
  }

  /** `listener` is called when the curve changes. */
  onCurve(listener) {
    this.#signals.on("curve", listener);
  }

  /** The motions of all robots by id, in the order of the scene. */
  get byId() {
    this.#byId ??= motionsOf(this.#session.scene.robots, this.#session.tracks);
    return this.#byId;
  }

  /** The two robots that are nearest to each other at a time: {ids, gap}, or null if there are no two. */
  nearestAt(time) {
    this.#nearest ??= new NearestPair(this.byId);
    return this.#nearest.at(time);
  }

  /** The smallest gap of the plan but for pairs at rest: {t, gap, ids}, or null. */
  get least() {
    if (this.curve === null || this.curve.gap[this.curve.least] === Infinity) return null; // or nobody moves
    return this.momentOf(this.curve.least);
  }

  /** When two are nearest in a window of the curve: {t, gap, ids}. */
  momentOf(window) {
    const { t, gap, first, second } = this.curve;
    const ids = this.#session.scene.robots.map(({ id }) => id);
    return { t: t[window], gap: gap[window], ids: idsOf(ids, first[window], second[window]) };
  }
}

/**
 * A function that resolves to clearanceOf the motions that it is given, computed in a worker, unless it is called again
 * before; it rejects with ProblemError if the worker fails.
 */
export function clearanceJob() {
  let worker = null;
  let busy = false;
  return (motions) =>
    new Promise((resolve, reject) => {
      if (busy) worker.terminate();
      if (busy || worker === null) worker = new Worker(WORKER, { type: "module" });
      busy = true;
      worker.onmessage = ({ data }) => {
        busy = false;
        resolve(data);
      };
      worker.onerror = () => {
        busy = false;
        worker = null;
        reject(new ProblemError(NOT_COMPUTED));
      };
      worker.postMessage(motions);
    });
}
