// Keeps the plan that is shown in this browser, so that it is there again after a reload. The entry of the browser's
// history has its id as {plan}. It is opened like the files of the plan and of its request. The edits since then
// follow.

import { latestOnly } from "../model/latest.js";
import { amendEntry, entryState } from "./entry.js";
import { freshId } from "./kept.js";

const LEAST_MS = 400; // between plans that are kept

export class PlanKeeper {
  #session;
  #opening;
  #kept;
  #id = freshId();
  #later = latestOnly();
  /** @type {string | null} */
  #before = entryState().plan ?? null; // of the page before its reload, until it is restored
  #answer = null; // that is kept, or will be
  #isKept = true;
  #last = -Infinity; // when a plan was kept, of performance.now()

  /** `opening`: see Opening; `kept`: see keptPlans. */
  constructor(session, opening, kept) {
    this.#session = session;
    this.#opening = opening;
    this.#kept = kept;
    session.on("request", ({ opened }) => opened && this.#forget());
    session.on("answer planning", () => this.#keepSoon());
  }

  /** The texts {request, answer} of the plan that is shown, if it is not kept yet, or null. */
  get unkept() {
    return this.#isKept || this.#session.answer === null ? null : this.#texts;
  }

  get #texts() {
    const { planning, text, plannedText, answer } = this.#session;
    return { request: planning === null ? plannedText : text, answer: JSON.stringify(answer) };
  }

  /**
   * Opens the plan of the page before its reload, if there is one and the request is that one (`isSame`): the `unkept` one,
   * or else the one that is kept.
   */
  async restore(isSame, unkept = null) {
    const id = this.#before;
    if (id === null && unkept === null) return;
    if (isSame) await this.#opening.keptPlan(async () => unkept ?? this.#kept.get(id));
    this.#before = null;
    if (this.#session.answer === null) this.#forget();
  }

  #forget() {
    this.#answer = null;
    this.#later(0, async () => {});
    this.#isKept = true;
    if (this.#before === null && entryState().plan !== undefined) amendEntry({ plan: undefined });
  }

  #keepSoon() {
    const { answer, planning } = this.#session;
    if (answer === this.#answer) return;
    if (answer === null) {
      if (planning === null) this.#forget(); // else a plan may follow, until which the one before is kept
      return;
    }
    this.#answer = answer;
    this.#isKept = false;
    this.#later(Math.max(0, this.#last + LEAST_MS - performance.now()), (signal) => this.#keep(signal));
  }

  async #keep(signal) {
    const texts = this.#texts;
    this.#last = performance.now();
    const isKept = await this.#kept.put(this.#id, texts).then(
      () => true,
      () => false, // such as in a private window
    );
    if (signal.aborted) return;
    this.#isKept = true; // or cannot be
    if (isKept) amendEntry({ plan: this.#id });
  }
}
