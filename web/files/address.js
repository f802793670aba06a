// The page's address identifies what is open, so that it can be bookmarked and shared. An example has its name (#name).
// Any other request has its content if it is small enough (#r=…). A larger request is kept in this browser, and the
// address identifies it only here (#kept=…).

import { FileError } from "../model/problem.js";
import { amendEntry, entryState, pushEntry } from "./entry.js";
import { freshId } from "./kept.js";

const REST_MS = 400; // without a further edit
const MAX_TO_COMPRESS = 2 ** 20; // characters: longer requests are not compressed after each edit
const PREFIX = "#r=";
const KEPT = "#kept=";
const MOMENT = "@"; // before the seconds at the end of a fragment
const LONGEST_TEXT = 8 * 2 ** 20; // bytes when inflated
const MAX_ENTRIES = 20; // of the browser's history whose requests are remembered

export class Address {
  #session;
  #opening;
  /** @type {number | undefined} */
  #timer;
  #examples = [];
  #kept;
  /** @type {string | null} */
  #keptId = null; // of this page's request
  #isLarge = false; // the request is too large for a link
  #isKept = true; // the address leads to the request as it is now
  #left = new Map(); // entries of the history that another request has replaced: key -> what was open, see Session.open
  /** @type {any} */
  #shown = null; // what is open: {opened, answer}
  #isGoingBack = false; // or forth
  /** @type {string | null} */
  #followed = null; // the fragment of the entry that it went back to

  /**
   * The moment of the plan that the address asked for, seconds; null: none.
   * @type {number | null}
   */
  moment = null;

  /** `opening`: see Opening; `kept`: see keptRequests. */
  constructor(session, opening, kept) {
    this.#session = session;
    this.#opening = opening;
    this.#kept = kept;
    session.on("request", (detail) => this.#onRequest(detail));
    session.on("answer", () => this.#remember());
    addEventListener("beforeunload", (event) => {
      if (this.#isLarge && !this.#isKept) event.preventDefault(); // the browser asks whether to leave
    });
    // The event's address: by now, the page may have replaced it by the address of its request.
    addEventListener("hashchange", ({ newURL }) => this.#follow(new URL(newURL).hash));
    addEventListener("popstate", ({ state }) => this.#goBack(state?.key));
  }

  /** The request as JSON if the address does not lead to it yet, or null. */
  get unkept() {
    return this.#isKept ? null : this.#session.text;
  }

  /**
   * Opens what the address identifies, or else the `preferred` one of the examples ([{name}]), or the first one; resolves
   * to whether it is what the address identifies. `unkept`: the text of the request to which the address would lead if
   * the page had not ended before, or null.
   * @param {string | null} preferred
   * @param {string | null} unkept
   */
  async begin(examples, preferred = null, unkept = null) {
    this.#examples = examples;
    if (this.#opening.begun) return false;
    this.moment = momentOf(location.hash);
    if (this.moment !== null) put(withoutMoment(location.hash));
    const { name } = entryState();
    if (unkept !== null && (await this.#opening.text(name ?? "request", unkept))) return true;
    let problem = null;
    if (location.hash !== "" && !isOwn(location.hash) && !this.#named(location.hash)) {
      problem = unknownFragment(location.hash);
    }
    if (isOwn(location.hash)) {
      if (await this.#openOwn(location.hash)) return true;
      problem = this.#session.problem;
    }
    const named = this.#named(location.hash);
    const first = named ?? examples.find(({ name }) => name === preferred) ?? examples[0];
    if (first === undefined || !(await this.#opening.example(first.name))) return false;
    if (problem) this.#session.setProblem(problem);
    return named !== undefined;
  }

  /**
   * An address that opens the session's request, at a moment of its plan if there is one (seconds): {address, length}, with
   * the length of the fragment.
   */
  async link(moment = /** @type {number | null} */ (null)) {
    const { example, request } = this.#session;
    const open = example === null ? await writeLinkState(request) : `#${example}`;
    const fragment = moment === null ? open : `${open}${MOMENT}${Number(moment.toFixed(2))}`;
    return { address: new URL(fragment, location.href).href, length: fragment.length };
  }

  #named(fragment) {
    return this.#examples.find(({ name }) => `#${name}` === fragment);
  }

  #follow(fragment) {
    if (fragment === this.#followed) return;
    const named = this.#named(fragment);
    if (isOwn(fragment)) this.#openOwn(fragment);
    else if (named && named.name !== this.#session.example) this.#opening.example(named.name);
    else if (!named && fragment !== "") this.#session.setProblem(unknownFragment(fragment));
  }

  #remember() {
    const { name, example, request, answer, outdated } = this.#session;
    if (request === null) return;
    this.#shown = { opened: { name, example, request }, answer: outdated === null ? answer : null };
  }

  #onRequest({ opened, restored = false }) {
    const isFirst = this.#shown === null;
    if (!this.#isGoingBack) this.#followed = null;
    if (opened && !restored && !isFirst && !this.#isGoingBack) this.#leave();
    this.#remember();
    amendEntry({ name: this.#session.name });
    this.#showSoon(opened);
  }

  /** Begins another entry of the history; the present one will open what was open until now. */
  #leave() {
    const key = entryState().key ?? freshId();
    this.#left.delete(key);
    this.#left.set(key, this.#shown);
    if (this.#left.size > MAX_ENTRIES) this.#left.delete(this.#left.keys().next().value);
    amendEntry({ key });
    pushEntry({ key: freshId() }, location.hash);
  }

  /** Opens what was open at an entry of the history. */
  #goBack(key) {
    const found = this.#left.get(key);
    if (found === undefined) return; // it was open before a reload: its address leads to it
    const { opened, answer } = found;
    this.#isGoingBack = true;
    this.#followed = location.hash;
    this.#session.open({ ...opened, text: JSON.stringify(opened.request) }, answer);
    this.#isGoingBack = false;
    this.#session.announce(`${opened.name} is open again.`);
  }

  /** Opens the request that a fragment holds, or that is kept under its id; resolves to whether it is open. */
  #openOwn(fragment) {
    if (isLinkState(fragment)) return this.#opening.link(fragment, entryState().name);
    const id = fragment.slice(KEPT.length);
    this.#keptId = id;
    return this.#opening.kept(() => this.#kept.get(id));
  }

  #showSoon(opened) {
    clearTimeout(this.#timer);
    const { example } = this.#session;
    this.#isKept = example !== null;
    if (opened) {
      const mayBeLarge = this.#session.text.length > MAX_TO_COMPRESS || location.hash.startsWith(KEPT);
      this.#isLarge = example === null && mayBeLarge; // until it is known
    }
    if (example !== null) {
      put(`#${example}`);
      return;
    }
    if (!isOwn(location.hash)) put(""); // it is no longer the example
    this.#timer = setTimeout(() => this.#showRequest(), REST_MS);
  }

  async #showRequest() {
    const { name, request, text, turn } = this.#session;
    const fragment = text.length <= MAX_TO_COMPRESS ? await writeLinkState(request) : "";
    if (turn !== this.#session.turn) return;
    this.#isLarge = fragment === "" || fragment.length > LONGEST_LINK;
    const address = this.#isLarge ? await this.#keep({ name, text }) : fragment;
    if (turn !== this.#session.turn) return;
    this.#isKept = address !== "";
    put(address);
  }

  /** Keeps a request; resolves to the fragment that leads to it, "" if the browser does not keep it. */
  async #keep(named) {
    this.#keptId ??= freshId();
    try {
      await this.#kept.put(this.#keptId, named);
      return KEPT + this.#keptId;
    } catch {
      return ""; // such as in a private window; leaving asks
    }
  }
}

/** The moment at the end of a fragment, seconds, or null. */
function momentOf(fragment) {
  const text = fragment.slice(fragment.lastIndexOf(MOMENT) + 1);
  return fragment.includes(MOMENT) && /^\d+(\.\d+)?$/.test(text) ? Number(text) : null;
}

const withoutMoment = (fragment) => fragment.slice(0, fragment.lastIndexOf(MOMENT));

const put = (fragment) => amendEntry({}, fragment);

const unknownFragment = (fragment) => ({
  title: "Nothing is known by this address",
  detail: `“${shortened(decoded(fragment))}” is neither an example nor a request. Another request is open instead.`,
});

const shortened = (text) => (text.length > 40 ? `${text.slice(0, 38)}…` : text);

function decoded(fragment) {
  try {
    return decodeURIComponent(fragment);
  } catch {
    return fragment; // a stray per cent sign
  }
}

export const LONGEST_LINK = 8000; // characters of the fragment; longer addresses are often truncated

/** Whether the fragment of an address has the form of a request. */
export const isLinkState = (fragment) => fragment.startsWith(PREFIX);

/** Whether the fragment leads to a request that is not an example. */
const isOwn = (fragment) => isLinkState(fragment) || fragment.startsWith(KEPT);

/** The fragment that holds the request, of any length. */
export async function writeLinkState(request) {
  const deflated = await passedThrough(
    new CompressionStream("deflate"),
    new TextEncoder().encode(JSON.stringify(request)),
    Infinity,
  );
  return PREFIX + toBase64Url(deflated);
}

/** The request that a fragment holds. Rejects with FileError. */
export async function readLinkState(fragment) {
  const damaged = "The link is damaged or truncated. Ask for a new link, or for the request as a file.";
  const deflated = fromBase64Url(fragment.slice(PREFIX.length));
  if (deflated === null || deflated.length === 0) throw new FileError(damaged);
  let bytes;
  try {
    bytes = await passedThrough(new DecompressionStream("deflate"), deflated, LONGEST_TEXT);
  } catch (error) {
    throw error instanceof FileError ? error : new FileError(damaged);
  }
  try {
    return JSON.parse(new TextDecoder("utf-8", { fatal: true }).decode(bytes));
  } catch {
    throw new FileError(damaged);
  }
}

/** The output of a transform for the bytes. Rejects as soon as it exceeds `most` bytes. */
async function passedThrough(transform, bytes, most) {
  const writer = transform.writable.getWriter();
  const written = writer.write(bytes).then(() => writer.close());
  written.catch(() => {}); // reading fails as well, and rejects
  const chunks = [];
  let length = 0;
  const reader = transform.readable.getReader();
  for (;;) {
    const { done, value } = await reader.read();
    if (done) break;
    length += value.length;
    if (length > most) {
      await reader.cancel();
      throw new FileError(`The link holds more than ${most / 2 ** 20} MiB of text, too much for a request.`);
    }
    chunks.push(value);
  }
  return joined(chunks, length);
}

function joined(chunks, length) {
  const all = new Uint8Array(length);
  let at = 0;
  for (const chunk of chunks) {
    all.set(chunk, at);
    at += chunk.length;
  }
  return all;
}

function toBase64Url(bytes) {
  let text = "";
  for (const byte of bytes) text += String.fromCharCode(byte);
  return btoa(text).replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "");
}

/** The bytes, or null if the text is not base64url. */
function fromBase64Url(text) {
  if (!/^[\w-]*$/.test(text)) return null;
  try {
    return Uint8Array.from(atob(text.replaceAll("-", "+").replaceAll("_", "/")), (letter) =>
      letter.charCodeAt(0),
    );
  } catch {
    return null;
  }
}
