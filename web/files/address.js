// The page's address says what is open: an example by its name (#name), and any other request itself where it is
// small enough (#r=…), so that it can be bookmarked, sent and loaded again.

import { isLinkState, LONGEST_LINK, writeLinkState } from "./link_state.js";

const REST_MS = 400; // without a further edit
const LONGEST_TEXT = 2 ** 20; // characters of a request to compress unasked

export class Address {
  #session;
  #opening;
  #timer = null;
  #examples = [];

  /** `opening`: see Opening. */
  constructor(session, opening) {
    this.#session = session;
    this.#opening = opening;
    session.on("request", () => this.#showSoon());
    addEventListener("hashchange", () => this.#follow());
  }

  /** Opens what the address says, or else the first of the examples ([{name}]). */
  async begin(examples) {
    this.#examples = examples;
    if (this.#opening.begun) return;
    let problem = null;
    if (isLinkState(location.hash)) {
      if (await this.#opening.link(location.hash)) return;
      problem = this.#session.problem;
    }
    const first = this.#named() ?? examples[0];
    if (first && (await this.#opening.example(first.name)) && problem) this.#session.setProblem(problem);
  }

  /** An address that opens the session's request: {address, length}, the length being that of the fragment. */
  async link() {
    const { example, request } = this.#session;
    const fragment = example === null ? await writeLinkState(request) : `#${example}`;
    return { address: new URL(fragment, location.href).href, length: fragment.length };
  }

  #named() {
    return this.#examples.find(({ name }) => `#${name}` === location.hash);
  }

  #follow() {
    const named = this.#named();
    if (isLinkState(location.hash)) this.#opening.link(location.hash);
    else if (named && named.name !== this.#session.example) this.#opening.example(named.name);
  }

  #showSoon() {
    clearTimeout(this.#timer);
    const { example } = this.#session;
    if (example !== null) {
      put(`#${example}`);
      return;
    }
    if (!isLinkState(location.hash)) put(""); // no example any longer
    this.#timer = setTimeout(() => this.#showRequest(), REST_MS);
  }

  async #showRequest() {
    const { request, text, turn } = this.#session;
    const fragment = text.length <= LONGEST_TEXT ? await writeLinkState(request) : "";
    if (turn === this.#session.turn) put(fragment.length <= LONGEST_LINK ? fragment : "");
  }
}

function put(fragment) {
  history.replaceState(null, "", `${location.pathname}${location.search}${fragment}`);
}
