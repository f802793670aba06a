// Follows a robot: the camera keeps the selected robot in its middle, until the camera is moved by hand.

import { byId } from "../ui/dom.js";

export class Follow {
  #session;
  #stage;
  #button = byId("follow");
  #on = false;

  constructor(session, stage) {
    this.#session = session;
    this.#stage = stage;
    this.#button.addEventListener("click", () => this.toggle());
    session.on("marks answer time", () => this.#update());
    stage.onPan(() => this.#set(false));
  }

  /** Follows the selected robot, or no longer. */
  toggle() {
    const { selected } = this.#session;
    if (selected === null) {
      this.#session.announce("Select a robot to follow it.");
      return;
    }
    this.#set(!this.#on);
    this.#session.announce(this.#on ? `Following ${selected}.` : `${selected} is no longer followed.`);
  }

  #set(on) {
    this.#on = on;
    this.#update();
  }

  #update() {
    const { selected } = this.#session;
    if (selected === null) this.#on = false;
    this.#button.disabled = selected === null;
    this.#button.setAttribute("aria-pressed", String(this.#on));
    if (this.#on) this.#stage.centre(this.#session.poseOf(selected), this.#session.radiusOf(selected));
  }
}
