// Typing a time: the clock becomes a field, until a time is entered or Escape is pressed.

import { readTime } from "../model/time_text.js";
import { byId } from "../ui/dom.js";

export class TimeEntry {
  #session;
  #clock = byId("clock");
  #field = byId("time-entry");

  constructor(session) {
    this.#session = session;
    this.#clock.addEventListener("click", () => this.begin());
    this.#field.addEventListener("keydown", (event) => this.#onKey(event));
    this.#field.addEventListener("input", () => this.#field.setCustomValidity(""));
    this.#field.addEventListener("blur", () => this.#show(false));
    session.on("answer", () => (this.#clock.disabled = session.player.duration <= 0));
  }

  /** Shows the field, with the present time in it. */
  begin() {
    const { player } = this.#session;
    if (player.duration <= 0) return;
    this.#session.pause();
    this.#field.value = player.time.toFixed(2);
    this.#field.setCustomValidity("");
    this.#show(true);
    this.#field.focus();
    this.#field.select();
  }

  #onKey(event) {
    if (event.key !== "Enter" && event.key !== "Escape") return;
    event.preventDefault();
    if (event.key === "Enter" && !this.#seek()) return;
    this.#show(false);
    this.#clock.focus();
  }

  /** Goes to the time; returns whether there is one. */
  #seek() {
    const time = readTime(this.#field.value, this.#session.player.duration);
    if (time === null) {
      this.#field.setCustomValidity("Enter seconds, minutes:seconds, or a percentage.");
      this.#field.reportValidity();
      return false;
    }
    this.#session.seek(time);
    this.#session.announce(`${this.#session.player.time.toFixed(2)} seconds`);
    return true;
  }

  #show(shown) {
    this.#field.hidden = !shown;
    this.#clock.hidden = shown;
  }
}
