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
function motionsOf(robots, tracks) {
  return new Map(
    robots.map((robot) => {
      const { actions, radii } = tracks.get(robot.id);
      return [robot.id, motionOf(robot, actions, radii)];
    }),
  );
}

/** The same motions of disks that include the distance which each robot keeps from others, its vicinity. */
function withVicinity(robots, motions) {
  const vicinities = new Map(robots.map(({ id, vicinity }) => [id, vicinity]));
  return new Map(
    [...motions].map(([id, motion]) => {
      const more = vicinities.get(id) ?? 0;
      const radii = motion.radii.map((each) => ({ ...each, radius: each.radius + more }));
      return [id, { ...motion, radius: motion.radius + more, radii }];
    }),
  );
}

/** The two robots that are nearest to each other. */
class NearestPair {
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
  #compute;
  #signals = new Signals();
  /** @type {Map<string, Motion> | null} */
  #byId = null;
  /** @type {Map<string, Motion> | null} */
  #keptFree = null;
  /** @type {NearestPair | null} */
  #nearest = null;
  /** @type {WeakMap<object, NearestPair>} */
  #nearestOfOthers = new WeakMap(); // by the tracks of another plan
  #beyondVicinity = false;

  /** The smallest gap over time, see clearanceOf; null without an answer, while that is outdated, and until it is computed. */
  curve = /** @type {any} */ (null);

  /** `compute(motions)` resolves to the curve, unless it is called again before. */
  constructor(session, compute) {
    this.#session = session;
    this.#compute = compute;
    session.on("answer", () => {
      this.#byId = this.#keptFree = null;
      this.#measure();
    });
  }

  /** Forgets the gaps, and computes them again. */
  #measure() {
    const { answer, outdated } = this.#session;
    this.#nearest = this.curve = null;
    this.#nearestOfOthers = new WeakMap();
    this.#signals.emit("curve");
    if (answer !== null && !outdated) this.#computeCurve();
  }

  async #computeCurve() {
    const { answer } = this.#session;
    const beyond = this.#beyondVicinity;
    const isShown = () => answer === this.#session.answer && beyond === this.#beyondVicinity;
    try {
      const curve = await this.#compute([...this.#measured(this.byId).values()]);
      if (!isShown()) return;
      this.curve = curve;
      this.#signals.emit("curve");
    } catch (error) {
      if (isShown() && !this.#session.problem) this.#session.fail(error, () => this.#computeCurve());
    }
  }

  /** Motions of the disks between which gaps are measured. */
  #measured(motions) {
    return this.#beyondVicinity ? withVicinity(this.#session.scene.robots, motions) : motions;
  }

  /** Whether gaps are between what robots keep free, their disks and vicinities, instead of their disks. */
  get beyondVicinity() {
    return this.#beyondVicinity;
  }

  set beyondVicinity(beyond) {
    if (beyond === this.#beyondVicinity) return;
    this.#beyondVicinity = beyond;
    this.#measure();
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

  /** The same motions of what the robots keep free, their disks and vicinities. */
  get keptFree() {
    this.#keptFree ??= withVicinity(this.#session.scene.robots, this.byId);
    return this.#keptFree;
  }

  /**
   * The two robots that are nearest to each other at a time, by the answer or by the tracks of another plan: {ids,
   * gap}. Null if there are no two robots.
   */
  nearestAt(time, tracks = this.#session.tracks) {
    if (tracks !== this.#session.tracks) return this.#nearestOf(tracks).at(time);
    this.#nearest ??= new NearestPair(this.#measured(this.byId));
    return this.#nearest.at(time);
  }

  #nearestOf(tracks) {
    let nearest = this.#nearestOfOthers.get(tracks);
    if (!nearest) {
      nearest = new NearestPair(this.#measured(motionsOf(this.#session.scene.robots, tracks)));
      this.#nearestOfOthers.set(tracks, nearest);
    }
    return nearest;
  }

  /** The smallest gap of the plan, without pairs at rest: {t, gap, ids}, or null. */
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
 * Makes a function that resolves to clearanceOf its motions, computed in a worker. A newer call replaces an older one.
 * It rejects with ProblemError if the worker fails.
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
