// The options of the request as a form, each with its default, unit and description. The form follows the
// service's OpenAPI document, which is fetched when the form is needed for the first time.

import { grouped } from "../model/option_groups.js";
import { optionOf, readOptions, withOption } from "../model/options.js";
import { ProblemError } from "../model/problem.js";
import { byId, element, setText } from "../ui/dom.js";

const TAB = "tab-options";
const STEPS = { m: 0.01, s: 0.1, ms: 1 }; // of the arrows in fields for numbers, by unit

export class OptionsPanel {
  #session;
  #fetchDocument;
  #form = byId("options");
  /** @type {Promise<void> | null} */
  #loading = null; // a promise, once the form is needed
  #controls = new Map(); // option -> {input, reset}

  /** `fetchDocument()` resolves to the service's OpenAPI document. */
  constructor(session, tabs, fetchDocument) {
    this.#session = session;
    this.#fetchDocument = fetchDocument;
    byId("reset-options").addEventListener("click", () => this.#resetAll());
    tabs.onChange(() => tabs.chosen === TAB && this.load());
    session.on("request", () => this.#refresh());
    session.on("limits", () => this.#showLimits());
  }

  /**
   * Builds the form unless it is there; resolves when that is done. The next call tries again if it failed.
   */
  load() {
    this.#loading ??= this.#build();
    return this.#loading;
  }

  async #build() {
    this.#showNote("Loading the options…");
    try {
      const options = readOptions(await this.#fetchDocument());
      this.#form.replaceChildren(...grouped(options).map((group) => this.#group(group)));
      this.#showLimits();
      this.#refresh();
    } catch (error) {
      if (!(error instanceof ProblemError)) throw error;
      this.#showNote(`The options could not be loaded: ${error.message}. Open this tab again to retry.`);
      this.#loading = null;
    }
  }

  #showNote(textContent) {
    this.#form.replaceChildren(element("p", { class: "facts", role: "status", textContent }));
  }

  #group({ title, options }) {
    const fields = options.map(({ option, cost }) => this.#field(option, cost));
    const heading = element("summary", {}, element("h2", { textContent: title }));
    return element(
      "details",
      { class: "section option-group", open: title !== "Expert" },
      heading,
      ...fields,
    );
  }

  #field(option, cost) {
    const id = `option-${option.name}`;
    const input = inputFor(option, id);
    const reset = element("button", {
      type: "button",
      class: "reset",
      textContent: "Reset",
      "aria-label": `Reset ${option.label} to ${inWords(option, option.default)}`,
    });
    const note = element(
      "small",
      { id: `${id}-help` },
      ...withCode(option.description),
      " ",
      cost === "" ? "" : element("span", { class: "option-cost", textContent: cost }),
      " ",
      defaultNote(option),
    );
    input.setAttribute("aria-details", note.id);
    input.addEventListener(input.type === "number" ? "input" : "change", () => this.#accept(option, input));
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

  #accept(option, input) {
    const value = readInput(option, input);
    input.setCustomValidity(value === undefined ? "Enter a number." : "");
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

  /** The default of the time budget is a setting of the service. */
  #showLimits() {
    const { default_budget_ms } = this.#session.limits;
    const input = byId("option-time_budget_ms");
    if (input === null || !(default_budget_ms > 0)) return;
    setText(
      byId("option-time_budget_ms-help").querySelector(".default"),
      `Default here: ${default_budget_ms} ms.`,
    );
    input.placeholder = String(default_budget_ms);
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
    const choices = option.choices.map(({ value, label }) =>
      element("option", { value: String(value), textContent: label }),
    );
    return element("select", common, ...choices);
  }
  if (option.type === "boolean") return element("input", { ...common, type: "checkbox" });
  return element("input", {
    ...common,
    type: "number",
    inputMode: "decimal",
    min: option.min ?? "",
    max: option.max ?? "",
    step: option.type === "integer" ? 1 : (STEPS[option.unit] ?? "any"),
    placeholder: option.default === null ? "default" : "",
  });
}

/** The value in the input, or undefined if it is none. */
function readInput(option, input) {
  if (input.type === "checkbox") return input.checked;
  if (option.choices) return option.type === "integer" ? Number(input.value) : input.value;
  if (input.value === "") return input.validity.badInput ? undefined : option.default;
  return Number(input.value);
}

function defaultNote(option) {
  return element("span", { class: "default", textContent: `Default: ${inWords(option, option.default)}.` });
}

function inWords(option, value) {
  if (option.choices) return option.choices.find((choice) => choice.value === value).label.toLowerCase();
  if (typeof value === "boolean") return value ? "on" : "off";
  if (value === null) return option.name === "time_budget_ms" ? "a setting of the service" : "none";
  return option.unit ? `${value} ${option.unit}` : String(value);
}

/** A text with the pieces in backticks as code. */
function withCode(text) {
  return text.split("`").map((piece, at) => (at % 2 === 0 ? piece : element("code", { textContent: piece })));
}
