// The examples as pictures with their titles, of which one may be chosen. A picture shows the map, robots at their starts,
// and their goals. It is made of the example when it comes into sight, so that a visit loads few of them.

import { readScene, readTracks } from "../model/scene.js";
import { Painter } from "../scene/draw.js";
import { fit } from "../scene/view.js";
import { byId, element } from "../ui/dom.js";
import { prepareRequest } from "./prepare.js";

const SIZE = { width: 92, height: 60 }; // pixels of a picture
const MARGIN = { left: 3, right: 3, bottom: 3, top: 3 }; // pixels around the map
const LOOK = { colours: "robot", paths: "none", heat: "none", lattice: false, travel: null };

export class ExampleChoice {
  #colours;
  #fetchExample;
  #work;
  #box = byId("examples");
  #items = new Map(); // name -> {item, radio, canvas, scene: null until it is drawn}
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
    this.#sights = new IntersectionObserver((seen) => this.#onSight(seen), { root: this.#box });
    colours.onChange(() => this.#items.forEach((item) => item.scene && this.#paint(item)));
  }

  /** `choose(name)` is called when an example is chosen. */
  onChoose(choose) {
    this.#choose = choose;
  }

  /** Lists the examples: [{name, title}]. */
  show(examples) {
    this.#sights.disconnect();
    this.#items = new Map(examples.map((example) => [example.name, this.#item(example)]));
    const items = [...this.#items.values()].map(({ item }) => item);
    this.#box.replaceChildren(
      ...(items.length > 0 ? items : [element("p", { class: "facts", textContent: "No examples" })]),
    );
    for (const { canvas } of this.#items.values()) this.#sights.observe(canvas);
  }

  /** Marks the example that is open; null: none is. */
  mark(name) {
    const found = this.#items.get(name);
    for (const { radio } of this.#items.values()) radio.checked = radio === found?.radio;
    if (name !== this.#marked && found) this.#reveal(found.item);
    this.#marked = name;
  }

  #item({ name, title }) {
    const radio = element("input", { type: "radio", name: "example", value: name, class: "visually-hidden" });
    radio.addEventListener("change", () => this.#choose(name));
    const canvas = element("canvas", { "aria-hidden": "true", "data-example": name });
    return {
      item: element("label", { class: "example" }, radio, canvas, title || name),
      radio,
      canvas,
      scene: null,
    };
  }

  /** Scrolls the examples, and nothing around them. */
  #reveal(item) {
    const [box, inner] = [this.#box, item].map((part) => part.getBoundingClientRect());
    if (inner.left >= box.left && inner.right <= box.right) return;
    this.#box.scrollLeft += (inner.left + inner.right - box.left - box.right) / 2;
  }

  #onSight(seen) {
    for (const { isIntersecting, target } of seen) {
      const name = target.dataset.example;
      if (isIntersecting) this.#drawn = this.#drawn.then(() => this.#draw(name));
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
