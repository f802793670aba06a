// Undo and redo over values that are never changed in place. Pure.

const MOST = 500; // steps back

export class History {
  #past = [];
  #future = [];
  #present;
  #gesture = null;

  constructor(present) {
    this.#present = present;
  }

  get present() {
    return this.#present;
  }

  get canUndo() {
    return this.#past.length > 0;
  }

  get canRedo() {
    return this.#future.length > 0;
  }

  /** A new present. Those that follow one another with the same `gesture` (not null) are one step. */
  push(value, gesture = null) {
    if (gesture === null || gesture !== this.#gesture) {
      this.#past.push(this.#present);
      if (this.#past.length > MOST) this.#past.shift();
    }
    this.replace(value);
    this.#gesture = gesture;
  }

  /** Another present without a step back to this one. */
  replace(value) {
    this.#gesture = null;
    this.#future = [];
    this.#present = value;
  }

  /** The present as it is now is a step of its own. */
  endGesture() {
    this.#gesture = null;
  }

  undo() {
    if (this.canUndo) this.#step(this.#past, this.#future);
  }

  redo() {
    if (this.canRedo) this.#step(this.#future, this.#past);
  }

  #step(from, to) {
    to.push(this.#present);
    this.#present = from.pop();
    this.#gesture = null;
  }
}
