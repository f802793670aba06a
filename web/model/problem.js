// Failures that are shown to people, and the places in a request that they point at. Pure.

/** A failure to show: `problem` has the members of RFC 9457 ("title", "detail", "errors", …). */
export class ProblemError extends Error {
  constructor(problem) {
    super(problem.title);
    this.name = "ProblemError";
    this.problem = problem;
  }
}

/** A failure of the connection: nothing is known of what the service did. */
export class ConnectionLost extends ProblemError {
  constructor() {
    super({
      title: "No response from the service",
      detail: "The connection failed or was closed. Is the service running and reachable?",
    });
    this.name = "ConnectionLost";
  }
}

/** The error with a further sentence in its detail, if it is a ProblemError. */
export function withNote(error, note) {
  if (!(error instanceof ProblemError)) return error;
  return new ProblemError({ ...error.problem, detail: `${error.problem.detail ?? ""} ${note}`.trimStart() });
}

/**
 * The message states what is wrong, where in the file, and a remedy; the reader adds the name of the file.
 */
export class FileError extends Error {
  constructor(message) {
    super(message);
    this.name = "FileError";
  }
}

/** A faulty piece of a file, shortened for a message. */
export function quoted(value) {
  const text = JSON.stringify(value);
  return text.length > 30 ? `${text.slice(0, 28)}…` : text;
}

/** The parts of a pointer, unescaped. */
export function partsOf(pointer) {
  return pointer
    .split("/")
    .slice(1)
    .map((part) => part.replaceAll("~1", "/").replaceAll("~0", "~"));
}

/** The index of the robot that a pointer leads to or into, or null. */
export function robotIndexOf(pointer) {
  const [first, index] = partsOf(pointer);
  return first === "robots" && /^\d+$/.test(index ?? "") ? Number(index) : null;
}

/** The row of the map that a pointer leads to, or null. Row 0 is at the top. */
export function mapRowOf(pointer) {
  const [first, rows, row] = partsOf(pointer);
  return first === "map" && rows === "rows" && /^\d+$/.test(row ?? "") ? Number(row) : null;
}
