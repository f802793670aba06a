// Simulating delays: a form with a policy and disturbances, its figures as charts, and runs played with the planned
// poses as ghosts beside.

import {
  answerOfRun,
  FIRST_FORM,
  mostDelayed,
  percent,
  POLICIES,
  simulationOf,
} from "../model/simulation.js";
import { nearestAmong } from "../model/comparison.js";
import { robotChip } from "../panels/robot_list.js";
import { element, setText } from "../ui/dom.js";
import { showMoment } from "../scene/pair_view.js";
import { count, metres, seconds } from "../ui/format.js";
import { quantileRows, shareBar } from "./charts.js";
import { button, choicePart, numberPart } from "./fields.js";
import { RobustSection } from "./robust_section.js";

const MAX_ROBOTS = 12; // in the chart of delays
const MAX_LISTED = 8;
const BEFORE = 2; // seconds before a collision at which its run is played
const NUMBERS = {
  slowest: ["Minimum speed", "%", { min: 0.1, max: 100 }],
  stops: ["Stops", "per hour", { min: 0, max: 36000 }],
  stop: ["Mean stop", "s", { min: 0 }],
  start: ["Start delay", "s, max", { min: 0 }],
  sideways: ["Lateral error", "mm", { min: 0 }],
  maxDelay: ["Max delay", "s", { min: 0 }],
  runs: ["Executions", "", { min: 1, max: 100000, step: 1 }],
  seed: ["Seed", "", { min: 0, step: 1 }],
};

export class SimulationSection {
  #page;
  #session;
  #form = /** @type {any} */ ({}); // name -> {field, input}
  #run = button("Simulate", () => this.#simulate(), { class: "primary" });
  #status = element("p", { class: "facts", role: "status" });
  #results = element("div", { class: "results" });
  #robust;
  /** @type {any} */
  #plan = null; // the answer that is simulated, while one of its runs is played
  /** @type {any} */
  #played = null; // the answer that is such a run

  #isAsking = false;

  element;

  /** `page`: see fillAnalysis, with ghosts. */
  constructor(page) {
    this.#page = page;
    this.#session = page.session;
    const { policy, ...numbers } = FIRST_FORM;
    this.#form.policy = choicePart("Policy", POLICIES, policy);
    for (const [name, value] of Object.entries(numbers)) {
      const [label, unit, limits] = NUMBERS[name];
      this.#form[name] = numberPart(label, unit, value, limits);
    }
    const fields = Object.keys(numbers).map((name) => this.#form[name].field);
    this.element = element(
      "div",
      { class: "simulation" },
      this.#form.policy.field,
      element("div", { class: "parts" }, ...fields),
      element("div", { class: "row" }, this.#run),
      this.#status,
      this.#results,
    );
    this.#form.policy.input.addEventListener("change", () => this.#refresh());
    const useDependencies = () => {
      this.#form.policy.input.value = "dependencies";
      this.#refresh();
    };
    this.#robust = new RobustSection(page, () => this.#validForm(), useDependencies);
    this.#session.on("answer", () => this.#onAnswer());
    this.#refresh();
  }

  get #values() {
    const read = ([name, { input }]) => [name, name === "policy" ? input.value : input.valueAsNumber];
    return Object.fromEntries(Object.entries(this.#form).map(read));
  }

  #onAnswer() {
    const { answer } = this.#session;
    if (answer === this.#played && this.#session.hasPlan) return;
    this.#page.ghosts.show(null);
    if (answer === null || answer !== this.#plan) {
      this.#robust.reset();
      this.#results.replaceChildren();
    }
    this.#plan = this.#played = null;
    this.#refresh();
  }

  #refresh() {
    this.#form.maxDelay.field.hidden = this.#form.policy.input.value !== "clock_stop";
    const ready = this.#session.hasPlan;
    this.#run.disabled = !ready;
    setText(this.#status, ready ? "" : "Plan first: a simulation executes a plan many times.");
  }

  /** The values of the form; null, and the page says why, if one is invalid. */
  #validForm() {
    const wrong = Object.values(this.#form).find(
      ({ field, input }) => !field.hidden && !input.reportValidity(),
    );
    return wrong ? null : this.#values;
  }

  async #simulate() {
    const form = this.#validForm();
    if (form === null) return;
    const plan = this.#plan ?? this.#session.answer;
    await this.#asking(plan, async () => {
      const simulated = await this.#ask(plan, form, null);
      if (plan === (this.#plan ?? this.#session.answer)) this.#show(plan, form, simulated);
      this.#session.announce(`Collisions in ${percent(simulated.collision_share)} of the executions.`);
    });
  }

  /** Asks the service for a simulation, or for one run of it. */
  async #ask(plan, form, trace) {
    const { service } = this.#page;
    const { request } = this.#session;
    const { dependencies } = form.policy === "dependencies" ? await service.dependencies(request, plan) : {};
    const body = simulationOf(request, plan, form, dependencies, trace);
    return service.simulate(JSON.stringify(body), ({ runs, done }) =>
      setText(this.#status, `${done} of ${count(runs, "execution")}`),
    );
  }

  async #asking(plan, work) {
    if (this.#isAsking) return;
    this.#isAsking = true;
    this.#run.setAttribute("aria-disabled", "true"); // unlike `disabled`, it keeps the focus
    setText(this.#status, "Executing…");
    this.#session.announce("Executing.");
    try {
      await work();
      setText(this.#status, "");
    } catch (error) {
      setText(this.#status, "");
      this.#session.fail(error);
    } finally {
      this.#isAsking = false;
      this.#run.removeAttribute("aria-disabled");
      this.#run.disabled = !this.#session.hasPlan;
    }
  }

  #show(plan, form, simulated) {
    this.#robust.reset();
    const { runs, collision_share, deadlock_share, robots, pairs, warnings } = simulated;
    const delays = mostDelayed(robots, MAX_ROBOTS).map(({ robot, delay }) => ({ name: robot, ...delay }));
    const whole = ["makespan", "flowtime"].filter((name) => simulated[name] !== null);
    const rows = whole.map((name) => ({
      name,
      ...scaled(simulated[name], simulated.planned[name]),
    }));
    this.#results.replaceChildren(
      shareBar(`of ${count(runs, "execution")} have a collision`, collision_share, percent(collision_share)),
      deadlock_share > 0 ? shareBar("end in a deadlock", deadlock_share, percent(deadlock_share)) : "",
      rows.length > 0 ? quantileRows("Increase over the plan", rows, (value) => `+${percent(value)}`) : "",
      delays.length > 0 ? quantileRows("Robot delays", delays, seconds) : "",
      this.#pairs(pairs),
      collision_share > 0 || deadlock_share > 0 ? this.#robust.element : "",
      this.#collisions(plan, form, simulated.first_collisions),
      this.#player(plan, form, runs),
      ...warnings.map((warning) => element("p", { class: "facts", textContent: warning })),
    );
  }

  #pairs(pairs) {
    if (pairs.length === 0) return "";
    const items = pairs
      .slice(0, MAX_LISTED)
      .map(({ robots, share }) =>
        element(
          "li",
          { class: "chips" },
          ...robots.map((id) => robotChip(this.#session, id)),
          ` ${percent(share)}`,
          this.#nearestOf(robots),
        ),
      );
    return titled("Colliding pairs", element("ul", { class: "plain" }, ...items));
  }

  /** Leads to the moment of the plan at which two robots are nearest, with both selected. */
  #nearestOf(robots) {
    const { fleet, stage } = this.#page;
    const nearest = nearestAmong(robots, fleet.byId);
    if (nearest === null) return "";
    const words = `${metres(nearest.gap)} apart at ${seconds(nearest.t)}`;
    return button(words, () => showMoment(this.#session, stage, nearest.ids, nearest.t), { class: "quiet" });
  }

  #collisions(plan, form, collisions) {
    if (collisions.length === 0) return "";
    const items = collisions.slice(0, MAX_LISTED).map(({ run, robots, with: other, t }) => {
      const words = `Execution ${run}: ${robots.join(" and ")}${other === "wall" ? " and a wall" : ""} at ${seconds(t)}`;
      return element(
        "li",
        {},
        button(words, () => this.#play(plan, form, run, t, robots), { class: "quiet" }),
      );
    });
    return titled("First collisions", element("ul", { class: "plain" }, ...items));
  }

  #player(plan, form, runs) {
    const number = numberPart("Execution", "", 0, { min: 0, max: runs - 1, step: 1 });
    const play = button(
      "Play",
      () => number.input.reportValidity() && this.#play(plan, form, number.input.valueAsNumber),
    );
    const back = button("Back to the plan", () => this.#session.adopt(plan));
    return titled(
      "Play an execution",
      element("p", { class: "facts", textContent: "Dashed rings show the planned positions." }),
      element("div", { class: "row" }, number.field, play, back),
    );
  }

  /** Plays a run, from shortly before t, with the planned poses as ghosts. */
  async #play(plan, form, run, t = 0, robots = []) {
    await this.#asking(plan, async () => {
      const { trace } = await this.#ask(plan, form, run);
      if (plan !== (this.#plan ?? this.#session.answer)) return;
      this.#plan = plan;
      this.#played = answerOfRun(plan, trace);
      this.#session.adopt(this.#played);
      this.#page.ghosts.show(plan);
      this.#session.highlight(robots);
      this.#session.seek(Math.max(0, t - BEFORE));
      this.#session.play();
    });
  }
}

/** A distribution as shares above the planned value. */
function scaled(distribution, planned) {
  return Object.fromEntries(
    Object.entries(distribution).map(([name, value]) => [name, planned > 0 ? value / planned - 1 : 0]),
  );
}

function titled(title, ...content) {
  return element("div", {}, element("h2", { textContent: title }), ...content);
}
