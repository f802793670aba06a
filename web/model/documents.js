// What is open: the present document (see document.js), and the documents before and after it, which undo and redo
// restore.

import { answered, documentOf, edited } from "./document.js";
import { History } from "./history.js";

export class Documents {
  #history = new History(documentOf());

  get present() {
    return this.#history.present;
  }

  get request() {
    return this.present.request;
  }

  get #opened() {
    return this.present.opened;
  }

  get name() {
    return this.#opened.name;
  }

  get isEdited() {
    return this.request !== this.#opened.request;
  }

  /** The name of the example if this is one and unchanged, or null. */
  get example() {
    return this.isEdited ? null : this.#opened.example;
  }

  /** The request as JSON: the opened text, until it is edited. */
  get text() {
    return this.isEdited ? JSON.stringify(this.request) : this.#opened.text;
  }

  /** The request that the answer is of, as JSON. */
  get plannedText() {
    const { planned } = this.present;
    return planned === this.request ? this.text : JSON.stringify(planned);
  }

  get canUndo() {
    return this.#history.canUndo;
  }

  get canRedo() {
    return this.#history.canRedo;
  }

  /** Opens another request, see documentOf. Undo restores the previous request if it was edited. */
  open(opened) {
    if (this.isEdited) this.#history.push(documentOf(opened));
    else this.#history.replace(documentOf(opened));
  }

  /** Edits in a row with the same `gesture` are one undo step. */
  edit(request, gesture) {
    this.#history.push(edited(this.present, request), gesture);
  }

  endGesture() {
    this.#history.endGesture();
  }

  /** Takes an answer of the request, or none (null). */
  adopt(answer) {
    this.#history.amend(answered(this.present, answer));
  }

  /** Goes on with the request of a later moment of the same fleet, and its answer. */
  proceed(request, answer) {
    const opened = { ...this.#opened, example: null, text: JSON.stringify(request), request };
    this.#history.replace(answered(documentOf(opened), answer));
  }

  /** Returns whether another request is open again, not only this one before its edit. */
  undo() {
    return this.#step(() => this.#history.undo());
  }

  /** Likewise. */
  redo() {
    return this.#step(() => this.#history.redo());
  }

  #step(take) {
    const before = this.#opened;
    take();
    return this.#opened !== before;
  }
}
