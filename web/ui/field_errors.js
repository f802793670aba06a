// Errors at the fields they are about. A field, or a group of fields, names what it edits in data-pointer, a JSON
// Pointer into the request. An error is shown at the field with the same pointer, or with the nearest pointer above.

import { element } from "./dom.js";

let made = 0; // messages, for their ids

/** Shows these errors ([{pointer, detail}]) at the fields within `root`, and no others. */
export function showFieldErrors(root, errors) {
  for (const message of root.querySelectorAll(".field-error")) message.remove();
  const fields = [...root.querySelectorAll("[data-pointer]")];
  const texts = new Map(); // field -> details
  for (const { pointer, detail } of errors) {
    const covering = fields.filter((field) => covers(field.dataset.pointer, pointer));
    const nearest = Math.max(...covering.map((field) => field.dataset.pointer.length));
    for (const field of covering) {
      if (field.dataset.pointer.length === nearest) texts.set(field, [...(texts.get(field) ?? []), detail]);
    }
  }
  for (const field of fields) {
    if (texts.has(field)) mark(field, texts.get(field).join(" "));
    else unmark(field);
  }
}

/** Whether people see this error at a field within `root`. */
export function shownIn(root, { pointer, detail }) {
  const field = fieldOf(root, pointer);
  if (field === null || !covers(field.dataset.pointer, pointer)) return false;
  const message = document.getElementById(field.getAttribute("aria-describedby") ?? "");
  return message !== null && message.checkVisibility() && message.textContent.includes(detail);
}

/** The field within `root` for a pointer, or null. */
export function fieldOf(root, pointer) {
  const fields = [...root.querySelectorAll("[data-pointer]")];
  const above = fields.filter((field) => covers(field.dataset.pointer, pointer));
  above.sort((a, b) => b.dataset.pointer.length - a.dataset.pointer.length);
  return above[0] ?? fields.find((field) => field.dataset.pointer.startsWith(`${pointer}/`)) ?? null;
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
