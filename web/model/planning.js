// Planning by the service: a run at a time, whose plans are shown as they come.

import { objectiveOf, PlanRun } from "./plan_run.js";
import { withNote } from "./problem.js";

/** What is told when planning fails that has found a plan before. */
const KEPT = "The best plan found until then is shown; the service has verified it.";

export class Planning {
  #session;
  #service;
  #view;
  /** @type {PlanRun | null} */
  run = null; // set while planning

  /**
   * `view` has show(answer, continues), which shows an answer (null: none) that is not kept, and restore(), which shows
   * the kept answer. It emits the session's events.
   */
  constructor(session, service, view) {
    this.#session = session;
    this.#service = service;
    this.#view = view;
  }

  /**
   * Plans the request. Resolves at the end to whether there is an answer: the final answer, or the best so far if
   * planning fails. `budget`: see PlanRun.
   */
  async plan(budget) {
    const session = this.#session;
    if (this.run || session.request === null) return false;
    const run = new PlanRun(budget, objectiveOf(session.request));
    this.run = run;
    session.setProblem(null);
    this.#view.show(null, false);
    this.#session.emit("answer");
    this.#session.emit("planning");
    session.announce("Planning.");
    try {
      const answer = await this.#service.plan(session.text, run.signal, {
        progress: (progress) => this.run === run && this.#onProgress(run, progress),
        incumbent: (incumbent) => this.run === run && this.#onIncumbent(run, incumbent),
        waiting: (seconds) => this.run === run && this.#onWaiting(run, seconds),
      });
      if (this.run !== run) return false;
      this.#end();
      session.adopt(answer, run.incumbent !== null);
      return true;
    } catch (error) {
      if (this.run !== run) return false;
      this.#end();
      this.#adoptBest(run.incumbent);
      session.fail(run.incumbent === null ? error : withNote(error, KEPT));
      return run.incumbent !== null;
    }
  }

  /** Shows a better plan, the text of an answer, and goes on planning; playing continues. */
  #onIncumbent(run, text) {
    const isFirst = run.incumbent === null;
    run.incumbent = text;
    this.#view.show(JSON.parse(text), !isFirst);
    this.#answerChanged();
    this.#session.emit("incumbent", isFirst);
  }

  #onProgress(run, progress) {
    run.record(progress);
    this.#session.emit("planning");
  }

  #onWaiting(run, seconds) {
    run.waiting = seconds;
    this.#session.emit("planning");
    this.#session.announce(`The service is busy. Planning is retried in ${seconds} s.`);
  }

  #end() {
    this.run = null;
    this.#session.emit("planning");
  }

  /** Stops planning; returns the text of the best answer so far, or null. */
  stop() {
    if (!this.run) return null;
    const { incumbent } = this.run;
    this.run.stop();
    this.#end();
    return incumbent;
  }

  /** Stops planning and shows the best answer so far, if there is one. */
  cancel() {
    if (!this.run) return;
    const text = this.stop();
    this.#adoptBest(text);
    this.#session.announce(`Planning cancelled${text === null ? "" : ": this is the best plan so far"}.`);
  }

  /** Shows the best answer, a text, of planning that ended early; the answer before if there is none (null). */
  #adoptBest(text) {
    if (text !== null) {
      this.#session.adopt(JSON.parse(text), true);
      return;
    }
    this.#view.restore();
    this.#answerChanged();
  }

  #answerChanged() {
    this.#session.emit("answer");
    this.#session.emit("marks");
  }
}
