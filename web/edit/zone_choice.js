// Which zone is edited.

import { zonesOf } from "../model/listed.js";
import { Signals } from "../model/signals.js";

export class ZoneChoice {
  #session;
  #signals = new Signals();
  /** @type {number | null} */
  #index = null;

  constructor(session) {
    this.#session = session;
    session.on("request", ({ opened }) => {
      if (opened || (this.#index ?? 0) >= zonesOf(session.request).length) this.choose(null);
    });
  }

  /** The index among the request's zones, or null. */
  get index() {
    return this.#index;
  }

  /** The zone as it is in the request, or null. */
  get zone() {
    return this.#index === null ? null : (zonesOf(this.#session.request)[this.#index] ?? null);
  }

  choose(index) {
    if (index === this.#index) return;
    this.#index = index;
    this.#signals.emit("change");
  }

  onChange(listener) {
    this.#signals.on("change", listener);
  }
}
