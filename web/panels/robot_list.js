// The list of robots with their current states, and robots named in a text.

import { ChunkedList } from "../ui/chunked_list.js";
import { byId, element, scrollWithin, setText } from "../ui/dom.js";
import { count, seconds } from "../ui/format.js";

const PAGE = 10; // robots that the page keys move by
const EVERY_MS = 150; // between updates while playing

export class RobotList {
  #session;
  #colours;
  #filter;
  #list = byId("robots");
  #rows = new Map(); // of what is in the document: id -> {button, state}
  #chunks = new ChunkedList(this.#list, () => this.#update());
  #updated = -Infinity;

  /** `colours`: see RobotColours; `filter`: see RobotFilter. */
  constructor(session, colours, filter) {
    this.#session = session;
    this.#colours = colours;
    this.#filter = filter;
    const idOf = (event) => event.target.closest("button")?.dataset.robot ?? null;
    this.#list.addEventListener("click", (event) => {
      const id = idOf(event);
      if (id !== null) this.#choose(id, event);
    });
    this.#list.addEventListener("keydown", (event) => {
      const id = idOf(event);
      if (this.#move(event, id)) return;
      if (event.key !== "Enter" || !(event.ctrlKey || event.metaKey) || id === null) return;
      event.preventDefault(); // browsers do not click with Ctrl
      session.toggleChosen(id);
    });
    this.#list.addEventListener("pointerover", (event) => session.hover(idOf(event)));
    this.#list.addEventListener("pointerleave", () => session.hover(null));
    this.#list.addEventListener("focusin", (event) => {
      this.#stopAt(idOf(event));
      session.hover(idOf(event));
    });
    this.#list.addEventListener("focusout", () => session.hover(null));
    filter.onChange(() => this.#show());
    colours.onChange(() => this.#show());
    session.on("marks", () => {
      this.#update();
      this.#reveal(session.selected);
    });
    session.on("playback", () => this.#update());
    session.on("time", () => {
      if (!session.player.playing || performance.now() - this.#updated >= EVERY_MS) this.#update();
    });
  }

  /** Moves the focus to another robot, or to the card of this one; returns whether the key is for that. */
  #move(event, id) {
    const { robots } = this.#filter;
    const at = robots.findIndex((robot) => robot.id === id);
    if (at < 0 || event.ctrlKey || event.metaKey || event.altKey) return false;
    if (event.key === "ArrowRight") {
      if (this.#session.selected !== id) this.#session.select(id);
      focusCard();
      event.preventDefault();
      return true;
    }
    const last = robots.length - 1;
    const places = {
      ArrowDown: at + 1,
      ArrowUp: at - 1,
      PageDown: at + PAGE,
      PageUp: at - PAGE,
      Home: 0,
      End: last,
    };
    if (!(event.key in places)) return false;
    event.preventDefault();
    const to = robots[Math.min(last, Math.max(0, places[event.key]))].id;
    this.#chunks.fillAt(robots.findIndex((robot) => robot.id === to));
    this.#rows.get(to)?.button.focus();
    return true;
  }

  /** The list is one stop of the tab key: the robot with the focus, or the selected one, or the first. */
  #stopAt(id) {
    const stop = this.#rows.has(id) ? id : (this.#rows.keys().next().value ?? null);
    for (const [each, { button }] of this.#rows) button.tabIndex = each === stop ? 0 : -1;
  }

  #choose(id, { ctrlKey, metaKey, shiftKey }) {
    const { selected } = this.#session;
    if (ctrlKey || metaKey) this.#session.toggleChosen(id);
    else if (shiftKey && selected !== null) this.#session.highlight(this.#filter.range(selected, id));
    else this.#session.toggle(id);
  }

  #show() {
    const { robots } = this.#filter;
    this.#rows.clear();
    this.#chunks.show(robots.length, (index) => {
      const robot = robots[index];
      const row = this.#row(robot, this.#session.tracks.get(robot.id));
      this.#rows.set(robot.id, row);
      const place = { "aria-posinset": String(index + 1), "aria-setsize": String(robots.length) };
      return element("div", { role: "listitem", ...place }, row.button);
    });
  }

  #row(robot, track) {
    const filled = track.status === "unplanned" ? "" : " filled";
    const swatch = element("span", { class: `swatch${filled}` });
    swatch.style.color = this.#colours.of(robot.index);
    const state = element("span", { class: `robot-state ${track.status}` });
    const cost = element("span", {
      class: "robot-cost",
      textContent: track.cost === null ? "" : seconds(track.cost),
    });
    const id = element("span", { class: "robot-id", textContent: robot.id, title: robot.id });
    const button = element("button", {
      type: "button",
      class: "robot",
      "aria-pressed": "false",
      "data-robot": robot.id,
    });
    button.append(swatch, id, state, cost);
    return { button, state };
  }

  #update() {
    this.#updated = performance.now();
    const { hovered, marked } = this.#session;
    for (const [id, { button, state }] of this.#rows) {
      if (!button.isConnected) {
        this.#rows.delete(id); // its part of the list is out of sight
        continue;
      }
      setText(state, this.#session.stateOf(id));
      button.classList.toggle("hovered", id === hovered);
      const pressed = String(id !== hovered ? marked.has(id) : id === this.#session.selected);
      if (button.getAttribute("aria-pressed") !== pressed) button.setAttribute("aria-pressed", pressed);
    }
    const focused = /** @type {HTMLElement | null} */ (document.activeElement)?.dataset.robot;
    this.#stopAt(this.#list.contains(document.activeElement) ? focused : this.#session.selected);
  }

  #reveal(id) {
    if (id === this.#revealed) return;
    this.#revealed = id;
    this.#chunks.fillAt(this.#filter.robots.findIndex((robot) => robot.id === id));
    const button = this.#rows.get(id)?.button;
    if (button?.checkVisibility()) scrollWithin(button.closest(".side-body"), button);
  }

  #revealed = null;
}

/** Leads to the card of the selected robot, which Escape closes. */
function focusCard() {
  const card = byId("inspector");
  if (!card.hidden) card.focus();
}

/** The end of a list that names only the first of `total` robots; null when it names all. */
function andMore(listed, total) {
  return total > listed.length ? `and ${count(total - listed.length, "more", "more")}` : null;
}

/** The robots that block another robot, which is an entry of `unplanned` or of stuckOf. Null if it names none. */
export function blockedBy(session, { blocked_by = [], blocked_by_total = 0 }) {
  if (blocked_by.length === 0) return null;
  const chips = blocked_by.map((id) => robotChip(session, id));
  return element("div", { class: "chips" }, "Blocked by:", ...chips, andMore(blocked_by, blocked_by_total));
}

/** A button that names a robot and selects it. */
export function robotChip(session, id) {
  const button = element("button", { type: "button", class: "chip", textContent: id, "data-chip": id });
  button.addEventListener("click", () => session.select(id));
  button.addEventListener("pointerenter", () => session.hover(id));
  button.addEventListener("pointerleave", () => session.hover(null));
  return button;
}
