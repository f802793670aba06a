// Make it robust: finds the cheapest margins with which a plan holds, shows what margins cost and what they prevent,
// and plans with those that are chosen.

import { candidatesOf, marginsOf, withMargins } from "../model/margins.js";
import { change, percent } from "../model/simulation.js";
import { element, setText } from "../ui/dom.js";
import { metres, seconds } from "../ui/format.js";
import { costCurve, shareBar } from "./charts.js";
import { button, numberPart } from "./fields.js";

const FIRST_PERCENT = 1; // of the executions may have a collision or a deadlock

export class RobustSection {
  #page;
  #session;
  #formNow;
  #useDependencies;
  #accepted = numberPart("Accepted collisions", "%", FIRST_PERCENT, { min: 0.01, max: 50 });
  #start = button("Make it robust", () => this.#press());
  #status = element("p", { class: "facts", role: "status" });
  #results = element("div", { class: "results" });
  /** @type {AbortController | null} */
  #asking = null;

  element;

  /**
   * `page`: see fillAnalysis. `formNow()`: the values of the simulation's form, or null if one is invalid.
   * `useDependencies()` chooses the policy by which robots wait for each other.
   */
  constructor(page, formNow, useDependencies) {
    this.#page = page;
    this.#session = page.session;
    this.#formNow = formNow;
    this.#useDependencies = useDependencies;
    const purpose = "Finds the cheapest margins with which the robots do not collide, and plans with them.";
    this.element = element(
      "div",
      { class: "simulation robust" },
      element("h2", { textContent: "Make it robust" }),
      element("p", { class: "facts", textContent: purpose }),
      element("div", { class: "row" }, this.#accepted.field, this.#start),
      this.#status,
      this.#results,
    );
  }

  /** Forgets what was found, and stops asking. */
  reset() {
    this.#asking?.abort();
    this.#end();
    this.#results.replaceChildren();
  }

  #end() {
    this.#asking = null;
    setText(this.#status, "");
    setText(this.#start, "Make it robust");
  }

  #press() {
    if (this.#asking !== null) this.reset();
    else this.#ask();
  }

  async #ask() {
    const form = this.#formNow();
    if (form === null || !this.#accepted.input.reportValidity()) return;
    const asking = new AbortController();
    this.reset();
    this.#asking = asking;
    setText(this.#start, "Stop");
    setText(this.#status, "Planning with several margins…");
    this.#session.announce("Planning with several margins.");
    const { request } = this.#session;
    const body = marginsOf(request, form, this.#accepted.input.valueAsNumber / 100);
    const executed = new Map(); // number of a candidate -> {runs, bad}
    try {
      const found = await this.#page.service.margins(JSON.stringify(body), asking.signal, (progress) => {
        if (this.#asking === asking) this.#follow(executed, progress);
      });
      if (this.#asking !== asking) return;
      this.#end();
      this.#show(form, found);
    } catch (error) {
      if (this.#asking !== asking) return; // it was stopped
      this.reset();
      this.#session.fail(error);
    }
  }

  #follow(executed, { candidate, candidates, stage, runs, bad }) {
    const isPlanning = stage === "plan";
    setText(
      this.#status,
      `${isPlanning ? "Planning" : "Executing"} with margins ${candidate + 1} of ${candidates}`,
    );
    if (isPlanning || runs === 0) return;
    executed.set(candidate, { runs, bad });
    const bars = [...executed]
      .sort(([one], [other]) => one - other)
      .map(([number, each]) => {
        const share = each.bad / each.runs;
        return shareBar(`of ${each.runs} executions with margins ${number + 1}`, share, percent(share));
      });
    this.#results.replaceChildren(...bars);
  }

  #show(form, found) {
    const candidates = candidatesOf(found);
    const { met, advice, warnings } = found;
    const best = candidates.find(({ isBest }) => isBest);
    const words = met
      ? `Holds with: ${marginsInWords(found.options)}. Flowtime ${change(best.cost)}, ` +
        `${percent(best.share)} of ${best.runs} executions have a collision or a deadlock.`
      : "No margins that were tried suffice.";
    this.#session.announce(words);
    this.#results.replaceChildren(
      element("p", { class: "share-words", textContent: words }),
      met ? button("Use this plan", () => this.#use(found), { class: "primary" }) : "",
      !met && form.policy !== "dependencies"
        ? button("Try with dependencies", () => {
            this.#useDependencies();
            this.#ask();
          })
        : "",
      costCurve("Executions with a collision or a deadlock, by the cost of the margins", candidates),
      tableOf(candidates),
      ...[...advice, ...warnings].map((text) => element("p", { class: "facts", textContent: text })),
    );
  }

  #use(found) {
    this.#session.edit(withMargins(this.#session.request, found));
    this.#session.adopt(found.plan);
    this.#session.announce("The plan with margins is shown. Undo returns to the plan before.");
  }
}

/** The margins of a candidate, in words. */
function marginsInWords({ interval_margin, inflation, wait_before_move }) {
  const words = [];
  if (interval_margin > 0) words.push(`${seconds(interval_margin)} between robots`);
  if (inflation > 0) words.push(`${metres(inflation)} around robots`);
  if (wait_before_move > 0) words.push(`${seconds(wait_before_move)} before each drive`);
  return words.length > 0 ? words.join(", ") : "none";
}

function tableOf(candidates) {
  const rows = candidates.map(({ options, share, runs, cost, isBest }) =>
    element(
      "tr",
      { class: isBest ? "best" : "" },
      element("th", { textContent: marginsInWords(options), scope: "row" }),
      element("td", { textContent: `${percent(share)} of ${runs}` }),
      element("td", { textContent: change(cost) }),
    ),
  );
  const titles = ["Margins", "Go wrong", "Flowtime"];
  const head = element(
    "tr",
    {},
    ...titles.map((textContent) => element("th", { textContent, scope: "col" })),
  );
  const table = element("table", {}, element("thead", {}, head), element("tbody", {}, ...rows));
  return element("div", { class: "figures-table" }, table);
}
