// What to plan is opened here: an example, a file, a text.

import { ProblemError } from "../service/problem.js";

export class Opening {
  #session;
  #fetchExample;
  #turn = 0; // counts choices, so that a late example does not replace a newer choice

  /** `fetchExample(name)` resolves to an example's text. */
  constructor(session, fetchExample) {
    this.#session = session;
    this.#fetchExample = fetchExample;
  }

  /** Whether anything was chosen yet. */
  get begun() {
    return this.#turn > 0;
  }

  async example(name) {
    const turn = (this.#turn += 1);
    try {
      const text = await this.#fetchExample(name);
      if (turn === this.#turn) {
        this.#session.open({ name, example: name, text, request: JSON.parse(text) });
      }
    } catch (error) {
      if (turn === this.#turn) this.#session.fail(error);
    }
  }

  async file(file) {
    const turn = (this.#turn += 1);
    let text;
    try {
      text = await file.text();
    } catch (error) {
      this.#fail("The file cannot be read", `${file.name}: ${error.message}`);
      return;
    }
    if (turn === this.#turn) this.text(file.name, text);
  }

  /** Whether the text is JSON and now open. */
  text(name, text) {
    let request;
    try {
      request = JSON.parse(text);
    } catch (error) {
      this.#fail("That is not JSON", `${name}: ${error.message}`);
      return false;
    }
    this.#turn += 1;
    this.#session.open({ name, example: null, text, request });
    return true;
  }

  #fail(title, detail) {
    this.#session.fail(new ProblemError({ title, detail }));
  }
}
