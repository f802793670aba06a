// The service's HTTP interface. Addresses are relative to the page, so that it works below any path.

import { checkAnswer, planFile } from "../model/plan_file.js";
import { ConnectionLost, ProblemError } from "../model/problem.js";

const PAUSES_MS = [200, 800]; // before the second and the third attempt
const BUSY = 503;
const MAX_ATTEMPTS = 6; // at a service that is busy
const LONGEST_WAIT = 60; // seconds for which a busy service is waited for
const LATE_MS = 10_000; // without an answer
const LARGE = 500_000; // characters
const OF_PLAN = ["status", "plans", "unplanned", "flowtime", "makespan", "warnings"];
const END_OF_EVENT = /\r?\n\r?\n/;

let late = 0; // answers
let tellLate = /** @type {(isLate: boolean) => void} */ (() => {});

/** `listener(isLate)` is called when the service has not answered for long, and when it has. */
export function watchLate(listener) {
  tellLate = listener;
}

/** The examples: [{name, title, description, robots, columns, rows}]. */
export async function listExamples() {
  return parseAnswer(await ask("v1/examples"), ["examples"]).examples;
}

/** The text of an example's request. */
export async function fetchExample(name) {
  const text = await ask(`v1/examples/${encodeURIComponent(name)}`);
  parseAnswer(text);
  return text;
}

/** The limits of the service: {default_budget_ms, max_budget_ms, …}. */
export async function fetchLimits() {
  return parseAnswer(await ask("v1/limits"));
}

/** Whether the service asks for a token, which browsers send by themselves as a password. */
export async function needsToken() {
  return (await unlessCut(fetch("v1/limits", { credentials: "omit" }))).status === 401;
}

/** The version of the service. */
export async function fetchVersion() {
  return parseAnswer(await ask("healthz"), ["version"]).version;
}

/** The OpenAPI document of the service, which describes the options of a request. */
export async function fetchOpenApi() {
  return parseAnswer(await ask("v1/openapi.json"));
}

/**
 * Plans the request, a JSON text. Resolves to the answer; rejects with AbortError when aborted. If the service, or a
 * proxy in between, streams events, `listener` gets progress({elapsed_ms, attempt, planned, robots, best}) and
 * incumbent(text), an answer's text. While the service is busy, it gets waiting(seconds).
 */
export async function plan(requestText, signal, listener) {
  return stream("v1/plan", requestText, signal, listener, { last: "plan", wanted: OF_PLAN });
}

/**
 * Simulates a plan, see POST /v1/simulate; `progress({runs, done})` is called meanwhile. Resolves to the figures.
 */
export async function simulate(text, progress) {
  const wanted = ["runs", "collision_share", "robots", "pairs", "first_collisions", "planned", "warnings"];
  return stream("v1/simulate", text, undefined, { progress }, { last: "simulation", wanted });
}

/**
 * Finds margins that hold, see POST /v1/margins; `progress({candidate, candidates, stage, runs, bad})` is called
 * meanwhile. Resolves to what was found; `signal` may abort it.
 */
export async function margins(text, signal, progress) {
  const wanted = ["met", "options", "tried", "advice", "warnings"];
  return stream("v1/margins", text, signal, { progress }, { last: "margins", wanted });
}

/**
 * The dependencies by which robots can execute a plan at their own pace: {dependencies, tight}. They are the plan's
 * own, or the service makes them.
 */
export async function dependencies(request, answer) {
  if (Array.isArray(answer.dependencies)) return answer;
  return post("v1/dependencies", JSON.stringify(planFile(request, answer)), undefined, ["dependencies"]);
}

/** The request of a later moment, see POST /v1/advance. */
export async function advance(text) {
  return post("v1/advance", text, undefined, ["map", "robots"]);
}

/** How long a lone robot takes between poses, see POST /v1/matrix; `signal` may abort it. */
export async function matrix(text, signal) {
  return post("v1/matrix", text, signal);
}

/** Posts a text; resolves to the answer, or to the data of the event `last` if the service streams events. */
async function stream(address, body, signal, listener, { last, wanted }) {
  const headers = {
    "Content-Type": "application/json",
    Accept: "text/event-stream, application/json;q=0.9",
  };
  const response = await send(
    address,
    { method: "POST", headers, body: bodyOf(body), signal },
    listener.waiting,
    Infinity, // who waits for it sees a clock
  );
  const streams = response.headers.get("Content-Type")?.startsWith("text/event-stream");
  const text = await unlessCut(streams ? lastEvent(response, listener, last) : response.text());
  return parseAnswer(text, wanted);
}

/** The service's check of a plan file's text: {valid, violations, min_clearance}; `signal` may abort it. */
export async function validate(text, signal = undefined) {
  return post("v1/validate", text, signal, ["valid", "violations"]);
}

/**
 * A text to send. A large text is sent as a Blob, which Chromium passes on in half the time, and not while the page
 * waits.
 */
const bodyOf = (text) => (text.length > LARGE ? new Blob([text]) : text);

/** The answer to a text. */
async function post(address, body, signal = undefined, wanted = /** @type {string[]} */ ([])) {
  const headers = { "Content-Type": "application/json" };
  const response = await send(address, { method: "POST", headers, body: bodyOf(body), signal });
  return parseAnswer(await unlessCut(response.text()), wanted);
}

/** The text of the event `last`, which ends a stream. Reads to the end, so that the connection can be reused. */
async function lastEvent(response, listener, last) {
  let answer = null;
  for await (const { event, data } of readEvents(response.body)) {
    if (event === "progress") listener.progress(JSON.parse(data));
    if (event === "incumbent") {
      parseAnswer(data, OF_PLAN);
      listener.incumbent(data);
    }
    if (event === last) answer = data;
    if (event === "problem") throw new ProblemError(readProblem(response, data));
  }
  if (answer === null) throw new Error("the stream ended without an answer");
  return answer;
}

/** The text at an address, asked for again a few times while the connection fails. */
async function ask(address) {
  for (const milliseconds of PAUSES_MS) {
    try {
      return await unlessCut((await send(address)).text());
    } catch (error) {
      if (!(error instanceof ConnectionLost)) throw error;
      await pause(milliseconds);
    }
  }
  return unlessCut((await send(address)).text());
}

/**
 * The response; rejects with ProblemError if it is an error. A busy service is asked again when it says; `onWait(seconds)`
 * is called before. After `patience` milliseconds the answer is late.
 */
async function send(
  address,
  init = {},
  /** @type {(seconds: number) => void} */ onWait = () => {},
  patience = LATE_MS,
) {
  for (let attempt = 1; ; attempt += 1) {
    const response = await unlessCut(tellingLate(fetch(address, init), patience));
    if (response.ok) return response;
    const problem = readProblem(response, await unlessCut(response.text()));
    const isBusy = response.status === BUSY && problem.retry_after <= LONGEST_WAIT;
    if (!isBusy || attempt === MAX_ATTEMPTS) throw new ProblemError(problem);
    onWait(problem.retry_after);
    await pause(problem.retry_after * 1000, init.signal);
  }
}

/** What is awaited, which is called late after so many milliseconds. */
async function tellingLate(awaited, patience) {
  let isLate = false;
  const count = (change) => {
    isLate = change > 0;
    late += change;
    tellLate(late > 0);
  };
  const timer = patience < Infinity ? setTimeout(() => count(1), patience) : undefined;
  try {
    return await awaited;
  } finally {
    clearTimeout(timer);
    if (isLate) count(-1);
  }
}

/** Resolves after a time; rejects as `signal`, if there is one, is aborted. */
function pause(milliseconds, signal) {
  return new Promise((resolve, reject) => {
    signal?.throwIfAborted();
    const timer = setTimeout(resolve, milliseconds);
    signal?.addEventListener("abort", () => {
      clearTimeout(timer);
      reject(signal.reason);
    });
  });
}

async function unlessCut(receiving) {
  try {
    return await receiving;
  } catch (error) {
    if (/** @type {Error} */ (error).name === "AbortError" || error instanceof ProblemError) throw error;
    throw new ConnectionLost();
  }
}

function readProblem(response, text) {
  const problem = parseObject(text) ?? {};
  const after = Number(response.headers.get("Retry-After"));
  return {
    ...problem,
    status: problem.status ?? response.status,
    title: problem.title ?? `The service answered ${response.status} ${response.statusText}`.trimEnd(),
    detail: problem.detail ?? "",
    errors: Array.isArray(problem.errors) ? problem.errors : [],
    ...(after > 0 ? { retry_after: after } : {}),
  };
}

/** The answer, which must have the `wanted` members. */
function parseAnswer(text, wanted = /** @type {string[]} */ ([])) {
  const answer = parseObject(text);
  const missing = wanted.find((member) => answer !== null && !(member in answer));
  if (missing !== undefined) throw otherVersion(`Its answer has no “${missing}”.`);
  if (answer !== null && wanted === OF_PLAN) checkPlans(answer);
  if (answer !== null) return answer;
  throw new ProblemError({
    title: "Unexpected response",
    detail: "The response is not JSON. It may come from a proxy.",
  });
}

function checkPlans(answer) {
  try {
    checkAnswer(answer);
  } catch (error) {
    throw otherVersion(/** @type {Error} */ (error).message);
  }
}

const otherVersion = (what) =>
  new ProblemError({
    title: "The service is of another version than this page",
    detail: `${what} Reload the page. If that does not help, ask who runs the service.`,
  });

function parseObject(text) {
  try {
    const value = JSON.parse(text);
    return value !== null && typeof value === "object" ? value : null;
  } catch {
    return null;
  }
}

/** The events of a body (a ReadableStream of bytes) as they arrive: {event, data}; comments are omitted. */
export async function* readEvents(body) {
  const decoder = new TextDecoder();
  const reader = body.getReader();
  let parts = []; // of the current event, which may arrive in many pieces
  let tail = ""; // their last characters, because an end may be split across pieces
  try {
    for (;;) {
      const { done, value } = await reader.read();
      if (done) return;
      const part = decoder.decode(value, { stream: true });
      parts.push(part);
      const ends = END_OF_EVENT.test(tail + part);
      tail = (tail + part).slice(-3);
      if (!ends) continue;
      const blocks = parts.join("").split(END_OF_EVENT);
      parts = [blocks.pop()];
      tail = parts[0].slice(-3);
      for (const block of blocks) {
        const read = readEvent(block);
        if (read.data !== "") yield read;
      }
    }
  } finally {
    await reader.cancel().catch(() => {}); // when the caller stops early
  }
}

function readEvent(block) {
  const data = [];
  let event = "message";
  for (const line of block.split(/\r?\n/)) {
    const [, field, value] = /^([^:]*):? ?(.*)$/s.exec(line) ?? [];
    if (field === "event") event = value;
    if (field === "data") data.push(value);
  }
  return { event, data: data.join("\n") };
}
