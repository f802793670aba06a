// A run of planning and its progress. Pure.

export class PlanRun {
  #control = new AbortController();
  progress = null; // the latest one
  costs = []; // of each new best plan: [{elapsed_ms, flowtime, makespan}]
  incumbent = null; // the text of the best answer so far

  /** `budget`: the time budget, seconds, or null if unknown. */
  constructor(budget) {
    this.budget = budget;
  }

  /** Aborts the request. */
  get signal() {
    return this.#control.signal;
  }

  record(progress) {
    this.progress = progress;
    const { elapsed_ms, best } = progress;
    if (best !== null && best.flowtime !== this.costs.at(-1)?.flowtime)
      this.costs.push({ elapsed_ms, ...best });
  }

  stop() {
    this.#control.abort();
  }
}
