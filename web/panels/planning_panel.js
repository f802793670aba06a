// Planning: the buttons that start and cancel it, and its progress: time, robots planned, the falling cost.

import { byId, setText, svgElement } from "../ui/dom.js";
import { count, seconds } from "../ui/format.js";
import { revealProblem } from "./problem_card.js";
import { summarize } from "./summary.js";

const CLOCK_MS = 100;
const WIDTH = 320;
const HEIGHT = 44;
const EDGE = 3;

export class PlanButton {
  #session;
  #transport;
  #plan = byId("plan");
  #cancel = byId("cancel");

  constructor(session, transport) {
    this.#session = session;
    this.#transport = transport;
    this.#plan.addEventListener("click", () => this.press());
    this.#cancel.addEventListener("click", () => session.cancel());
    session.on("request planning", () => this.#refresh());
  }

  /** Plans, and plays the plan. */
  async press() {
    const session = this.#session;
    const solved = await session.plan(budgetOf(session.request, session.limits));
    if (!solved) {
      if (session.problem !== null) revealProblem();
      return;
    }
    const watching = document.activeElement === this.#plan; // which regains the focus from Cancel
    session.announce(summarize(session.answer));
    if (!matchMedia("(prefers-reduced-motion: reduce)").matches) session.play();
    if (watching) this.#transport.focusPlay();
  }

  #refresh() {
    const planning = this.#session.planning !== null;
    const focused = document.activeElement;
    this.#cancel.hidden = !planning;
    byId("facts").hidden = planning;
    this.#plan.disabled = planning || this.#session.request === null;
    if (planning && focused === this.#plan) this.#cancel.focus();
    if (!planning && focused === this.#cancel) this.#plan.focus();
  }
}

/** The time budget of a request, seconds, or null if unknown. `limits` are those of the service. */
export function budgetOf(request, limits) {
  const asked = request?.options?.time_budget_ms ?? limits.default_budget_ms;
  if (!(asked > 0)) return null;
  return Math.min(asked, limits.max_budget_ms ?? asked) / 1000;
}

/** The progress of planning, in words. */
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
  /** @type {number | null} */
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
    clearInterval(this.#timer ?? undefined);
    this.#timer = null;
    this.#elapsed.hidden = this.#box.hidden = true;
  }
}

/** Draws the costs, [{elapsed_ms, flowtime}], up to now; hidden until there are two. */
export function drawCosts(box, costs, now_ms) {
  box.hidden = costs.length < 2;
  if (box.hidden) return;
  const first = costs[0];
  const last = costs[costs.length - 1];
  const span = Math.max(1, now_ms - first.elapsed_ms);
  const fall = Math.max(1e-9, first.flowtime - last.flowtime);
  const x = (elapsed) => EDGE + ((elapsed - first.elapsed_ms) / span) * (WIDTH - 2 * EDGE);
  const y = (cost) => EDGE + ((first.flowtime - cost) / fall) * (HEIGHT - 2 * EDGE);
  let path = `M${x(first.elapsed_ms)} ${y(first.flowtime)}`;
  for (const { elapsed_ms, flowtime } of costs.slice(1)) path += `H${x(elapsed_ms)}V${y(flowtime)}`;
  path += `H${x(now_ms)}`;
  const svg = svgElement("svg", { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, preserveAspectRatio: "none" });
  svg.append(svgElement("path", { d: path }));
  const share = ((fall / first.flowtime) * 100).toFixed(1);
  const words = `Flowtime fell from ${seconds(first.flowtime)} to ${seconds(last.flowtime)} (−${share} %)`;
  svg.setAttribute("role", "img");
  svg.setAttribute("aria-label", words);
  const caption = document.createElement("p");
  caption.className = "facts";
  caption.textContent = words;
  caption.setAttribute("aria-hidden", "true");
  box.replaceChildren(svg, caption);
}
