// Choosing what to plan: an example, a file, pasted text; and the buttons that start and stop planning.

import { byId, element, setText } from "./dom.js";

export class Setup {
  #select = byId("example");
  #file = byId("file");
  #paste = byId("paste");
  #form = byId("paste-form");
  #text = byId("paste-text");
  #plan = byId("plan");
  #cancel = byId("cancel");

  /** `told` has example(name), file(file), text(name, text) (whether it is JSON), plan() and cancel(). */
  constructor(told) {
    this.#select.addEventListener("change", () => {
      if (this.#select.value !== "") told.example(this.#select.value);
    });
    byId("open").addEventListener("click", () => this.#file.click());
    this.#file.addEventListener("change", () => {
      const [file] = this.#file.files;
      if (file) told.file(file);
      this.#file.value = "";
    });
    this.#paste.addEventListener("click", () => this.#showForm(this.#form.hidden));
    this.#form.addEventListener("submit", (event) => {
      event.preventDefault();
      if (!told.text("pasted request", this.#text.value)) return;
      this.#showForm(false);
      this.#plan.focus();
    });
    this.#plan.addEventListener("click", () => told.plan());
    this.#cancel.addEventListener("click", () => told.cancel());
    watchDrops(told.file);
  }

  setExamples(examples) {
    this.#select.replaceChildren(
      ...examples.map(({ name, title }) => element("option", { value: name, textContent: title || name })),
    );
    this.#select.disabled = examples.length === 0;
    if (examples.length === 0)
      this.#select.append(element("option", { value: "", textContent: "No examples" }));
  }

  /** Shows which example is chosen; for a request of one's own, pass its name and `own`. */
  setChosen(name, own = false) {
    this.#select.querySelector("option[data-own]")?.remove();
    if (own) {
      const option = element("option", { value: "", textContent: name, "data-own": "" });
      this.#select.prepend(option);
      this.#select.selectedIndex = 0;
    } else {
      this.#select.value = name;
    }
  }

  describe(description, facts) {
    const paragraph = byId("description");
    setText(paragraph, description);
    paragraph.hidden = description === "";
    setText(byId("facts"), facts);
  }

  /** Whether there is something to plan. */
  setReady(ready) {
    this.#plan.disabled = !ready;
  }

  setPlanning(planning) {
    const hadFocus = document.activeElement;
    this.#cancel.hidden = !planning;
    byId("facts").hidden = planning;
    this.#plan.disabled = planning;
    if (!planning) {
      if (hadFocus === this.#cancel) this.#plan.focus();
      return;
    }
    if (hadFocus === this.#plan) this.#cancel.focus();
  }

  #showForm(shown) {
    this.#form.hidden = !shown;
    this.#paste.setAttribute("aria-expanded", String(shown));
    if (shown) this.#text.focus();
  }
}

/** Opens files dropped anywhere on the page. */
function watchDrops(open) {
  const hint = byId("drop-hint");
  const carriesFile = (event) => event.dataTransfer?.types.includes("Files");
  addEventListener("dragover", (event) => {
    if (!carriesFile(event)) return;
    event.preventDefault();
    hint.hidden = false;
  });
  addEventListener("dragleave", (event) => {
    if (event.relatedTarget === null) hint.hidden = true;
  });
  addEventListener("drop", (event) => {
    if (!carriesFile(event)) return;
    event.preventDefault();
    hint.hidden = true;
    const [file] = event.dataTransfer.files;
    if (file) open(file);
  });
}
