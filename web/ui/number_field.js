// A field for a number. Typed text stays as it is. Rejects non-numeric input with a message.

import { element, setText } from "./dom.js";

let made = 0; // fields, for their ids

export class NumberField {
  element;
  input;
  #note;
  #required;
  #shown;
  #rejection = "";

  /**
   * `label` and `unit` in words. `accept(value)` gets each new number, or undefined when the field is emptied unless it
   * is `required`. It may return the reason of a rejection. `settle()` is called when typing has ended. `late`: accepts
   * only then.
   */
  constructor({ label, unit = "", step = "any", required = false, late = false, accept, settle = () => {} }) {
    made += 1;
    const id = `number-${made}`;
    this.#required = required;
    this.input = element("input", { id, type: "number", inputMode: "decimal", step });
    this.#note = element("small", { class: "note", id: `${id}-note` });
    this.input.setAttribute("aria-details", this.#note.id);
    const title = element("label", { htmlFor: id }, label);
    if (unit !== "") title.append(" ", element("span", { class: "unit", textContent: unit }));
    this.element = element("div", { class: "part" }, title, this.input, this.#note);
    const read = () => this.#read(accept);
    this.input.addEventListener("input", () => (late ? this.#showNote("") : read()));
    this.input.addEventListener("change", () => {
      if (late) read();
      settle();
    });
  }

  /** Shows a value: a number, undefined for none, or another value that stands in its place. */
  show(value, { placeholder = "", note = "" } = {}) {
    const number = typeof value === "number" ? value : undefined;
    const kept = document.activeElement === this.input && Object.is(number, this.#shown);
    this.#shown = number;
    this.input.placeholder =
      value === undefined || number !== undefined ? placeholder : JSON.stringify(value);
    if (!kept) this.input.value = number ?? "";
    this.#note.dataset.usual = note;
    this.#showNote(kept ? this.#rejection : "");
  }

  #read(accept) {
    this.#showNote("");
    if (this.#fault() !== "") return;
    const value = this.input.value === "" ? undefined : Number(this.input.value);
    if (Object.is(value, this.#shown)) return;
    const before = this.#shown;
    this.#shown = value; // so that the refresh keeps the typed text
    const rejection = accept(value) ?? "";
    if (rejection === "") return;
    this.#shown = before;
    this.#showNote(rejection);
  }

  /** Shows the fault, if there is one, else the usual note. */
  #showNote(rejection) {
    this.#rejection = rejection;
    const fault = this.#fault();
    this.input.setCustomValidity(fault);
    this.#note.classList.toggle("fault", fault !== "");
    setText(this.#note, fault || (this.#note.dataset.usual ?? ""));
  }

  #fault() {
    const { value, validity } = this.input;
    const missing = value === "" && this.#required && this.#shown !== undefined;
    return validity.badInput || missing ? "Enter a number." : this.#rejection;
  }
}
