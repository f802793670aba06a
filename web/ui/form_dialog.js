// A form in a modal dialog. Escape cancels it, Enter submits it, and the focus returns to where it was.

import { element } from "./dom.js";

let made = 0; // dialogs, for the ids of their titles

export class FormDialog {
  #dialog;
  #send;

  /** `title` is its heading, `action` the label of the submit button, `body` the content. */
  constructor(title, action, ...body) {
    made += 1;
    const heading = element("h2", { id: `dialog-title-${made}`, textContent: title });
    const cancel = element("button", { type: "button", textContent: "Cancel" });
    this.#send = element("button", { class: "primary", textContent: action });
    const buttons = element("div", { class: "dialog-buttons" }, cancel, this.#send);
    const content = element("div", { class: "dialog-body" }, ...body);
    const form = element("form", { method: "dialog", autocomplete: "off" }, heading, content, buttons);
    this.#dialog = element("dialog", { class: "form-dialog", "aria-labelledby": heading.id }, form);
    cancel.addEventListener("click", () => this.#dialog.close());
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      this.#dialog.close("sent");
    });
  }

  /** Whether it can be submitted. */
  set ready(ready) {
    this.#send.disabled = !ready;
  }

  /** Shows it; resolves to whether it was submitted. */
  ask() {
    document.body.append(this.#dialog);
    this.#dialog.showModal();
    return new Promise((resolve) => {
      this.#dialog.addEventListener("close", () => {
        this.#dialog.remove();
        resolve(this.#dialog.returnValue === "sent");
      });
    });
  }

  cancel() {
    this.#dialog.close();
  }
}

/**
 * A number to fill in: {field, input}, with its unit and a note. `limits`: min, max and step of the <input>.
 */
export function numberField(id, label, unit, value, limits, note = "") {
  const input = element("input", { id, type: "number", required: true, step: "any", ...limits });
  input.value = String(value);
  const parts = [
    element("label", { htmlFor: id, textContent: label }),
    element(
      "div",
      { class: "value" },
      input,
      unit ? element("span", { class: "unit", textContent: unit }) : null,
    ),
  ];
  if (note) {
    parts.push(element("small", { id: `${id}-note`, textContent: note }));
    input.setAttribute("aria-describedby", `${id}-note`);
  }
  return { input, field: element("div", { class: "field" }, ...parts) };
}
