// Fields of the forms of the Analyse tab.

import { element } from "../ui/dom.js";

let made = 0; // fields, for their ids

/** A number: {field, input}. `limits`: min, max, step. */
export function numberPart(label, unit, value, limits) {
  made += 1;
  const id = `analysis-${made}`;
  const input = element("input", {
    id,
    type: "number",
    inputMode: "decimal",
    required: true,
    step: "any",
    ...limits,
  });
  input.value = String(value);
  const title = element("label", { htmlFor: id }, label);
  if (unit !== "") title.append(" ", element("span", { class: "unit", textContent: unit }));
  return { input, field: element("div", { class: "part" }, title, input) };
}

/** A choice of [{value, label}]: {field, input}. */
export function choicePart(label, choices, value) {
  made += 1;
  const id = `analysis-${made}`;
  const input = element(
    "select",
    { id },
    ...choices.map((choice) => element("option", { value: choice.value, textContent: choice.label })),
  );
  input.value = value;
  const field = element(
    "div",
    { class: "field" },
    element("label", { htmlFor: id, textContent: label }),
    input,
  );
  return { input, field };
}

export function button(textContent, press, properties = {}) {
  const made = element("button", { type: "button", textContent, ...properties });
  made.addEventListener("click", press);
  return made;
}
