// The state of the page: a request, its answer, the current time, the selection. Features attach here and are
// independent of each other. No DOM; the service and the screen's frames are passed in.
//
// Features listen with on(names, listener):
//   request   another request or an edit of it: `request`, `scene` and `tracks` are new. Detail: {opened},
//             whether another one was opened or restored by undo or redo (true), or this one was edited (false); and
//             {proceeded: true} if it is that of a later moment of the same fleet
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

import { answered, documentOf, edited, outdatedIn } from "./document.js";
import { History } from "./history.js";
import { planFile } from "./plan_file.js";
import { objectiveOf, PlanRun } from "./plan_run.js";
import { durationOf, Playback, Player } from "./playback.js";
import { ProblemError, withNote } from "./problem.js";
import { readScene, readTracks, robotPoseAt, robotRadiusAt, robotStateAt } from "./scene.js";
import { Focus } from "./selection.js";
import { Signals } from "./signals.js";

/** @import {Answer, Check, Limits, Problem, Request, Robot, Scene, Track} from "./types.js" */

/** What is told when planning fails that has found a plan before. */
const KEPT = "The best plan until then is shown; the service has checked it.";

export class Session {
  #signals = new Signals();
  #service;
  #playback;
  #focus = new Focus();
  #history = new History(documentOf()); // of documents, see document.js
  #turn = 0; // counts requests and edits, so that late results for an older one are dropped
  /** @type {Map<string, Robot>} */
  #robots = new Map(); // of the scene, by id

  player = new Player();
  /** @type {Scene} */
  scene = readScene(null);
  /** @type {Map<string, Track>} */
  tracks = new Map(); // by id
  /** @type {Answer | null} */
  answer = null;
  /** @type {Set<string> | null} */
  outdated = null; // if the answer is of the request before its edits: the robots whose plans no longer hold
  /** @type {PlanRun | null} */
  planning = null; // set while planning
  /** @type {Problem | null} */
  problem = null;
  /** @type {Check | null} */
  check = null; // of the plan, by the service
  /** @type {Limits} */
  limits = {}; // see GET /v1/limits; empty until known

  /** `service`: see service/client.js. `nextFrame` calls back with the wall clock in milliseconds. */
  constructor(service, nextFrame) {
    this.#service = service;
    this.#playback = new Playback(this.player, nextFrame, {
      moved: () => this.#signals.emit("time"),
      ended: () => this.#signals.emit("playback"),
    });
  }

  on(names, listener) {
    this.#signals.on(names, listener);
  }

  setLimits(limits) {
    this.limits = limits;
    this.#signals.emit("limits");
  }

  // The request

  get #opened() {
    return this.#history.present.opened;
  }

  get request() {
    return this.#history.present.request;
  }

  /** The name of the request: an example's or a file's name. */
  get name() {
    return this.#opened.name;
  }

  /** The name of the example if this is one and unchanged, or null. */
  get example() {
    return this.edited ? null : this.#opened.example;
  }

  get edited() {
    return this.request !== this.#opened.request;
  }

  /** The request as JSON: the opened text, until it is edited. */
  get text() {
    return this.edited ? JSON.stringify(this.request) : this.#opened.text;
  }

  get canUndo() {
    return this.#history.canUndo;
  }

  get canRedo() {
    return this.#history.canRedo;
  }

  /** Changes with every request and edit. */
  get turn() {
    return this.#turn;
  }

  /**
   * Shows another request: {name, example: its name or null, text, request}, with an answer or null. Undo
   * restores the previous one if that was edited.
   */
  open(opened, answer = null) {
    if (this.edited) this.#history.push(documentOf(opened));
    else this.#history.replace(documentOf(opened));
    this.#requestChanged(true);
    if (answer !== null) this.adopt(answer);
  }

  /**
   * Edits the request. Edits in a row with the same `gesture` (a drag, typing in one field) are one undo
   * step.
   */
  edit(request, gesture = null) {
    if (request === this.request) return;
    this.#history.push(edited(this.#history.present, request), gesture);
    this.#requestChanged(false);
  }

  endGesture() {
    this.#history.endGesture();
  }

  undo() {
    if (this.canUndo) this.#step(() => this.#history.undo(), "Undone");
  }

  redo() {
    if (this.canRedo) this.#step(() => this.#history.redo(), "Redone");
  }

  #step(take, word) {
    const before = this.#opened;
    take();
    const reopened = this.#opened !== before;
    this.#requestChanged(reopened);
    this.announce(reopened ? `${word}: ${this.name} is open again.` : `${word}.`);
  }

  /** Goes on with the request of a later moment of the running fleet and its plan; what is selected stays. */
  proceed(request, answer) {
    const opened = { ...this.#opened, example: null, text: JSON.stringify(request), request };
    this.#history.replace(answered(documentOf(opened), answer));
    this.#requestChanged(false, true);
  }

  #requestChanged(opened, proceeded = false) {
    this.#turn += 1;
    this.stopPlanning();
    if (opened) this.#focus = new Focus();
    this.scene = readScene(this.request, this.scene);
    this.#robots = new Map(this.scene.robots.map((robot) => [robot.id, robot]));
    this.#focus.keep(this.#robots);
    this.#showAnswer(this.#history.present.answer);
    this.#signals.emit("request", proceeded ? { opened, proceeded } : { opened });
    if (opened) this.setProblem(null); // after an edit it stays until the next check, see checks.js
    this.#signals.emit("answer");
    this.#signals.emit("marks");
  }

  // The answer

  /** Whether the answer has plans that are of the current request. */
  get hasPlan() {
    return this.outdated === null && (this.answer?.plans.length ?? 0) > 0;
  }

  /** Shows an answer of the current request, at time 0 or, if it `continues` what is shown, at the present time. */
  adopt(answer, continues = false) {
    this.#history.amend(answered(this.#history.present, answer));
    this.#showAnswer(answer, continues);
    this.#answerChanged();
  }

  /** Takes note of robots whose plans do not hold under the edited request. */
  outdate(ids) {
    this.outdated = new Set([...(this.outdated ?? []), ...ids]);
    this.tracks = readTracks(this.scene, this.answer, this.outdated);
    this.#answerChanged();
  }

  /** Shows an answer, at time 0 unless it was shown before or `continues` what is shown; null: none. */
  #showAnswer(answer, continues = false) {
    const isAnother = answer === null || answer !== this.answer;
    this.answer = answer;
    this.outdated = answer && outdatedIn(this.#history.present);
    this.tracks = readTracks(this.scene, answer, this.outdated);
    this.#focus.keep(this.#robots);
    if (continues) this.player.extend(durationOf(answer));
    else if (isAnother) this.player.reset(durationOf(answer));
    else this.player.pause();
    this.#setCheck(null);
  }

  #answerChanged() {
    this.#signals.emit("answer");
    this.#signals.emit("marks");
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
    this.#signals.emit("check");
  }

  // Planning

  /**
   * Plans the request; resolves at the end to whether there is an answer: the last one, or the best so far if planning
   * fails. `budget`: see PlanRun.
   */
  async plan(budget = null) {
    if (this.planning || this.request === null) return false;
    const run = new PlanRun(budget, objectiveOf(this.request));
    this.planning = run;
    this.setProblem(null);
    this.#showAnswer(null);
    this.#signals.emit("answer");
    this.#signals.emit("planning");
    try {
      const answer = await this.#service.plan(this.text, run.signal, {
        progress: (progress) => this.planning === run && this.#onProgress(progress),
        incumbent: (incumbent) => this.planning === run && this.#onIncumbent(run, incumbent),
        waiting: (seconds) => this.planning === run && this.#onWaiting(seconds),
      });
      if (this.planning !== run) return false;
      this.#endPlanning();
      this.adopt(answer, run.incumbent !== null);
      return true;
    } catch (error) {
      if (this.planning !== run) return false;
      this.#endPlanning();
      this.#adoptBest(run.incumbent);
      this.fail(run.incumbent === null ? error : withNote(error, KEPT));
      return run.incumbent !== null;
    }
  }

  /** Shows a better plan, the text of an answer, and goes on planning; playing continues. */
  #onIncumbent(run, text) {
    const isFirst = run.incumbent === null;
    run.incumbent = text;
    this.#showAnswer(JSON.parse(text), !isFirst);
    this.#answerChanged();
    this.#signals.emit("incumbent", isFirst);
  }

  #onProgress(progress) {
    this.planning?.record(progress);
    this.#signals.emit("planning");
  }

  #onWaiting(seconds) {
    if (this.planning) this.planning.waiting = seconds;
    this.#signals.emit("planning");
    this.announce(`The service is busy. Planning is tried again in ${seconds} s.`);
  }

  #endPlanning() {
    this.planning = null;
    this.#signals.emit("planning");
  }

  /** Stops planning; returns the text of the best answer so far, or null. */
  stopPlanning() {
    if (!this.planning) return null;
    const { incumbent } = this.planning;
    this.planning.stop();
    this.#endPlanning();
    return incumbent;
  }

  /** Stops planning and shows the best answer so far, if there is one. */
  cancel() {
    if (!this.planning) return;
    const text = this.stopPlanning();
    this.#adoptBest(text);
    this.announce(`Planning cancelled${text === null ? "" : ": this is the best plan so far"}.`);
  }

  /** Shows the best answer, a text, of planning that ended early; the answer before if there is none (null). */
  #adoptBest(text) {
    if (text !== null) {
      this.adopt(JSON.parse(text), true);
      return;
    }
    this.#showAnswer(this.#history.present.answer);
    this.#answerChanged();
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
    this.#signals.emit("problem");
  }

  announce(text) {
    this.#signals.emit("announcement", text);
  }

  // Selection

  get hovered() {
    return this.#focus.hovered;
  }

  get selected() {
    return this.#focus.selected;
  }

  /** The ids of all highlighted robots. */
  get marked() {
    return this.#focus.all;
  }

  hover(id) {
    if (this.hovered === id) return;
    this.#focus.hovered = id;
    this.#signals.emit("marks");
  }

  /** Selects a robot, or none (null). */
  select(id) {
    this.highlight(id === null ? [] : [id]);
  }

  /** Selects a robot, or none if it was selected. */
  toggle(id) {
    this.select(id === this.selected ? null : id);
  }

  /** Selects the first of some robots and highlights all. */
  highlight(ids) {
    this.#focus.highlight(ids);
    this.#signals.emit("marks");
  }

  /** The ids of the selected robot and of the others that are highlighted. */
  get chosen() {
    return this.#focus.chosen;
  }

  /** Adds a robot to the chosen ones, or takes it out. */
  toggleChosen(id) {
    const others = this.chosen.filter((each) => each !== id);
    this.highlight(others.length < this.chosen.length ? others : [...others, id]);
  }

  /** The robot of an id in the scene, or null. */
  robot(id) {
    return this.#robots.get(id) ?? null;
  }

  /** The pose of a robot at a time (seconds), now by default; null if there is no such robot. */
  poseOf(id, time = this.player.time) {
    const robot = this.robot(id);
    return robot && robotPoseAt(robot, this.tracks.get(id), time);
  }

  /** The radius of a robot at a time, metres; null if there is no such robot. */
  radiusOf(id, time = this.player.time) {
    const robot = this.robot(id);
    return robot && robotRadiusAt(robot, /** @type {Track} */ (this.tracks.get(id)), time);
  }

  /** The state of a robot at a time, one word; null if there is no such robot. */
  stateOf(id, time = this.player.time) {
    return this.tracks.has(id) ? robotStateAt(this.tracks.get(id), time) : null;
  }

  // Time

  seek(time) {
    this.player.seek(time);
    this.#signals.emit("time");
  }

  play() {
    this.#playback.play();
    this.#signals.emit("playback");
  }

  pause() {
    this.player.pause();
    this.#signals.emit("playback");
  }

  togglePlaying() {
    if (this.player.playing) this.pause();
    else this.play();
  }
}
