// What is told while a plan is being made: the time, how far it has got, and how its cost falls.

import { byId, setText } from "../ui/dom.js";
import { count, seconds } from "../ui/format.js";
import { drawCosts } from "./cost_curve.js";

const CLOCK_MS = 100;

/** Seconds that planning a request may take, or null if that is not known. `limits` are those of the service. */
export function budgetOf(request, limits) {
  const asked = request?.options?.time_budget_ms ?? limits.default_budget_ms;
  if (!(asked > 0)) return null;
  return Math.min(asked, limits.max_budget_ms ?? asked) / 1000;
}

/** How far planning has got, in words. */
export function describeProgress({ attempt, planned, robots, best }) {
  const done = `${planned.toLocaleString("en")} of ${count(robots, "robot")} planned`;
  const again = attempt > 1 ? `, attempt ${attempt.toLocaleString("en")}` : "";
  return `${done}${again}${best === null ? "" : `, flowtime ${seconds(best.flowtime)}`}`;
}

export class PlanningStatus {
  #session;
  #elapsed = byId("elapsed");
  #box = byId("planning");
  #bar = byId("budget");
  #soFar = byId("so-far");
  #curve = byId("cost-curve");
  #timer = null;

  constructor(session) {
    this.#session = session;
    session.on("planning", () => {
      if (session.planning === null) this.#end();
      else if (this.#timer === null) this.#begin();
      else this.#show();
    });
  }

  #begin() {
    const since = performance.now();
    const { budget } = this.#session.planning;
    this.#elapsed.hidden = this.#box.hidden = false;
    setText(this.#soFar, "");
    this.#curve.hidden = true;
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

  #show() {
    const { progress, costs } = this.#session.planning;
    setText(this.#soFar, describeProgress(progress));
    drawCosts(this.#curve, costs, progress.elapsed_ms);
  }

  #end() {
    clearInterval(this.#timer);
    this.#timer = null;
    this.#elapsed.hidden = this.#box.hidden = true;
  }
}
