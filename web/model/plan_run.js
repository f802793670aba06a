// A run of planning and its progress. Pure.

/** What the plan of a request minimises: "flowtime" or "makespan". */
export function objectiveOf(request) {
  return request?.options?.objective === "makespan" ? "makespan" : "flowtime";
}

export class PlanRun {
  #control = new AbortController();
  progress = null; // the latest one
  costs = []; // of each better plan: [{elapsed_ms, flowtime, makespan}]
  incumbent = null; // the text of the best answer so far
  waiting = null; // seconds after which a busy service is asked again

  /** `budget`: the time budget, seconds, or null if unknown; `objective`: see objectiveOf. */
  constructor(budget, objective) {
    this.budget = budget;
    this.objective = objective;
  }

  /** Aborts the request. */
  get signal() {
    return this.#control.signal;
  }

  record(progress) {
    this.progress = progress;
    this.waiting = null;
    const { elapsed_ms, best } = progress;
    const least = this.costs.at(-1)?.[this.objective] ?? Infinity;
    if (best !== null && best[this.objective] < least) this.costs.push({ elapsed_ms, ...best });
  }

  stop() {
    this.#control.abort();
  }
}
