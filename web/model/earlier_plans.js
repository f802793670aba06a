// The plans that were shown before the present one, to compare them. No DOM.

import { robotsOf } from "./listed.js";
import { Signals } from "./signals.js";

const MAX = 5;

export class EarlierPlans {
  #session;
  #signals = new Signals();
  #request;
  #shown = []; // answers, the latest last
  #asked = false; // to compare, before anyone listened

  constructor(session) {
    this.#session = session;
    this.#request = session.request;
    session.on("request", ({ opened }) => {
      if (opened && !isSameTask(this.#request, session.request)) this.#shown = [];
      this.#request = session.request;
    });
    session.on("answer", () => this.#note(session.answer));
  }

  /** Asks to compare the present plan with the one before. */
  compare() {
    this.#asked = true;
    this.#signals.emit("asked");
  }

  /** Calls `listener` when a comparison is asked for; at once if that was before. */
  onAsked(listener) {
    this.#signals.on("asked", listener);
    if (this.#asked) listener();
  }

  /** The answers before the present one, the latest first. */
  get all() {
    return this.#shown.filter((answer) => answer !== this.#session.answer).reverse();
  }

  #note(answer) {
    const isFinal = this.#session.planning === null;
    if (!isFinal || answer === null || answer.plans.length === 0) return;
    this.#shown = [...this.#shown.filter((each) => each !== answer), answer].slice(-MAX - 1);
  }
}

/** Whether two requests have the same robots, from the same starts to the same goals, on the same map. */
export function isSameTask(request, other) {
  return isSame(request?.map, other?.map) && isSame(tasksOf(request), tasksOf(other));
}

function tasksOf(request) {
  return robotsOf(request).map((robot) => [robot?.id, robot?.start, robot?.goals ?? [robot?.goal]]);
}

/** Whether two JSON values are the same. */
function isSame(value, other) {
  if (value === other) return true;
  if (typeof value !== "object" || typeof other !== "object" || value === null || other === null)
    return false;
  const keys = Object.keys(value);
  return keys.length === Object.keys(other).length && keys.every((key) => isSame(value[key], other[key]));
}
