// Events and their listeners. Pure.

/** Named events with listeners, called in the order of registration. */
export class Signals {
  #listeners = new Map(); // name -> [listener]

  /** Calls `listener` with the detail of each event of these names (separated by spaces). */
  on(names, listener) {
    for (const name of names.split(" ")) {
      if (!this.#listeners.has(name)) this.#listeners.set(name, []);
      this.#listeners.get(name).push(listener);
    }
  }

  emit(name, detail) {
    for (const listener of this.#listeners.get(name) ?? []) listener(detail);
  }
}
