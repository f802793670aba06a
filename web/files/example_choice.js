// The gallery of examples: a dialog with a picture, the title and a sentence on each. A picture shows the map, robots at
// their starts, and their goals. It is made of the example when it comes into sight, so that a visit loads few of them.

import { readScene, readTracks } from "../model/scene.js";
import { Painter } from "../scene/draw.js";
import { fit } from "../scene/view.js";
import { byId, element } from "../ui/dom.js";
import { count } from "../ui/format.js";
import { prepareRequest } from "./prepare.js";

const SIZE = { width: 140, height: 92 }; // pixels of a picture
const MARGIN = { left: 4, right: 4, bottom: 4, top: 4 }; // pixels around the map
const LOOK = { colours: "robot", paths: "none", heat: "none", lattice: false, travel: null };

export class ExampleChoice {
  #colours;
  #fetchExample;
  #work;
  #dialog = byId("gallery");
  #box = byId("examples");
  #items = new Map(); // name -> {button, canvas, scene: null until it is drawn}
  #choose = /** @type {(name: string) => void} */ (() => {});
  #sights;
  #drawn = Promise.resolve(); // the pictures that were asked for, one after the other
  /** @type {string | null} */
  #marked = null;

  /** `colours`: see RobotColours; `fetchExample(name)` resolves to an example's text; `work`: see MAP_WORK. */
  constructor(colours, fetchExample, work) {
    this.#colours = colours;
    this.#fetchExample = fetchExample;
    this.#work = work;
    this.#sights = new IntersectionObserver((seen) => this.#onSight(seen), { root: this.#dialog });
    colours.onChange(() => this.#items.forEach((item) => item.scene && this.#paint(item)));
    byId("open-gallery").addEventListener("click", () => this.#open());
    byId("close-gallery").addEventListener("click", () => this.#dialog.close());
    this.#dialog.addEventListener("click", ({ target }) => target === this.#dialog && this.#dialog.close());
  }

  /** `choose(name)` is called when an example is chosen. */
  onChoose(choose) {
    this.#choose = choose;
  }

  /** Lists the examples: [{name, title, description, robots, columns, rows}]. */
  show(examples) {
    this.#sights.disconnect();
    this.#items = new Map(examples.map((example) => [example.name, this.#item(example)]));
    const items = [...this.#items.values()].map(({ button }) => element("li", {}, button));
    const none = element("li", {
      class: "facts",
      textContent: "The service has no examples, or did not list them.",
    });
    this.#box.replaceChildren(...(items.length > 0 ? items : [none]));
    for (const { canvas } of this.#items.values()) this.#sights.observe(canvas);
  }

  /** Marks the example that is open; null: none is. */
  mark(name) {
    this.#marked = name;
    for (const [each, { button }] of this.#items) {
      if (each === name) button.setAttribute("aria-current", "true");
      else button.removeAttribute("aria-current");
    }
  }

  #open() {
    this.#dialog.showModal();
    this.#items.get(this.#marked)?.button.focus();
  }

  #item({ name, title, description, robots, columns, rows }) {
    const canvas = element("canvas", { "aria-hidden": "true" });
    const facts = `${count(robots, "robot")}, ${columns} × ${rows} cells`;
    const button = element(
      "button",
      { type: "button", class: "example", "data-example": name },
      canvas,
      element("strong", { textContent: title || name }),
      element("span", { textContent: description }),
      element("small", { textContent: facts }),
    );
    button.addEventListener("click", () => {
      this.#dialog.close();
      this.#choose(name);
    });
    return { button, canvas, scene: null };
  }

  #onSight(seen) {
    for (const { isIntersecting, target } of seen) {
      const { example } = target.parentElement.dataset;
      if (isIntersecting) this.#drawn = this.#drawn.then(() => this.#draw(example));
    }
  }

  /** Draws a picture. If it cannot be drawn, it is tried again when it comes into sight again. */
  async #draw(name) {
    const found = this.#items.get(name);
    if (!found || found.scene !== null) return;
    try {
      const request = JSON.parse(await this.#fetchExample(name));
      await prepareRequest(request, this.#work, async () => {});
      found.scene = readScene(request);
    } catch {
      return; // who opens it is told why
    }
    this.#paint(found);
    this.#sights.unobserve(found.canvas);
  }

  #paint({ canvas, scene }) {
    const painter = new Painter(canvas);
    painter.show(scene, readTracks(scene, null), this.#colours.theme, LOOK);
    painter.paint({
      camera: fit(scene.grid.bounds, SIZE, MARGIN),
      viewport: SIZE,
      ratio: window.devicePixelRatio || 1,
      time: 0,
      marked: new Set(),
      moving: false,
      overlays: [],
    });
  }
}
