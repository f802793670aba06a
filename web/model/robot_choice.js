// Which robot of the request is being edited. It follows the robot selected in the scene; a robot so faulty
// that the scene cannot show it can be chosen too. No DOM.

import { robotsOf } from "./edit_robots.js";

export class RobotChoice {
  #session;
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
    if (opened || this.#index >= robotsOf(this.#session.request).length) this.#index = null;
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
