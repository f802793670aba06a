// Which robots are hovered, selected and marked, and which one is edited. No DOM.

import { robotsOf } from "./edit_request.js";

export class Focus {
  hovered = null;
  selected = null;
  highlighted = new Set(); // further ones, such as both robots of a collision

  /** The ids of all of them. */
  get all() {
    return new Set([this.hovered, this.selected, ...this.highlighted].filter((id) => id !== null));
  }

  /** Selects the first of these ids and brings out the others. */
  highlight(ids) {
    this.selected = ids[0] ?? null;
    this.highlighted = new Set(ids.slice(1));
  }

  /** Forgets robots that are not there any longer; `known` has those that are. */
  keep(known) {
    if (!known.has(this.hovered)) this.hovered = null;
    if (!known.has(this.selected)) this.selected = null;
    this.highlighted = new Set();
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
   * Its place in the request's robots, or null. Whoever shows it listens to the session's "request" and
   * "marks".
   */
  get index() {
    return this.#index;
  }

  /** As it is in the scene, or null. */
  get robot() {
    return this.#session.scene.robots.find((robot) => robot.index === this.#index) ?? null;
  }

  /** Chooses the robot at a place of the request's robots, or none (null). */
  choose(index) {
    this.#index = index;
    this.#session.select(this.robot?.id ?? null);
  }

  #followRequest(opened) {
    const isGone = this.#index !== null && this.#index >= robotsOf(this.#session.request).length;
    if (opened || isGone) this.#index = null;
    if (this.#session.selected !== null) this.#followSelected();
    else if (this.robot) this.#session.select(this.robot.id); // it was renamed, or can be shown again
  }

  #followMarks() {
    if (this.#session.selected !== null) this.#followSelected();
    else if (this.robot) this.#index = null; // someone deselected it
  }

  #followSelected() {
    const { selected } = this.#session;
    if (this.robot?.id !== selected) this.#index = this.#session.robot(selected).index;
  }
}
