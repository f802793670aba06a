// Opening what to plan: an example, files, a text, a link. The last choice wins.

import { isSameTask } from "../model/earlier_plans.js";
import { isAlike } from "../model/kept_plan.js";
import { nextTask } from "../model/latest.js";
import { count } from "../ui/format.js";
import { ConnectionLost, FileError, ProblemError } from "../model/problem.js";
import { readLinkState } from "./address.js";
import { prepareRequest } from "./prepare.js";
import { Reader } from "./reader.js";

const NOT_KEPT =
  "The request of this address is too large for a link. Only the browser in which it was open keeps it, for some time. " +
  "Open its file instead.";

export class Opening {
  #session;
  #service;
  #show;
  #work;
  #reader;
  #turn = 0; // counts choices, so that a late one does not replace a newer one

  /**
   * `service`: see service/client.js. `show(part)` brings a part of the page into sight: "plan", "comparison" (of the
   * plan with the previous plan), "robots" (to place) or "problem". `work`: see MAP_WORK.
   */
  constructor(session, service, show, work) {
    this.#session = session;
    this.#show = show;
    this.#service = service;
    this.#work = work;
    this.#reader = new Reader(session, work);
  }

  /** Whether anything was opened yet. */
  get begun() {
    return this.#turn > 0;
  }

  // Each of these resolves to whether it is open now. If not, the session has the problem, or it was cancelled, or a
  // newer choice replaced it.

  example(name) {
    return this.#choose(async () => {
      const text = await this.#service.fetchExample(name);
      return { name, example: name, text, request: JSON.parse(text), answer: null };
    });
  }

  /**
   * Opens files (File) that belong together, after a dialog if there is a choice. A plan that was `dropped` onto
   * another plan for the same robots is compared with it.
   */
  files(files, dropped = false) {
    return this.#choose(() => this.#reader.files(files), dropped);
  }

  text(name, text) {
    return this.#choose(() => this.#reader.text(name, text));
  }

  /** Opens the request that the fragment of an address holds, under a name. */
  link(fragment, name = "linked request") {
    return this.#choose(async () => {
      return this.#reader.text(name, JSON.stringify(await readLinkState(fragment)));
    });
  }

  /** Opens a request that this browser keeps: `load()` resolves to {name, text}, or to null if there is none. */
  kept(load) {
    return this.#choose(async () => {
      const found = await load().catch(() => null);
      if (found === null) throw new FileError(NOT_KEPT);
      return this.#reader.text(found.name, found.text);
    });
  }

  /**
   * Opens the plan that this browser keeps for the present request, or for the request before its edits. `load()`
   * resolves to {request, answer}, the texts of both, or to null if there is no plan.
   */
  async keptPlan(load) {
    const session = this.#session;
    const { name, request: present } = session;
    const isOpen = await this.#choose(async () => {
      const found = await load().catch(() => null);
      const isLate = session.request !== present || session.answer !== null || session.planning !== null;
      if (found === null || isLate) return null;
      const opened = this.#reader.pair(name, found.request, found.answer);
      return isAlike(opened.request, present) ? { ...opened, request: present } : opened;
    });
    if (isOpen) session.edit(present);
    return isOpen;
  }

  /** `read` resolves to what to open, see Reader, or to null if that was cancelled. */
  async #choose(read, dropped = false) {
    const turn = (this.#turn += 1);
    this.#reader.dismiss();
    try {
      const opened = await this.#advanced(await read());
      await prepareRequest(opened?.request, this.#work, nextTask);
      await nextTask(); // reading and showing are two
      if (turn !== this.#turn || opened === null) return false;
      this.#open(opened, dropped);
      return true;
    } catch (error) {
      if (turn !== this.#turn) return false;
      const again = error instanceof ConnectionLost ? () => this.#choose(read, dropped) : null;
      this.#session.fail(asProblem(error), again);
      this.#show("problem");
      return false;
    }
  }

  /**
   * What to open. Of a request of POST /v1/advance it is the service's answer: the request of that moment, whose robots
   * start where they report to be.
   */
  async #advanced(read) {
    if (read?.advance === undefined) return read;
    const request = await this.#service.advance(read.advance);
    return { name: read.name, example: null, text: JSON.stringify(request), request, answer: null };
  }

  /** Checks the opened plan, after it is shown. */
  async #check() {
    const { turn } = this.#session;
    await nextTask();
    if (turn !== this.#session.turn) return;
    if (!(await this.#session.validate())) this.#show("problem");
  }

  #open({ answer, ...opened }, dropped) {
    const session = this.#session;
    const compares = dropped && session.hasPlan && isSameTask(session.request, opened.request);
    if (opened.request === session.request) {
      session.stopPlanning();
      session.setProblem(null);
      session.adopt(answer);
    } else {
      session.open(opened, answer);
    }
    if (answer !== null) {
      this.#show(compares ? "comparison" : "plan"); // which shows the result of the check
      this.#check();
    }
    if (Array.isArray(opened.request.robots) && opened.request.robots.length === 0) {
      session.announce(`${opened.name} is open and has no robots yet: click where one starts.`);
      this.#show("robots");
    } else {
      session.announce(`${opened.name} is open: ${count(session.scene.robots.length, "robot")}.`);
    }
  }
}

function asProblem(error) {
  if (!(error instanceof FileError)) return error;
  return new ProblemError({ title: "Cannot open this", detail: error.message });
}
