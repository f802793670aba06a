// Lists to choose one thing from, or none.

import { element } from "./dom.js";

/** Shows the names of things in a select element, after an entry for `none`, with the one at `index` (or null) chosen. */
export function showChoices(list, names, none, index) {
  const options = names.map((textContent, value) => element("option", { value, textContent }));
  list.replaceChildren(element("option", { value: "", textContent: none }), ...options);
  list.value = index ?? "";
  list.disabled = names.length === 0;
}

/** The index that is chosen there, or null. */
export const chosenIn = (list) => (list.value === "" ? null : Number(list.value));
