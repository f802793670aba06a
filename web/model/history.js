// Undo and redo of immutable values. Pure.

const MAX = 500; // steps back

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

  /** A new present value. Consecutive values with the same `gesture` (not null) are one step. */
  push(value, gesture = null) {
    if (gesture === null || gesture !== this.#gesture) {
      this.#past.push(this.#present);
      if (this.#past.length > MAX) this.#past.shift();
    }
    this.replace(value);
    this.#gesture = gesture;
  }

  /** Replaces the present value without an undo step. */
  replace(value) {
    this.#gesture = null;
    this.#future = [];
    this.#present = value;
  }

  /** Replaces the present value, which stays the same step: undone steps can still be done again. */
  amend(value) {
    this.#present = value;
  }

  /** Ends the gesture: the next value is a new step. */
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
