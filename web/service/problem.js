// Faults that are told to people.

/** A failure to show: `problem` has the members of RFC 9457 ("title", "detail", "errors", …). */
export class ProblemError extends Error {
  constructor(problem) {
    super(problem.title);
    this.name = "ProblemError";
    this.problem = problem;
  }
}
