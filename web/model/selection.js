// Which robots are hovered, selected and marked, and which one is edited. No DOM.

import { robotsOf } from "./listed.js";

export class Focus {
  hovered = null;
  selected = null;
  highlighted = new Set(); // others, such as the second robot of a collision

  /** All ids. */
  get all() {
    return new Set([this.hovered, this.selected, ...this.highlighted].filter((id) => id !== null));
  }

  /** Selects the first of these ids and highlights the others. */
  highlight(ids) {
    this.selected = ids[0] ?? null;
    this.highlighted = new Set(ids.slice(1));
  }

  /** The selected robot and the other highlighted ones. */
  get chosen() {
    return this.selected === null ? [] : [this.selected, ...this.highlighted];
  }

  /** Drops the robots that are not in `known`. */
  keep(known) {
    if (!known.has(this.hovered)) this.hovered = null;
    this.highlight(this.chosen.filter((id) => known.has(id)));
  }
}

export class RobotChoice {
  #session;
  /** @type {number | null} */
  #index = null;

  constructor(session) {
    this.#session = session;
    session.on("request", ({ opened }) => this.#followRequest(opened));
    session.on("marks", () => this.#followMarks());
  }

  /**
   * The index among the request's robots, or null. It changes only with the session's "request" and "marks".
   */
  get index() {
    return this.#index;
  }

  /** The robot in the scene, or null. */
  get robot() {
    return this.#session.scene.robots.find((robot) => robot.index === this.#index) ?? null;
  }

  /** Selects the robot at an index of the request's robots, or none (null). */
  choose(index) {
    this.#index = index;
    this.#session.select(this.robot?.id ?? null);
  }

  #followRequest(opened) {
    const isGone = this.#index !== null && this.#index >= robotsOf(this.#session.request).length;
    if (opened || isGone) this.#index = null;
    if (this.#session.selected !== null) this.#followSelected();
    else if (this.robot) this.#session.select(this.robot.id); // it was renamed or became valid
  }

  #followMarks() {
    if (this.#session.selected !== null) this.#followSelected();
    else if (this.robot) this.#index = null; // it was deselected
  }

  #followSelected() {
    const { selected } = this.#session;
    if (this.robot?.id !== selected) this.#index = this.#session.robot(selected).index;
  }
}
