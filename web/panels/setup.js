// Choosing what to plan: an example, a file, pasted text.

import { byId, element, setText } from "../ui/dom.js";
import { count } from "../ui/format.js";

export class Setup {
  #session;
  #opening;
  #examples = [];
  #select = byId("example");
  #file = byId("file");
  #paste = byId("paste");
  #form = byId("paste-form");
  #text = byId("paste-text");

  /** `opening`: see Opening. */
  constructor(session, opening) {
    this.#session = session;
    this.#opening = opening;
    this.#select.addEventListener("change", () => {
      if (this.#select.value !== "") opening.example(this.#select.value);
    });
    byId("open").addEventListener("click", () => this.#file.click());
    this.#file.addEventListener("change", () => {
      const [file] = this.#file.files;
      if (file) opening.file(file);
      this.#file.value = "";
    });
    this.#paste.addEventListener("click", () => this.#showForm(this.#form.hidden));
    this.#form.addEventListener("submit", (event) => this.#onPaste(event));
    watchDrops((file) => opening.file(file));
    session.on("request", () => this.#refresh());
    session.on("problem", () => this.#showChosen()); // what was chosen may not have come
    addEventListener("hashchange", () => {
      const named = this.#named();
      if (named && named.name !== session.example) opening.example(named.name);
    });
  }

  /** Lists the examples; the first stands ready, or the one that the address names (#name). */
  async begin(service) {
    service.fetchLimits().then(
      (limits) => this.#session.setLimits(limits),
      () => {}, // only the limits are not told then
    );
    try {
      this.#examples = await service.listExamples();
    } catch (error) {
      this.#session.fail(error);
    }
    this.#showExamples();
    const first = this.#named() ?? this.#examples[0];
    if (first && !this.#opening.begun) await this.#opening.example(first.name);
  }

  #named() {
    return this.#examples.find(({ name }) => `#${name}` === location.hash);
  }

  #showExamples() {
    this.#select.replaceChildren(
      ...this.#examples.map(({ name, title }) =>
        element("option", { value: name, textContent: title || name }),
      ),
    );
    this.#select.disabled = this.#examples.length === 0;
    if (this.#examples.length === 0) {
      this.#select.append(element("option", { value: "", textContent: "No examples" }));
    }
  }

  #refresh() {
    const { example, scene } = this.#session;
    this.#showChosen();
    history.replaceState(null, "", example === null ? location.pathname : `#${example}`);
    const { grid, robots } = scene;
    const size = grid ? `${grid.columns} × ${grid.rows} cells` : "no map";
    setText(byId("facts"), `${count(robots.length, "robot")}, ${size}`);
    const description = byId("description");
    setText(description, this.#examples.find(({ name }) => name === example)?.description ?? "");
    description.hidden = description.textContent === "";
    byId("scene").setAttribute("aria-label", `Map of ${size} with ${count(robots.length, "robot")}`);
  }

  /** Shows which example is chosen; a request of one's own, or an edited one, by its name. */
  #showChosen() {
    const { request, example, name, edited } = this.#session;
    if (request === null) return;
    this.#select.querySelector("option[data-own]")?.remove();
    if (example !== null) {
      this.#select.value = example;
      return;
    }
    const textContent = edited ? `${name} (edited)` : name;
    this.#select.prepend(element("option", { value: "", textContent, "data-own": "" }));
    this.#select.selectedIndex = 0;
  }

  #onPaste(event) {
    event.preventDefault();
    if (!this.#opening.text("pasted request", this.#text.value)) return;
    this.#showForm(false);
    byId("plan").focus();
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
