// Which robots are listed: by a part of their ids, by what they do now, and by their delay. No DOM.

import { delayOf } from "./gantt.js";
import { Signals } from "./signals.js";

/** @import {Robot} from "./types.js" */

const NONE = { text: "", doing: "all", delay: 0 };
const DELAYED = "delayed";

/**
 * Whether a robot passes a filter {text, doing, delay}. `text` is a part of its id in any case. `doing` is "all", a
 * state (see robotStateAt), or "delayed": the robot's cost is more than `delay` seconds above its lower bound.
 */
export function passes(filter, id, state, track) {
  if (!id.toLowerCase().includes(filter.text.trim().toLowerCase())) return false;
  if (filter.doing === DELAYED) return delayOf(track) > filter.delay;
  return filter.doing === "all" || filter.doing === state;
}

export class RobotFilter {
  #session;
  #signals = new Signals();
  #filter = NONE;
  /** @type {Robot[]} */
  #robots = [];

  constructor(session) {
    this.#session = session;
    session.on("answer", () => this.#apply());
  }

  /** The robots that pass, in the order of the request. */
  get robots() {
    return this.#robots;
  }

  /** Whether it lets all robots pass. */
  get isOpen() {
    return this.#filter.text.trim() === "" && this.#filter.doing === "all";
  }

  /** `listener` is called after each answer, and when other robots pass. */
  onChange(listener) {
    this.#signals.on("change", listener);
  }

  /** Sets some of {text, doing, delay}. */
  set(changes) {
    this.#filter = { ...this.#filter, ...changes };
    this.#apply();
  }

  /** To be called when time has passed: robots may be in other states. */
  refresh() {
    if (this.#filter.doing === "all" || this.#filter.doing === DELAYED) return;
    const now = this.#passing();
    if (now.length === this.#robots.length && now.every((robot, at) => robot === this.#robots[at])) return;
    this.#set(now);
  }

  /** The next robot that passes after `id` in the list, or before it (direction -1), around its ends; or null. */
  next(id, direction = 1) {
    const count = this.#robots.length;
    if (count === 0) return null;
    const at = this.#robots.findIndex((robot) => robot.id === id);
    const from = at < 0 && direction < 0 ? 0 : at;
    return this.#robots[(from + direction + count) % count].id;
  }

  /** The ids from one robot to another in the list, both included, in this direction. */
  range(from, to) {
    const ids = this.#robots.map(({ id }) => id);
    const [first, last] = [ids.indexOf(from), ids.indexOf(to)];
    if (first < 0 || last < 0) return [to];
    return first <= last ? ids.slice(first, last + 1) : ids.slice(last, first + 1).reverse();
  }

  #apply() {
    this.#set(this.#passing());
  }

  #set(robots) {
    this.#robots = robots;
    this.#signals.emit("change");
  }

  #passing() {
    const { scene, tracks } = this.#session;
    return scene.robots.filter(({ id }) =>
      passes(this.#filter, id, this.#session.stateOf(id), tracks.get(id)),
    );
  }
}
