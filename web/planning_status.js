// What is told while a plan is being made: the time, and how far it has got.

import { byId, setText } from "./dom.js";
import { count, seconds } from "./format.js";

const CLOCK_MS = 100;

/** Seconds that planning a request may take, or null if that is not known. `limits` are those of the service. */
export function budgetOf(request, limits) {
  const asked = request?.options?.time_budget_ms ?? limits.default_budget_ms;
  if (!(asked > 0)) return null;
  return Math.min(asked, limits.max_budget_ms ?? asked) / 1000;
}

/** How far planning has got, in words. */
export function describeProgress({ planned, robots, best }) {
  const done = `${planned.toLocaleString("en")} of ${count(robots, "robot")} planned`;
  return best === null ? done : `${done}, flowtime ${seconds(best.flowtime)}`;
}

export class PlanningStatus {
  #elapsed = byId("elapsed");
  #box = byId("planning");
  #bar = byId("budget");
  #soFar = byId("so-far");
  #timer = null;

  /** Planning begins, and may take so many seconds (null: unknown). */
  begin(budget) {
    const since = performance.now();
    this.#elapsed.hidden = this.#box.hidden = false;
    setText(this.#soFar, "");
    this.#bar.hidden = budget === null;
    this.#bar.max = budget ?? 1;
    const limit = budget === null ? "" : ` of ${budget.toFixed(1)}`;
    const show = () => {
      const passed = (performance.now() - since) / 1000;
      setText(this.#elapsed, `Planning ${passed.toFixed(1)}${limit} s`);
      this.#bar.value = passed;
    };
    show();
    this.#timer = setInterval(show, CLOCK_MS);
  }

  show(progress) {
    setText(this.#soFar, describeProgress(progress));
  }

  end() {
    clearInterval(this.#timer);
    this.#elapsed.hidden = this.#box.hidden = true;
  }
}
