// A list of any length. If it is long, only the parts near the visible rows are in the document, in chunks of rows of
// one height, see styles/panels.css.

import { element } from "./dom.js";

const CHUNK = 50; // rows
const WHOLE = 200; // rows: up to as many, the whole list is there
const NEAR = "600px"; // around the visible part of the page

export class ChunkedList {
  #list;
  #chunks = [];
  /** @type {(index: number) => Element} */
  #makeRow = () => element("div");
  #onFill;
  #observer = new IntersectionObserver((entries) => this.#follow(entries), { rootMargin: NEAR });

  /** `list` has the role "list". `onFill()` is called after rows were put into the document, or taken out. */
  constructor(list, onFill) {
    this.#list = list;
    this.#onFill = onFill;
    list.addEventListener("focusin", () => this.#followFocus());
  }

  /** Shows `count` rows; `makeRow(index)` makes one. */
  show(count, makeRow) {
    this.#observer.disconnect();
    this.#makeRow = makeRow;
    const size = count <= WHOLE ? Math.max(1, count) : CHUNK;
    this.#chunks = Array.from({ length: Math.ceil(count / size) }, (_, at) => {
      const first = at * size;
      const rows = Math.min(size, count - first);
      const box = element("div", { class: "chunk", role: "none" });
      box.style.setProperty("--rows", String(rows));
      return { box, first, rows };
    });
    this.#list.replaceChildren(...this.#chunks.map(({ box }) => box));
    if (this.#chunks.length === 1) this.#fill(this.#chunks[0]);
    else this.#chunks.forEach(({ box }) => this.#observer.observe(box));
    this.#onFill();
  }

  /** Puts the row at an index into the document. */
  fillAt(index) {
    const chunk = this.#chunks.find(({ first, rows }) => index >= first && index < first + rows);
    if (chunk === undefined || chunk.box.firstChild !== null) return;
    this.#fill(chunk);
    this.#onFill();
  }

  #fill({ box, first, rows }) {
    box.append(...Array.from({ length: rows }, (_, at) => this.#makeRow(first + at)));
  }

  /** The chunks with the focus and beside it, so that the tab key finds the next row. */
  get #aroundFocus() {
    const at = this.#chunks.findIndex(({ box }) => box.contains(document.activeElement));
    return at < 0 ? [] : this.#chunks.slice(Math.max(0, at - 1), at + 2);
  }

  #followFocus() {
    const missing = this.#aroundFocus.filter(({ box }) => box.firstChild === null);
    missing.forEach((chunk) => this.#fill(chunk));
    if (missing.length > 0) this.#onFill();
  }

  #follow(entries) {
    const kept = this.#aroundFocus;
    for (const { target, isIntersecting } of entries) {
      const chunk = this.#chunks.find(({ box }) => box === target);
      if (chunk === undefined) continue;
      const isFilled = target.firstChild !== null;
      if (isIntersecting && !isFilled) this.#fill(chunk);
      if (!isIntersecting && isFilled && !kept.includes(chunk)) target.replaceChildren();
    }
    this.#onFill();
  }
}
