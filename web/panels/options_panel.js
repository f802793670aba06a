// The options of the request as a form: each with its default and unit.

import { optionOf, OPTIONS, withOption } from "../model/options.js";
import { byId, element, setText } from "../ui/dom.js";

export class OptionsPanel {
  #session;
  #controls = new Map(); // option -> {input, reset}

  constructor(session) {
    this.#session = session;
    byId("options").replaceChildren(...OPTIONS.map((option) => this.#field(option)));
    byId("reset-options").addEventListener("click", () => this.#resetAll());
    session.on("request", () => this.#refresh());
    session.on("limits", () => this.#takeLimits());
  }

  #field(option) {
    const id = `option-${option.name}`;
    const input = inputFor(option, id);
    const reset = element("button", {
      type: "button",
      class: "reset",
      textContent: "Reset",
      "aria-label": `Reset ${option.label} to ${inWords(option, option.default)}`,
    });
    const note = element("small", { id: `${id}-help` }, `${option.help} `, defaultNote(option));
    input.setAttribute("aria-details", note.id);
    input.addEventListener(input.type === "number" ? "input" : "change", () => this.#take(option, input));
    input.addEventListener("change", () => this.#session.endGesture());
    reset.addEventListener("click", () => {
      this.#edit(option, option.default, null);
      input.focus();
    });
    this.#controls.set(option, { input, reset });
    const label = element("label", { htmlFor: id, textContent: option.label });
    const unit = option.unit ? element("span", { class: "unit", textContent: option.unit }) : null;
    const row = element("div", { class: "value" }, input, unit, reset);
    return element("div", { class: "field option" }, label, row, note);
  }

  #take(option, input) {
    const value = readInput(option, input);
    input.setCustomValidity(value === undefined ? "A number, please." : "");
    if (value !== undefined) this.#edit(option, value, `option ${option.name}`);
  }

  #edit(option, value, gesture) {
    const { request } = this.#session;
    if (request === null || Object.is(optionOf(request, option), value)) return;
    this.#session.edit(withOption(request, option, value), gesture);
  }

  #resetAll() {
    const { options, ...rest } = this.#session.request ?? {};
    if (options !== undefined) this.#session.edit(rest);
  }

  /** The service's own default of the budget may differ from the usual one. */
  #takeLimits() {
    const { default_budget_ms } = this.#session.limits;
    const note = byId("option-time_budget_ms-help").querySelector(".default");
    if (default_budget_ms > 0) setText(note, `Default here: ${default_budget_ms} ms.`);
    byId("option-time_budget_ms").placeholder = String(default_budget_ms ?? "");
  }

  #refresh() {
    const { request } = this.#session;
    for (const [option, { input, reset }] of this.#controls) {
      const value = optionOf(request, option);
      input.disabled = request === null;
      reset.hidden = Object.is(value, option.default);
      if (document.activeElement === input && readInput(option, input) === value) continue; // being typed
      if (input.type === "checkbox") input.checked = value === true;
      else input.value = value ?? "";
      input.setCustomValidity("");
    }
    byId("reset-options").hidden = request?.options === undefined;
  }
}

function inputFor(option, id) {
  const common = { id, "data-pointer": `/options/${option.name}` };
  if (option.choices) {
    const choices = Object.entries(option.choices);
    return element(
      "select",
      common,
      ...choices.map(([value, textContent]) => element("option", { value, textContent })),
    );
  }
  if (typeof option.default === "boolean") return element("input", { ...common, type: "checkbox" });
  const { min, step, unset = "" } = option;
  return element("input", { ...common, type: "number", inputMode: "decimal", min, step, placeholder: unset });
}

/** The value in the input, or undefined if it is none. */
function readInput(option, input) {
  if (input.type === "checkbox") return input.checked;
  if (option.choices) return option.integer ? Number(input.value) : input.value;
  if (input.value === "") return input.validity.badInput ? undefined : option.default;
  return Number(input.value);
}

function defaultNote(option) {
  return element("span", { class: "default", textContent: `Default: ${inWords(option, option.default)}.` });
}

function inWords(option, value) {
  if (option.choices) return option.choices[value].toLowerCase();
  if (typeof value === "boolean") return value ? "on" : "off";
  if (value === null) return option.unset;
  return option.unit ? `${value} ${option.unit}` : String(value);
}
