// The visits to the page in this browser. What was open at the end of the last visit is open again, unless an address
// says what to open.
//
// After a reload, the page opens what was open in this tab. Chromium gives the page the address at the begin of the
// reload. If the page has replaced the state of its entry in the history since then, Chromium loses this state.

import { amendEntry, entryState } from "./entry.js";

const KEY = "fleetplan-visit"; // of both storages: {fragment, plan, name}, see entry.js, and {unkept}, see Visits

export class Visits {
  /** Whether there was none before, as far as the browser knows, and no address says what to open. */
  isFirst = false;

  /**
   * What the last visit did not keep in time: {request: its text, plan: the texts {request, answer} of the plan}, or null in
   * place of what it kept.
   */
  unkept = /** @type {{request: any, plan: any}} */ ({ request: null, plan: null });

  /** Returns what is not kept yet, see `unkept`. */
  readUnkept = /** @type {() => {request: any, plan: any}} */ (() => ({ request: null, plan: null }));

  /**
   * Puts what was open into the address and into the browser's history, where Address and PlanKeeper find it; not for a page
   * that `isEmbedded`, which is not a visit.
   */
  constructor(isEmbedded = false) {
    if (isEmbedded) return;
    const here = isReload() ? read(() => sessionStorage) : null;
    forget(() => sessionStorage); // it is of the reload only
    if (here !== null) {
      this.#show(here);
    } else if (location.hash === "" && history.state === null) {
      const last = read(() => localStorage);
      this.isFirst = last === null;
      if (last?.fragment || last?.unkept.request) this.#show(last);
    }
    write(() => localStorage, this.unkept);
    addEventListener("pagehide", () => {
      const unkept = this.readUnkept();
      write(() => localStorage, unkept);
      write(() => sessionStorage, unkept);
    });
  }

  #show({ fragment, plan, name, unkept }) {
    amendEntry({ plan, name }, fragment);
    this.unkept = unkept;
  }
}

function isReload() {
  const [entry] = performance.getEntriesByType("navigation");
  return /** @type {PerformanceNavigationTiming | undefined} */ (entry)?.type === "reload";
}

// A storage throws, also when it is only named, where the browser keeps nothing, such as in a private window.

function read(storage) {
  try {
    const { fragment = "", plan, name, unkept } = JSON.parse(storage().getItem(KEY) ?? "null");
    return { fragment, plan, name, unkept: { request: null, plan: null, ...unkept } };
  } catch {
    return null; // there is none, or the browser keeps nothing
  }
}

function write(storage, unkept) {
  const { plan, name } = entryState();
  const visit = { fragment: location.hash, plan, name };
  // What is not kept may have no room.
  if (!put(storage, { ...visit, unkept })) put(storage, visit);
}

function put(storage, visit) {
  try {
    storage().setItem(KEY, JSON.stringify(visit));
    return true;
  } catch {
    return false; // where the browser keeps nothing, each visit is like the first one
  }
}

function forget(storage) {
  try {
    storage().removeItem(KEY);
  } catch {
    // It has kept nothing.
  }
}
