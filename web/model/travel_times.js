// How long the selected robot takes, alone and from its start, to every place of the map. The service is asked in
// parts, from coarse to fine. If the times change, the work ends and begins again. No DOM; the service is passed in.

import { latestOnly } from "./latest.js";
import { ProblemError } from "./problem.js";
import { Signals } from "./signals.js";
import { TravelField } from "./travel_field.js";
import { TravelQuestion } from "./travel_question.js";
import { roomOf } from "./travel_room.js";

const REST_MS = 200; // without a change
const FIRST = 16; // places that are asked for at first: about as many as the service does at a time
const MAX = 4000; // places that are asked for at a time; the service accepts 250,000
const QUICK_MS = 700; // of a part that is followed by a much larger one
const BUDGET_MS = 20_000; // of a part
const PATIENCE_MS = 20_000; // after which no further part is asked for: the finest parts are left out
const FEWER = 4; // times fewer places, if the service cannot do so many within its time and memory
const TOO_MANY = ["check_unfinished", "memory_exceeded"];

export class TravelTimes {
  #session;
  #service;
  #now;
  #signals = new Signals();
  #later = latestOnly();
  /** @type {TravelQuestion | null} */
  #question = null;
  #told = /** @type {any} */ (null); // the problem of the last failure

  isOn = false;
  /** @type {string | null} */
  robot = null; // the id of the robot that was selected last
  /** @type {TravelField | null} */
  field = null; // once something of it is known
  /** @type {"none" | "computing" | "done" | "failed"} */
  state = "none";

  /** `now()` is the wall clock in milliseconds. */
  constructor(session, service, now) {
    this.#session = session;
    this.#service = service;
    this.#now = now;
    session.on("marks", () => this.#follow());
    session.on("request", ({ opened }) => {
      if (opened) this.robot = null;
      this.#follow();
    });
  }

  /** `listener` is called when it is switched, for another robot or state, and when more of the field is known. */
  onChange(listener) {
    this.#signals.on("change", listener);
  }

  switch(isOn) {
    this.isOn = isOn;
    this.#follow();
    this.#signals.emit("change");
  }

  /** Begins again if something else is to be asked. */
  #follow() {
    const { selected, request, scene } = this.#session;
    const robot = this.#session.robot(selected ?? this.robot);
    const isAnother = this.robot !== (robot?.id ?? null);
    this.robot = robot?.id ?? null;
    if (!this.isOn && this.#question === null) return;
    const asks = this.isOn && robot !== null && scene.grid !== null;
    const question = asks ? new TravelQuestion(request, robot) : null;
    if (question === null ? this.#question !== null : !question.isSameAs(this.#question)) {
      this.#question = question;
      this.#begin();
    } else if (isAnother) {
      this.#signals.emit("change");
    }
  }

  #begin() {
    this.field = null;
    const question = this.#question;
    this.#set(question === null ? "none" : "computing");
    this.#later(REST_MS, async (signal) => {
      if (question === null) return;
      if (this.#told === this.#session.problem) this.#session.setProblem(null);
      try {
        await this.#compute(question, signal);
        this.#set("done");
      } catch (error) {
        if (signal.aborted) throw error;
        this.#fail(error);
      }
    });
  }

  async #compute(question, signal) {
    const { request, scene } = this.#session;
    const field = new TravelField(scene.grid);
    const room = await roomOf(request, scene.grid, question.robot);
    const places = room.placesIn(field);
    let [part, most, spent] = [FIRST, MAX, 0];
    let waiting = [];
    while (spent < PATIENCE_MS || !field.hasTimes) {
      waiting.push(...(await taken(places, part - waiting.length, signal)));
      if (waiting.length === 0) break;
      const asked = waiting.slice(0, part);
      const begun = this.#now();
      const seconds = await this.#ask(question, asked, signal);
      const took = this.#now() - begun;
      spent += took;
      if (seconds === null) {
        most = part = Math.ceil(asked.length / FEWER);
        continue;
      }
      waiting = waiting.slice(part);
      asked.forEach(({ at }, number) => field.set(at, seconds[number]));
      part = Math.min(most, part * (took < QUICK_MS ? 4 : 2));
      this.field = field;
      this.#signals.emit("change");
    }
  }

  /** The times to some places, seconds, null without a way; null if they are too many at a time. */
  async #ask(question, places, signal) {
    const budget = Math.min(BUDGET_MS, this.#session.limits.max_budget_ms ?? BUDGET_MS);
    const body = question.body(
      places.map(({ place }) => place),
      budget,
    );
    try {
      return question.secondsOf(await this.#service.matrix(body, signal));
    } catch (error) {
      if (!(error instanceof ProblemError)) throw error;
      if (TOO_MANY.includes(error.problem.code) && places.length > 1) return null;
      const errors = (error.problem.errors ?? []).map((fault) => question.atItsPlace(fault));
      throw new ProblemError({ ...error.problem, errors });
    }
  }

  #fail(error) {
    const isFaulty = error.problem?.errors.length > 0; // an edit asks again
    this.#session.fail(error, isFaulty ? null : () => this.#begin());
    this.#told = this.#session.problem;
    this.#set("failed");
  }

  #set(state) {
    this.state = state;
    this.#signals.emit("change");
  }
}

/** The next items of an async generator, at most so many. */
async function taken(items, most, signal) {
  const list = [];
  while (list.length < most) {
    const { done, value } = await items.next();
    signal.throwIfAborted();
    if (done) break;
    list.push(value);
  }
  return list;
}
