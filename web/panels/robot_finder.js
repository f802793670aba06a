// Finding robots: the field and the choice above their list, which filter it.

import { byId, setText } from "../ui/dom.js";
import { count } from "../ui/format.js";

const EVERY_MS = 250; // between updates while playing

export class RobotFinder {
  #session;
  #stage;
  #tabs;
  #filter;
  #field = byId("robot-find");
  #doing = byId("robot-filter");
  #delay = byId("robot-delay");
  #updated = -Infinity;

  /** `filter`: see RobotFilter. */
  constructor(session, stage, tabs, filter) {
    this.#session = session;
    this.#stage = stage;
    this.#tabs = tabs;
    this.#filter = filter;
    this.#field.addEventListener("input", () => filter.set({ text: this.#field.value }));
    this.#field.addEventListener("keydown", (event) => this.#onKey(event));
    this.#doing.addEventListener("change", () => {
      byId("robot-delay-part").hidden = this.#doing.value !== "delayed";
      filter.set({ doing: this.#doing.value });
    });
    this.#delay.addEventListener("input", () => filter.set({ delay: Number(this.#delay.value) }));
    byId("choose-listed").addEventListener("click", () => this.chooseListed());
    filter.onChange(() => this.#show());
    session.on("time playback", () => this.#refresh());
  }

  /** Brings the field into sight and into focus. */
  focus() {
    this.#tabs.choose("tab-plan");
    this.#field.focus();
    this.#field.select();
  }

  /** Chooses all robots of the list. */
  chooseListed() {
    this.#session.highlight(this.#filter.robots.map(({ id }) => id));
    this.#session.announce(`${count(this.#session.chosen.length, "robot")} chosen.`);
  }

  #refresh() {
    const now = performance.now();
    if (this.#session.player.playing && now - this.#updated < EVERY_MS) return;
    this.#updated = now;
    this.#filter.refresh();
  }

  #show() {
    const [shown, all] = [this.#filter.robots.length, this.#session.scene.robots.length];
    const robots = all > 0 ? count(all, "robot") : "Robots";
    setText(byId("robots-title"), this.#filter.isOpen ? robots : `${shown} of ${robots}`);
    byId("robot-finder").hidden = all < 2;
    byId("no-robot-found").hidden = all === 0 || shown > 0;
  }

  #onKey(event) {
    if (event.key === "Escape" && this.#field.value !== "") {
      event.preventDefault(); // the page would deselect the robot
      this.#field.value = "";
      this.#filter.set({ text: "" });
    }
    const direction = { ArrowDown: 1, ArrowUp: -1, Enter: event.shiftKey ? -1 : 1 }[event.key];
    if (direction === undefined) return;
    event.preventDefault();
    this.#go(this.#filter.next(this.#session.selected, direction));
  }

  /** Selects a robot and centres the scene on it. */
  #go(id) {
    if (id === null) return;
    this.#session.select(id);
    this.#stage.centre(this.#session.poseOf(id), this.#session.radiusOf(id));
    this.#session.announce(`${id}: ${this.#session.stateOf(id)}`);
  }
}
