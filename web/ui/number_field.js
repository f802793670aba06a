// A field for a number. What is typed stays as it is typed; what is no number is not taken, and that is told.

import { element, setText } from "./dom.js";

let made = 0; // fields, for their ids

export class NumberField {
  element;
  input;
  #note;
  #required;
  #shown;
  #refusal = "";

  /**
   * `label` and `unit` in words; `take(value)` gets each new number, or undefined when the field is emptied
   * unless it is `required`, and may return why not, in words; `settle()` is called when typing has ended.
   * `late`: takes only then.
   */
  constructor({ label, unit = "", step = "any", required = false, late = false, take, settle = () => {} }) {
    made += 1;
    const id = `number-${made}`;
    this.#required = required;
    this.input = element("input", { id, type: "number", inputMode: "decimal", step });
    this.#note = element("small", { class: "note", id: `${id}-note` });
    this.input.setAttribute("aria-details", this.#note.id);
    const title = element("label", { htmlFor: id }, label);
    if (unit !== "") title.append(" ", element("span", { class: "unit", textContent: unit }));
    this.element = element("div", { class: "part" }, title, this.input, this.#note);
    const read = () => this.#read(take);
    this.input.addEventListener("input", () => (late ? this.#tell("") : read()));
    this.input.addEventListener("change", () => {
      if (late) read();
      settle();
    });
  }

  /** Shows a value: a number, undefined for none, or what stands there instead of a number. */
  show(value, { placeholder = "", note = "" } = {}) {
    const number = typeof value === "number" ? value : undefined;
    const kept = document.activeElement === this.input && Object.is(number, this.#shown);
    this.#shown = number;
    this.input.placeholder =
      value === undefined || number !== undefined ? placeholder : JSON.stringify(value);
    if (!kept) this.input.value = number ?? "";
    this.#note.dataset.usual = note;
    this.#tell(kept ? this.#refusal : "");
  }

  #read(take) {
    this.#tell("");
    if (this.#fault() !== "") return;
    const value = this.input.value === "" ? undefined : Number(this.input.value);
    if (Object.is(value, this.#shown)) return;
    const before = this.#shown;
    this.#shown = value; // what is shown next is what is typed
    const refusal = take(value) ?? "";
    if (refusal === "") return;
    this.#shown = before;
    this.#tell(refusal);
  }

  /** Says what is wrong, if something is, else the usual note. */
  #tell(refusal) {
    this.#refusal = refusal;
    const fault = this.#fault();
    this.input.setCustomValidity(fault);
    this.#note.classList.toggle("fault", fault !== "");
    setText(this.#note, fault || (this.#note.dataset.usual ?? ""));
  }

  #fault() {
    const { value, validity } = this.input;
    const missing = value === "" && this.#required && this.#shown !== undefined;
    return validity.badInput || missing ? "A number, please." : this.#refusal;
  }
}
