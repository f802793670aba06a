// The visits to the page in this browser. What was open at the end of the last one is open again, unless an address says
// what to open.

const KEY = "fleetplan-visit"; // of localStorage: {fragment, plan}, see Address and PlanKeeper

export class Visits {
  /** Whether there was none before, as far as the browser knows, and no address says what to open. */
  isFirst = false;

  /** Puts what was open into the address and into the browser's history, where Address and PlanKeeper find it. */
  constructor() {
    if (location.hash === "" && history.state === null) {
      const last = read();
      this.isFirst = last === null;
      if (last?.fragment) history.replaceState(last.plan && { plan: last.plan }, "", last.fragment);
    }
    write();
    addEventListener("pagehide", write);
  }
}

function read() {
  try {
    const { fragment, plan } = JSON.parse(localStorage.getItem(KEY) ?? "null");
    return { fragment: fragment ?? "", plan: plan ?? null };
  } catch {
    return null; // there is none, or the browser keeps nothing, such as in a private window
  }
}

function write() {
  try {
    localStorage.setItem(KEY, JSON.stringify({ fragment: location.hash, plan: history.state?.plan ?? null }));
  } catch {
    // The browser keeps nothing: each visit is like the first one.
  }
}
