// Choosing what to plan: an example, files opened or dropped on the page, pasted text.

import { byId, element, setText } from "../ui/dom.js";
import { count } from "../ui/format.js";
import { ACCEPT } from "./file_kinds.js";

const DROP = "Drop requests, plans or maps to open them";
const DROP_TO_COMPARE = "Drop another plan to compare it with this one, or requests and maps to open them";

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
    this.#file.accept = ACCEPT;
    this.#select.addEventListener("change", () => {
      if (this.#select.value !== "") opening.example(this.#select.value);
    });
    byId("open").addEventListener("click", () => this.#file.click());
    this.#file.addEventListener("change", () => {
      const files = [...this.#file.files];
      if (files.length > 0) opening.files(files);
      this.#file.value = "";
    });
    this.#paste.addEventListener("click", () => this.#showForm(this.#form.hidden));
    this.#form.addEventListener("submit", (event) => this.#onPaste(event));
    watchDrops((files) => opening.files(files, true));
    session.on("request", () => this.#refresh());
    session.on("answer", () => setText(byId("drop-hint"), session.hasPlan ? DROP_TO_COMPARE : DROP));
    session.on("problem", () => this.#showChosen()); // the chosen example may have failed to load
  }

  /**
   * Lists the examples and opens what the address identifies, with its plan, or else the `preferred` example. See Address
   * and PlanKeeper.
   * @param {string | null} preferred
   */
  async begin(service, address, keeper, preferred = null) {
    const examples = service.listExamples().then((listed) => this.#showExamples(listed));
    const limits = service.fetchLimits().then((known) => this.#session.setLimits(known));
    const loaded = Promise.allSettled([examples, limits]);
    await examples.catch(() => this.#showExamples([]));
    await keeper.restore(await address.begin(this.#examples, preferred));
    for (const each of await loaded) {
      if (each.status === "rejected")
        this.#session.fail(each.reason, () => this.begin(service, address, keeper, preferred));
    }
  }

  #showExamples(examples) {
    this.#examples = examples;
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
    const { grid, robots } = scene;
    const size = grid ? `${grid.columns} × ${grid.rows} cells` : "no map";
    setText(byId("facts"), `${count(robots.length, "robot")}, ${size}`);
    const description = byId("description");
    setText(description, this.#examples.find(({ name }) => name === example)?.description ?? "");
    description.hidden = description.textContent === "";
    byId("scene").setAttribute("aria-label", `Map of ${size} with ${count(robots.length, "robot")}`);
  }

  /** Shows which example is chosen; other and edited requests by their names. */
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

  async #onPaste(event) {
    event.preventDefault();
    if (!(await this.#opening.text("pasted request", this.#text.value))) return;
    this.#showForm(false);
    byId("plan").focus();
  }

  #showForm(shown) {
    this.#form.hidden = !shown;
    this.#paste.setAttribute("aria-expanded", String(shown));
    if (shown) this.#text.focus();
  }
}

/** Calls open([File, …]) with the files of each drop. */
function watchDrops(open) {
  const hint = byId("drop-hint");
  const carriesFiles = (event) => event.dataTransfer?.types.includes("Files");
  addEventListener("dragover", (event) => {
    if (!carriesFiles(event)) return;
    event.preventDefault();
    hint.hidden = false;
  });
  addEventListener("dragleave", (event) => {
    if (event.relatedTarget === null) hint.hidden = true;
  });
  addEventListener("drop", (event) => {
    if (!carriesFiles(event)) return;
    event.preventDefault();
    hint.hidden = true;
    const files = [...(event.dataTransfer?.files ?? [])];
    if (files.length > 0) open(files);
  });
}
