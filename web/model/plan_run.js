// What is known of one planning while it lasts. Pure.

export class PlanRun {
  #control = new AbortController();
  progress = null; // the service's last, see client.js
  costs = []; // the best so far, each lower than the one before: [{elapsed_ms, flowtime, makespan}]
  incumbent = null; // the text of the best answer so far

  /** `budget`: how long it may take, seconds, or null if that is not known. */
  constructor(budget) {
    this.budget = budget;
  }

  /** What ends the request when it is aborted. */
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
