// The buttons that begin and cancel planning.

import { byId } from "../ui/dom.js";
import { budgetOf } from "./planning_status.js";
import { revealProblem } from "./problem_card.js";
import { summarize } from "./summary.js";

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
    const watching = document.activeElement === this.#plan; // which has the focus again from Cancel
    session.say(summarize(session.answer));
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
