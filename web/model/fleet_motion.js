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

export class FleetMotion {
  #session;
  #signals = new Signals();
  /** @type {Map<string, Motion> | null} */
  #byId = null;
  /** @type {ClearanceSweep | null} */
  #sweep = null;
  /** @type {{time: number | null, pair: {ids: string[], gap: number} | null}} */
  #nearest = { time: null, pair: null };

  /** The smallest gap over time, see clearanceOf; null without an answer, while that is outdated, and until it is computed. */
  curve = /** @type {any} */ (null);

  /** `compute(motions)` resolves to the curve, unless it is called again before. */
  constructor(session, compute) {
    this.#session = session;
    session.on("answer", () => {
      const { answer } = session;
      this.#byId = this.#sweep = this.curve = null;
      this.#nearest = { time: null, pair: null };
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
    const { scene, tracks } = this.#session;
    this.#byId ??= new Map(
      scene.robots.map((robot) => {
        const { actions, radii } = tracks.get(robot.id);
        return [robot.id, motionOf(robot, actions, radii)];
      }),
    );
    return this.#byId;
  }

  /** The two robots that are nearest to each other at a time: {ids, gap}, or null if there are no two. */
  nearestAt(time) {
    if (this.byId.size < 2) return null;
    if (time !== this.#nearest.time) {
      this.#sweep ??= new ClearanceSweep([...this.byId.values()]);
      const { first, second, gap } = this.#sweep.nearestAt(time);
      this.#nearest = { time, pair: { ids: this.#idsOf(first, second), gap } };
    }
    return this.#nearest.pair;
  }

  /** The smallest gap of the plan but for pairs at rest: {t, gap, ids}, or null. */
  get least() {
    if (this.curve === null || this.curve.gap[this.curve.least] === Infinity) return null; // or nobody moves
    return this.momentOf(this.curve.least);
  }

  /** When two are nearest in a window of the curve: {t, gap, ids}. */
  momentOf(window) {
    const { t, gap, first, second } = this.curve;
    return { t: t[window], gap: gap[window], ids: this.#idsOf(first[window], second[window]) };
  }

  #idsOf(first, second) {
    const { robots } = this.#session.scene;
    return [Math.min(first, second), Math.max(first, second)].map((at) => robots[at].id);
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
