// Which robots of a session are hovered, selected and highlighted, and the session's events. The base of Session.

import { Focus } from "./selection.js";
import { Signals } from "./signals.js";

/** @import {Robot} from "./types.js" */

export class Marking {
  #signals = new Signals();
  #focus = new Focus();

  on(names, listener) {
    this.#signals.on(names, listener);
  }

  /** For the session. */
  emit(name, detail = /** @type {any} */ (undefined)) {
    this.#signals.emit(name, detail);
  }

  /** For the session. */
  clearMarks() {
    this.#focus = new Focus();
  }

  /**
   * For the session: drops the marks of robots that are not among these, by id.
   * @param {Map<string, Robot>} robots
   */
  keepMarks(robots) {
    this.#focus.keep(robots);
  }

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
    this.emit("marks");
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
    this.emit("marks");
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
}
