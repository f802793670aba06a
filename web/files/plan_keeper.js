// Keeps the plan that is shown in this browser, so that it is there again after a reload. The entry of the browser's
// history has its id as {plan}. It is opened like the files of the plan and of its request. The edits since then
// follow.

import { latestOnly } from "../model/latest.js";
import { freshId } from "./kept.js";

const REST_MS = 400; // without another plan

export class PlanKeeper {
  #session;
  #opening;
  #kept;
  #id = freshId();
  #later = latestOnly();
  /** @type {string | null} */
  #before = history.state?.plan ?? null; // of the page before its reload, until it is restored
  #answer = null; // that is kept, or will be

  /** `opening`: see Opening; `kept`: see keptPlans. */
  constructor(session, opening, kept) {
    this.#session = session;
    this.#opening = opening;
    this.#kept = kept;
    session.on("request", ({ opened }) => opened && this.#forget());
    session.on("answer planning", () => this.#keepSoon());
  }

  /** Opens the plan of the page before its reload, if there is one and the request is that one (`isSame`). */
  async restore(isSame) {
    const id = this.#before;
    if (id === null) return;
    if (isSame) await this.#opening.keptPlan(() => this.#kept.get(id));
    this.#before = null;
    if (this.#session.answer === null) this.#forget();
  }

  #forget() {
    this.#answer = null;
    this.#later(0, async () => {});
    if (this.#before === null && history.state?.plan !== undefined) history.replaceState(null, "");
  }

  #keepSoon() {
    const { answer, planning } = this.#session;
    if (planning !== null || answer === this.#answer) return; // better plans may follow
    if (answer === null) {
      this.#forget();
      return;
    }
    this.#answer = answer;
    this.#later(REST_MS, (signal) => this.#keep(answer, signal));
  }

  async #keep(answer, signal) {
    const texts = { request: this.#session.plannedText, answer: JSON.stringify(answer) };
    const isKept = await this.#kept.put(this.#id, texts).then(
      () => true,
      () => false, // such as in a private window
    );
    if (isKept && !signal.aborted) history.replaceState({ plan: this.#id }, "");
  }
}
