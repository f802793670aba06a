// Compares two plans of one request. The other plan is played in lockstep, in its own scene or as ghosts. The
// differences are listed robot by robot.

import { belongsTo, readDocument } from "../model/plan_file.js";
import { differences, previousPlans, summed } from "../model/plan_difference.js";
import { ProblemError } from "../model/problem.js";
import { robotChip } from "../panels/robot_list.js";
import { element, setText } from "../ui/dom.js";
import { count, seconds } from "../ui/format.js";
import { button, choicePart } from "./fields.js";

const NONE = { value: "", label: "nothing" };
const PREVIOUS = { value: "previous", label: "the request’s previous plans" };
const FILE = { value: "file", label: "the plan file" };
const VIEWS = [
  { value: "beside", label: "side by side" },
  { value: "over", label: "as dashed rings over this plan" },
];
const MAX = 200; // rows
const CHANGES = {
  same: "same",
  times: "different times",
  path: "different path",
  "only here": "no plan before",
  "only there": "no plan now",
};

export class CompareSection {
  #page;
  #session;
  #choice = choicePart("Compare the plan with", [NONE], "");
  #view = choicePart("Show the other plan", VIEWS, "beside");
  #file = element("input", { type: "file", accept: ".json", hidden: true });
  #swap = button("Swap", () => this.#swapPlans(), {
    class: "quiet",
    title: "Exchange the two plans",
  });
  #verdict = element("p", { class: "fault", role: "status" }); // on a plan that is not valid
  #result = element("div", { class: "results" });
  /** @type {any} */
  #opened = null; // the answer of a file
  /** @type {any} */
  #other = null; // the plans compared with: {answer (or null), plans}

  element;

  /** `page`: see fillAnalysis, with ghosts, and other, see OtherScene. */
  constructor(page) {
    this.#page = page;
    this.#session = page.session;
    const open = button("A plan file…", () => this.#file.click(), { class: "quiet" });
    this.element = element(
      "div",
      { class: "simulation" },
      this.#choice.field,
      element("div", { class: "row" }, open, this.#swap, this.#file),
      this.#view.field,
      this.#verdict,
      this.#result,
    );
    this.#view.input.addEventListener("change", () => this.#show());
    this.#choice.input.addEventListener("change", () => this.#compare());
    this.#file.addEventListener("change", () => this.#openFile());
    this.#session.on("request", ({ opened }) => opened && (this.#opened = null));
    this.#session.on("answer", () => this.#onAnswer());
    this.#session.on("check", () => this.#judge());
    this.#onAnswer();
  }

  /** Compares with the plan before the present one. */
  withPlanBefore() {
    this.#choice.input.value = "before 0";
    this.#compare();
  }

  /** What the plan can be compared with: [{value, label, answer, plans}]. */
  get #sources() {
    const { earlier } = this.#page;
    const before = earlier.all.map((answer, at) => {
      const label = `${at === 0 ? "the preceding plan" : `${at + 1} plans earlier`}, flowtime ${seconds(answer.flowtime)}`;
      return { value: `before ${at}`, label, answer, plans: answer.plans };
    });
    const previous = previousPlans(this.#session.request);
    return [
      ...before,
      ...(previous === null ? [] : [{ ...PREVIOUS, answer: null, plans: previous }]),
      ...(this.#opened === null ? [] : [{ ...FILE, answer: this.#opened, plans: this.#opened.plans }]),
    ];
  }

  #onAnswer() {
    const { answer, hasPlan } = this.#session;
    if (this.#other !== null && this.#other.answer !== answer && hasPlan) this.#list(this.#other);
    else this.#list(null);
    this.#compare();
  }

  /** Lists the sources, including the chosen one. */
  #list(chosen) {
    const { input } = this.#choice;
    const sources = this.#session.hasPlan ? this.#sources : [];
    const options = [NONE, ...sources].map(({ value, label }) =>
      element("option", { value, textContent: label }),
    );
    input.replaceChildren(...options);
    const isChosen = ({ answer, plans }) =>
      chosen !== null && (answer ?? plans) === (chosen.answer ?? chosen.plans);
    input.value = sources.find(isChosen)?.value ?? "";
    input.disabled = sources.length === 0;
  }

  #compare() {
    const { value } = this.#choice.input;
    const had = this.#other !== null;
    this.#other = this.#sources.find((source) => source.value === value) ?? null;
    this.#swap.disabled = !this.#other?.answer;
    this.#view.field.hidden = this.#other === null;
    this.#result.replaceChildren();
    this.#judge();
    if (had || this.#other !== null) this.#show();
    if (this.#other === null) return;
    const { plans } = this.#other;
    const { player, answer } = this.#session;
    player.duration = Math.max(player.duration, ...plans.map(({ cost }) => cost)); // so that both end
    this.#result.append(...this.#describe(differences(answer.plans, plans)));
  }

  /** Tells if the plan is not valid, as far as it was checked. */
  #judge() {
    const { valid = true, violations = [], violations_total = violations.length } = this.#session.check ?? {};
    const isWrong = !valid && this.#other !== null;
    const words = `This plan is not valid: ${count(violations_total, "violation")}, listed under Plan.`;
    this.#verdict.hidden = !isWrong;
    setText(this.#verdict, isWrong ? words : "");
  }

  /** Shows the other plan, if there is one, as chosen. */
  #show() {
    const { ghosts, other } = this.#page;
    const isBeside = this.#view.input.value === "beside";
    const { plans = null, answer = null, label } = this.#other ?? {};
    const shown = plans && (answer ?? { plans, unplanned: [] });
    ghosts.show(isBeside ? null : shown);
    other.show(isBeside ? shown : null, [
      `this plan, flowtime ${seconds(this.#session.answer?.flowtime ?? 0)}`,
      label,
    ]);
  }

  #describe(rows) {
    const { robots, changed, flowtime, makespan } = summed(rows);
    const words = `${changed} of ${count(robots, "robot")} changed; flowtime ${signed(flowtime)}, makespan ${signed(makespan)}`;
    const head = ["Robot", "Cost, s", "Other, s", "Difference", "Change"].map((textContent) =>
      element("th", { scope: "col", textContent }),
    );
    const body = rows.slice(0, MAX).map(({ id, cost, other, difference, change }) => {
      const cells = [
        fixed(cost),
        fixed(other),
        difference === null ? "–" : signed(difference),
        CHANGES[change],
      ];
      return element(
        "tr",
        { "data-change": change },
        element("th", { scope: "row" }, robotChip(this.#session, id)),
        ...cells.map((textContent) => element("td", { textContent })),
      );
    });
    const table = element(
      "table",
      {},
      element("thead", {}, element("tr", {}, ...head)),
      element("tbody", {}, ...body),
    );
    const region = {
      class: "figures-table",
      tabIndex: 0,
      role: "region",
      "aria-label": "Differences of the plans",
    };
    const changedIds = rows.filter(({ change }) => change !== "same").map(({ id }) => id);
    const choose = button("Select the changed robots", () => this.#session.highlight(changedIds), {
      class: "quiet",
      disabled: changed === 0,
    });
    return [
      element("p", { class: "differences", textContent: words }),
      element("div", { class: "row" }, choose),
      element("div", region, table),
    ];
  }

  #swapPlans() {
    const { answer } = this.#session;
    const other = this.#other;
    this.#other = { answer, plans: answer.plans };
    if (this.#opened === other.answer) this.#opened = null;
    this.#session.adopt(other.answer);
  }

  async #openFile() {
    const file = this.#file.files?.[0];
    this.#file.value = "";
    if (!file) return;
    const problem = (detail) =>
      this.#session.fail(
        new ProblemError({ title: "Cannot compare the plans", detail: `${file.name}: ${detail}` }),
      );
    let read;
    try {
      read = readDocument(JSON.parse(await file.text()));
    } catch (error) {
      problem(/** @type {Error} */ (error).message);
      return;
    }
    if (read.answer === null || !belongsTo(read.answer, this.#session.request)) {
      problem("It is not a plan of these robots.");
      return;
    }
    this.#opened = read.answer;
    this.#list({ answer: read.answer, plans: read.answer.plans });
    this.#compare();
  }
}

const fixed = (value) => (value === null ? "–" : value.toFixed(2));

function signed(value) {
  if (Math.abs(value) < 5e-3) return "±0 s";
  return `${value > 0 ? "+" : "−"}${seconds(Math.abs(value))}`;
}
