// A robot named in a text.

import { element } from "../ui/dom.js";

/** A button that names a robot and selects it. */
export function robotChip(session, id) {
  const button = element("button", { type: "button", class: "chip", textContent: id, "data-chip": id });
  button.addEventListener("click", () => session.select(id));
  button.addEventListener("pointerenter", () => session.hover(id));
  button.addEventListener("pointerleave", () => session.hover(null));
  return button;
}
