// The service's HTTP interface. Addresses are relative to the page, so that it also works below a path.

/** A failure to show: `problem` has the members of RFC 9457 ("title", "detail", "errors", …). */
export class ProblemError extends Error {
  constructor(problem) {
    super(problem.title);
    this.name = "ProblemError";
    this.problem = problem;
  }
}

/** The examples: [{name, title, description, robots, columns, rows}]. */
export async function listExamples() {
  return parseAnswer(await ask("v1/examples")).examples;
}

/** The text of an example's request. */
export async function fetchExample(name) {
  const text = await ask(`v1/examples/${encodeURIComponent(name)}`);
  parseAnswer(text);
  return text;
}

/** Plans the request, a JSON text. The answer, parsed and as it came; rejects with AbortError when aborted. */
export async function plan(requestText, signal) {
  const text = await ask("v1/plan", {
    method: "POST",
    headers: { "Content-Type": "application/json", Accept: "application/json" },
    body: requestText,
    signal,
  });
  return { answer: parseAnswer(text), text };
}

async function ask(address, init) {
  let response;
  let text;
  try {
    response = await fetch(address, init);
    text = await response.text();
  } catch (error) {
    if (error.name === "AbortError") throw error;
    throw new ProblemError({
      title: "No answer from the service",
      detail: "The connection failed or was cut. Is the service running and reachable from here?",
    });
  }
  if (!response.ok) throw new ProblemError(readProblem(response, text));
  return text;
}

function readProblem(response, text) {
  const problem = parseObject(text) ?? {};
  const after = Number(response.headers.get("Retry-After"));
  return {
    ...problem,
    status: response.status,
    title: problem.title ?? `The service answered ${response.status} ${response.statusText}`.trimEnd(),
    detail: problem.detail ?? "",
    errors: Array.isArray(problem.errors) ? problem.errors : [],
    ...(after > 0 ? { retry_after: after } : {}),
  };
}

function parseAnswer(text) {
  const answer = parseObject(text);
  if (answer !== null) return answer;
  throw new ProblemError({
    title: "Not an answer of the service",
    detail: "Something else answered in its place, perhaps a proxy on the way.",
  });
}

function parseObject(text) {
  try {
    const value = JSON.parse(text);
    return value !== null && typeof value === "object" ? value : null;
  } catch {
    return null;
  }
}
