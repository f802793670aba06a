// The state of the page: a request, its answer, the current time, the selection. Features attach here and are
// independent of each other. No DOM; the service and the screen's frames are passed in.
//
// Features listen with on(names, listener):
//   request   another request or an edit of it: `request`, `scene` and `tracks` are new. Detail: {opened},
//             whether another one was opened or restored by undo or redo (true), or this one was edited (false); and
//             {proceeded: true} if it is that of a later moment of the same fleet; {restored: true} if undo or redo opened it
//   answer    another answer, or none, or what still holds of it: `answer`, `outdated`, `tracks` and the player are
//             new; follows every "request", too
//   incumbent a better plan is shown while planning goes on, after "answer". Detail: whether it is the first one
//   planning  planning started, progressed or ended: `planning`
//   problem   a fault to show, or none: `problem`
//   check     the plan was checked, or the check was dropped: `check`
//   marks     other robots are hovered, selected or highlighted
//   time      another time, by playing (each frame) or by seeking
//   playback  playing started or ended
//   limits    `limits` are known
//   announcement  something for screen readers. Detail: the text
//
// The state is never changed in place: an edit passes another request.

import { outdatedIn } from "./document.js";
import { Documents } from "./documents.js";
import { Marking } from "./marking.js";
import { planFile } from "./plan_file.js";
import { Planning } from "./planning.js";
import { durationOf, Playback, Player } from "./playback.js";
import { ProblemError } from "./problem.js";
import { Shown } from "./shown.js";

/** @import {Check, Limits, Problem} from "./types.js" */

export class Session extends Marking {
  #service;
  #playback;
  #documents = new Documents();
  #shown = new Shown();
  #planning;
  #turn = 0; // counts requests and edits, so that late results for an older one are dropped

  player = new Player();
  /** @type {Problem | null} */
  problem = null;
  /** @type {Check | null} */
  check = null; // of the plan, by the service
  /** @type {Limits} */
  limits = {}; // see GET /v1/limits; empty until known
  #held = new Set(); // ids of robots that somebody holds, see FleetRun

  /** `service`: see service/client.js. `nextFrame` calls back with the wall clock in milliseconds. */
  constructor(service, nextFrame) {
    super();
    this.#service = service;
    this.#playback = new Playback(this.player, nextFrame, {
      moved: () => this.emit("time"),
      ended: () => this.emit("playback"),
    });
    this.#planning = new Planning(this, service, {
      show: (answer, continues) => this.#showAnswer(answer, continues),
      restore: () => this.#showAnswer(this.#documents.present.answer),
    });
  }

  setLimits(limits) {
    this.limits = limits;
    this.emit("limits");
  }

  // The request

  get request() {
    return this.#documents.request;
  }

  /** The name of the request: an example's or a file's name. */
  get name() {
    return this.#documents.name;
  }

  /** The name of the example if this is one and unchanged, or null. */
  get example() {
    return this.#documents.example;
  }

  get edited() {
    return this.#documents.isEdited;
  }

  /** The request as JSON: the opened text, until it is edited. */
  get text() {
    return this.#documents.text;
  }

  /** The request that the answer is of, as JSON. */
  get plannedText() {
    return this.#documents.plannedText;
  }

  get canUndo() {
    return this.#documents.canUndo;
  }

  get canRedo() {
    return this.#documents.canRedo;
  }

  /** Changes with every request and edit. */
  get turn() {
    return this.#turn;
  }

  /**
   * Shows another request: {name, example: its name or null, text, request}, with an answer or null. Undo restores the
   * previous request if it was edited.
   */
  open(opened, answer = null) {
    this.#documents.open(opened);
    this.#requestChanged(true);
    if (answer !== null) this.adopt(answer);
  }

  /**
   * Edits the request. Edits in a row with the same `gesture` (a drag, typing in one field) are one undo
   * step.
   */
  edit(request, gesture = null) {
    if (request === this.request) return;
    this.#documents.edit(request, gesture);
    this.#requestChanged(false);
  }

  endGesture() {
    this.#documents.endGesture();
  }

  undo() {
    if (this.canUndo) this.#stepped(this.#documents.undo(), "Undone");
  }

  redo() {
    if (this.canRedo) this.#stepped(this.#documents.redo(), "Redone");
  }

  #stepped(reopened, word) {
    this.#requestChanged(reopened, { restored: true });
    this.announce(reopened ? `${word}: ${this.name} is open again.` : `${word}.`);
  }

  /** Goes on with the request of a later moment of the running fleet and its plan; what is selected stays. */
  proceed(request, answer) {
    this.#documents.proceed(request, answer);
    this.#requestChanged(false, { proceeded: true });
  }

  #requestChanged(opened, detail = {}) {
    this.#turn += 1;
    this.stopPlanning();
    if (opened) this.clearMarks();
    this.#shown.showRequest(this.request);
    this.#showAnswer(this.#documents.present.answer);
    this.emit("request", { opened, ...detail });
    if (opened) this.setProblem(null); // after an edit it stays until the next check, see checks.js
    this.#answerChanged();
  }

  // What is shown of it

  get scene() {
    return this.#shown.scene;
  }

  /** By the ids of the robots. */
  get tracks() {
    return this.#shown.tracks;
  }

  get answer() {
    return this.#shown.answer;
  }

  /** If the answer is of the request before its edits: the ids of the robots whose plans no longer hold; else null. */
  get outdated() {
    return this.#shown.outdated;
  }

  /** Whether the answer has plans that are of the current request. */
  get hasPlan() {
    return this.outdated === null && (this.answer?.plans.length ?? 0) > 0;
  }

  /** Shows an answer of the current request, at time 0 or, if it `continues` what is shown, at the present time. */
  adopt(answer, continues = false) {
    this.#documents.adopt(answer);
    this.#showAnswer(answer, continues);
    this.#answerChanged();
  }

  /** Takes note of robots whose plans do not hold under the edited request. */
  outdate(ids) {
    this.#shown.showAnswer(this.answer, new Set([...(this.outdated ?? []), ...ids]));
    this.#answerChanged();
  }

  /** Shows an answer, at time 0 unless it was shown before or `continues` what is shown; null: none. */
  #showAnswer(answer, continues = false) {
    const isAnother = answer === null || answer !== this.answer;
    this.#shown.showAnswer(answer, answer && outdatedIn(this.#documents.present));
    this.keepMarks(this.#shown.robots);
    if (continues) this.player.extend(durationOf(answer));
    else if (isAnother) this.player.reset(durationOf(answer));
    else this.player.pause();
    this.#setCheck(null);
  }

  #answerChanged() {
    this.emit("answer");
    this.emit("marks");
  }

  /**
   * Has the service check the plan, see `check`; resolves to whether it did. Failures are shown as a problem.
   */
  async validate() {
    const turn = this.#turn;
    const { answer } = this;
    try {
      const check = await this.#service.validate(JSON.stringify(planFile(this.request, answer)));
      if (turn === this.#turn && answer === this.answer) this.#setCheck(check);
      return true;
    } catch (error) {
      if (turn === this.#turn) this.fail(error);
      return false;
    }
  }

  #setCheck(check) {
    this.check = check;
    this.emit("check");
  }

  // Planning, see Planning

  /** The PlanRun while planning, else null. */
  get planning() {
    return this.#planning.run;
  }

  plan(budget = null) {
    return this.#planning.plan(budget);
  }

  stopPlanning() {
    return this.#planning.stop();
  }

  cancel() {
    this.#planning.cancel();
  }

  // Problems and announcements

  /**
   * Shows the problem of a ProblemError; rethrows other errors, which are bugs. `again()` tries again what failed, if
   * there is something to try.
   */
  fail(error, again = /** @type {any} */ (null)) {
    if (!(error instanceof ProblemError)) throw error;
    if (again === null) {
      this.setProblem(error.problem);
      return;
    }
    const retry = () => {
      this.setProblem(null);
      again();
    };
    this.setProblem({ ...error.problem, again: retry });
  }

  setProblem(problem) {
    if (problem === null && this.problem === null) return;
    this.problem = problem;
    this.emit("problem");
  }

  announce(text) {
    this.emit("announcement", text);
  }

  // Robots, see Shown; now by default

  robot(id) {
    return this.#shown.robot(id);
  }

  poseOf(id, time = this.player.time) {
    return this.#shown.poseOf(id, time);
  }

  radiusOf(id, time = this.player.time) {
    return this.#shown.radiusOf(id, time);
  }

  stateOf(id, time = this.player.time) {
    return this.#held.has(id) ? "held" : this.#shown.stateOf(id, time);
  }

  /** Takes note of the robots, by their ids, that somebody holds now. */
  hold(ids) {
    this.#held = new Set(ids);
    this.emit("time");
  }

  // Time

  seek(time) {
    this.player.seek(time);
    this.emit("time");
  }

  play() {
    this.#playback.play();
    this.emit("playback");
  }

  pause() {
    this.player.pause();
    this.emit("playback");
  }

  togglePlaying() {
    if (this.player.playing) this.pause();
    else this.play();
  }
}
