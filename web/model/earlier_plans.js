// The plans of a request that were shown before the present one, to compare them. No DOM.

const MOST = 5;

export class EarlierPlans {
  #session;
  #shown = []; // answers, the latest last

  constructor(session) {
    this.#session = session;
    session.on("request", ({ opened }) => {
      if (opened) this.#shown = [];
    });
    session.on("answer", () => this.#note(session.answer));
  }

  /** The answers before the present one, the latest first. */
  get all() {
    return this.#shown.filter((answer) => answer !== this.#session.answer).reverse();
  }

  #note(answer) {
    const isFinal = this.#session.planning === null;
    if (!isFinal || answer === null || answer.plans.length === 0) return;
    this.#shown = [...this.#shown.filter((each) => each !== answer), answer].slice(-MOST - 1);
  }
}
