// Choosing what to plan: an example, files opened or dropped on the page, pasted text.

import { byId, setText } from "../ui/dom.js";
import { count } from "../ui/format.js";
import { ACCEPT } from "./file_kinds.js";

const DROP = "Drop requests, plans or maps to open them";
const DROP_TO_COMPARE = "Drop another plan to compare it with this one, or requests and maps to open them";

export class Setup {
  #session;
  #opening;
  #examples = [];
  #choice;
  #file = byId("file");
  #paste = byId("paste");
  #form = byId("paste-form");
  #text = byId("paste-text");

  /** `opening`: see Opening; `choice`: see ExampleChoice. */
  constructor(session, opening, choice) {
    this.#session = session;
    this.#opening = opening;
    this.#choice = choice;
    this.#file.accept = ACCEPT;
    choice.onChoose((name) => opening.example(name));
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
   * Lists the examples and opens what the address identifies, with its plan, or else the `preferred` example. See Address,
   * PlanKeeper and, for `unkept`, Visits.
   * @param {string | null} preferred
   */
  async begin(service, address, keeper, unkept, preferred = null) {
    const examples = service.listExamples().then((listed) => this.#showExamples(listed));
    const limits = service.fetchLimits().then((known) => this.#session.setLimits(known));
    const loaded = Promise.allSettled([examples, limits]);
    await examples.catch(() => this.#showExamples([]));
    await keeper.restore(await address.begin(this.#examples, preferred, unkept.request), unkept.plan);
    for (const each of await loaded) {
      if (each.status === "rejected")
        this.#session.fail(each.reason, () => this.begin(service, address, keeper, unkept, preferred));
    }
  }

  #showExamples(examples) {
    this.#examples = examples;
    this.#choice.show(examples);
  }

  #refresh() {
    const { example, scene } = this.#session;
    this.#showChosen();
    const { grid, robots } = scene;
    const size = grid ? `${grid.columns} × ${grid.rows} cells` : "no map";
    setText(byId("facts"), `${count(robots.length, "robot")}, ${size}`);
    setText(byId("description"), this.#example(example)?.description ?? "");
    byId("scene").setAttribute("aria-label", `Map of ${size} with ${count(robots.length, "robot")}`);
  }

  /** Shows which example is chosen, and the name of what is open. */
  #showChosen() {
    const { request, example, name, edited } = this.#session;
    if (request === null) return;
    this.#choice.mark(example);
    setText(byId("request-name"), this.#example(example)?.title || (edited ? `${name} (edited)` : name));
  }

  #example(name) {
    return this.#examples.find((each) => each.name === name);
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
