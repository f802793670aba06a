// Planning: the buttons that start and cancel it, and its progress: time, robots planned, the falling cost.

import { byId, element, setText, svgElement } from "../ui/dom.js";
import { count, grouped, seconds } from "../ui/format.js";
import { revealProblem } from "./problem_card.js";
import { summarize } from "./summary.js";

const CLOCK_MS = 100;
const QUICK_MS = 400; // planning that ends sooner shows no progress, which would only move what is below it
const LATE = 10; // seconds after the time budget
const LATE_WORDS = "The service is late: its time budget is over. You can wait, or cancel.";
const WIDTH = 320;
const HEIGHT = 44;
const EDGE = 3;
const OTHER = { flowtime: "makespan", makespan: "flowtime" };

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
    session.on("incumbent", (isFirst) => isFirst && this.#play());
  }

  /** Plans, and plays the plan. */
  async press() {
    const session = this.#session;
    const solved = await session.plan(budgetOf(session.request, session.limits));
    if (session.problem !== null) revealProblem();
    if (!solved) return;
    const watching = document.activeElement === this.#plan; // which regains the focus from Cancel
    session.announce(summarize(session.answer));
    if (!session.player.playing && session.player.time === 0) this.#play();
    if (watching) this.#transport.focusPlay();
  }

  #play() {
    if (!matchMedia("(prefers-reduced-motion: reduce)").matches) this.#session.play();
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

/** The time budget of a request, seconds, or null if unknown. `limits`: the limits of the service. */
export function budgetOf(request, limits) {
  const asked = request?.options?.time_budget_ms ?? limits.default_budget_ms;
  if (!(asked > 0)) return null;
  return Math.min(asked, limits.max_budget_ms ?? asked) / 1000;
}

/** The progress of planning, in words; the cost that the plan minimises comes first. */
export function describeProgress({ attempt, planned, robots, best }, objective) {
  const done = `${grouped(planned)} of ${count(robots, "robot")} planned`;
  const again = attempt > 1 ? `, attempt ${grouped(attempt)}` : "";
  if (best === null) return `${done}${again}`;
  const costs = [objective, OTHER[objective]].map((name) => `${name} ${seconds(best[name])}`);
  return `${done}${again}, ${costs.join(", ")}`;
}

export class PlanningStatus {
  #session;
  #since = 0; // when planning began, or begins again: of performance.now()
  #elapsed = byId("elapsed");
  #box = byId("planning");
  #bar = byId("budget");
  #soFar = byId("so-far");
  #curve = byId("cost-curve");
  /** @type {number | null} */
  #timer = null;
  #reveal = 0; // the timer that shows the progress

  constructor(session) {
    this.#session = session;
    session.on("planning", () => {
      if (session.planning === null) this.#end();
      else if (this.#timer === null) this.#begin();
      else this.#show();
    });
  }

  #begin() {
    this.#since = performance.now();
    const { budget } = this.#session.planning;
    this.#reveal = setTimeout(() => (this.#elapsed.hidden = this.#box.hidden = false), QUICK_MS);
    setText(this.#soFar, "");
    this.#curve.hidden = true;
    this.#bar.hidden = budget === null;
    this.#bar.max = budget ?? 1;
    const limit = budget === null ? "" : ` of ${budget.toFixed(1)}`;
    const show = () => {
      const passed = Math.max(0, performance.now() - this.#since) / 1000;
      setText(this.#elapsed, `Planning ${passed.toFixed(1)}${limit} s`);
      this.#bar.value = passed;
      if (budget !== null && passed > budget + LATE) setText(this.#soFar, LATE_WORDS);
    };
    show();
    this.#timer = setInterval(show, CLOCK_MS);
  }

  #show() {
    const { progress, costs, objective, waiting } = this.#session.planning;
    if (waiting !== null) {
      this.#since = performance.now() + waiting * 1000;
      setText(this.#soFar, `The service is busy. Retrying in ${count(waiting, "second")}.`);
      return;
    }
    setText(this.#soFar, describeProgress(progress, objective));
    drawCosts(this.#curve, costs, objective, progress.elapsed_ms);
  }

  #end() {
    clearTimeout(this.#reveal);
    clearInterval(this.#timer ?? undefined);
    this.#timer = null;
    this.#elapsed.hidden = this.#box.hidden = true;
  }
}

/** Draws how the objective fell, of costs [{elapsed_ms, flowtime, makespan}], up to now; hidden until it did. */
function drawCosts(box, costs, objective, now_ms) {
  box.hidden = costs.length < 2;
  if (box.hidden) return;
  const points = costs.map((cost) => ({ t: cost.elapsed_ms, value: cost[objective] }));
  const svg = svgElement("svg", { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, preserveAspectRatio: "none" });
  svg.append(svgElement("path", { d: stepsOf(points, now_ms) }));
  const [first, last] = [points[0].value, points[points.length - 1].value];
  const share = (((first - last) / first) * 100).toFixed(1);
  const name = objective === "makespan" ? "Makespan" : "Flowtime";
  const words = `${name} fell from ${seconds(first)} to ${seconds(last)} (−${share} %)`;
  svg.setAttribute("role", "img");
  svg.setAttribute("aria-label", words);
  const caption = element("p", { class: "facts", textContent: words, "aria-hidden": "true" });
  box.replaceChildren(svg, caption);
}

/** The path of a curve that falls in steps from the first of the points {t, value} to the last. */
function stepsOf(points, now) {
  const [first, last] = [points[0], points[points.length - 1]];
  const x = (t) => EDGE + ((t - first.t) / Math.max(1, now - first.t)) * (WIDTH - 2 * EDGE);
  const y = (value) => EDGE + ((first.value - value) / (first.value - last.value)) * (HEIGHT - 2 * EDGE);
  const steps = points.slice(1).map(({ t, value }) => `H${x(t)}V${y(value)}`);
  return `M${x(first.t)} ${y(first.value)}${steps.join("")}H${x(now)}`;
}
