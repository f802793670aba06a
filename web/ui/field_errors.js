// Errors at the fields they are about. A field says what it edits by data-pointer, a JSON Pointer into the request;
// an error is shown at the fields whose pointer it has or lies under.

import { element } from "./dom.js";

let made = 0; // messages, for their ids

/** Shows these errors ([{pointer, detail}]) at the fields within `root`, and no others. */
export function showFieldErrors(root, errors) {
  for (const message of root.querySelectorAll(".field-error")) message.remove();
  for (const field of root.querySelectorAll("[data-pointer]")) {
    const at = errors.filter(({ pointer }) => covers(field.dataset.pointer, pointer));
    if (at.length > 0) mark(field, at.map(({ detail }) => detail).join(" "));
    else unmark(field);
  }
}

/** The field within `root` that is about what a pointer leads to, or null. */
export function fieldOf(root, pointer) {
  const fields = [...root.querySelectorAll("[data-pointer]")];
  return (
    fields.find((field) => field.dataset.pointer === pointer) ??
    fields.find((field) => covers(field.dataset.pointer, pointer)) ??
    fields.find((field) => field.dataset.pointer.startsWith(`${pointer}/`)) ??
    null
  );
}

function covers(own, pointer) {
  return pointer === own || pointer?.startsWith(`${own}/`);
}

function mark(field, text) {
  made += 1;
  const message = element("p", { class: "field-error", id: `field-error-${made}`, textContent: text });
  field.setAttribute("aria-invalid", "true");
  field.setAttribute("aria-describedby", message.id);
  (field.closest(".field") ?? field.parentElement).append(message);
}

function unmark(field) {
  if (!field.hasAttribute("aria-invalid")) return;
  field.removeAttribute("aria-invalid");
  field.removeAttribute("aria-describedby");
}
