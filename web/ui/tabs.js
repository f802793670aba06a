// Tabs after ARIA's authoring practices. Arrows move between them. Only the chosen tab is in the tab order.

import { byId } from "./dom.js";

const panelOf = (tab) => byId(tab.getAttribute("aria-controls"));

export class Tabs {
  #listeners = [];
  #tabs;

  /** `list`: the element with role=tablist; its buttons name their panels by aria-controls. */
  constructor(list) {
    this.#tabs = [...list.querySelectorAll("[role=tab]")];
    for (const tab of this.#tabs) tab.addEventListener("click", () => this.choose(tab.id));
    list.addEventListener("keydown", (event) => this.#onKey(event));
    this.choose(this.#tabs[0].id);
  }

  /** The id of the tab whose panel is shown. */
  get chosen() {
    return this.#tabs.find((tab) => tab.tabIndex === 0).id;
  }

  /** Calls `listener` when another tab is chosen. */
  onChange(listener) {
    this.#listeners.push(listener);
  }

  /** Shows the panel of the tab with this id. */
  choose(id) {
    for (const tab of this.#tabs) {
      const chosen = tab.id === id;
      tab.setAttribute("aria-selected", String(chosen));
      tab.tabIndex = chosen ? 0 : -1;
      panelOf(tab).hidden = !chosen;
    }
    for (const listener of this.#listeners) listener();
  }

  /** Shows the panel that holds an element. */
  reveal(part) {
    const tab = this.#tabs.find((each) => {
      return panelOf(each).contains(part);
    });
    if (tab) this.choose(tab.id);
  }

  #onKey(event) {
    const at = this.#tabs.findIndex((tab) => tab.tabIndex === 0);
    const last = this.#tabs.length - 1;
    const targets = {
      ArrowRight: at === last ? 0 : at + 1,
      ArrowLeft: at === 0 ? last : at - 1,
      Home: 0,
      End: last,
    };
    if (!(event.key in targets)) return;
    event.preventDefault();
    const tab = this.#tabs[targets[event.key]];
    this.choose(tab.id);
    tab.focus();
  }
}
