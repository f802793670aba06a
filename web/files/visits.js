// The visits to the page in this browser. What was open at the end of the last visit is open again, unless an address
// says what to open.
//
// After a reload, the page opens what was open in this tab. Chromium gives the page the address at the begin of the
// reload. If the page has replaced the state of its entry in the history since then, Chromium loses this state.

const KEY = "fleetplan-visit"; // of both storages: {fragment, plan}, see Address and PlanKeeper

export class Visits {
  /** Whether there was none before, as far as the browser knows, and no address says what to open. */
  isFirst = false;

  /** Puts what was open into the address and into the browser's history, where Address and PlanKeeper find it. */
  constructor() {
    const here = isReload() ? read(() => sessionStorage) : null;
    forget(() => sessionStorage); // it is of the reload only
    if (here !== null) {
      show(here);
    } else if (location.hash === "" && history.state === null) {
      const last = read(() => localStorage);
      this.isFirst = last === null;
      if (last?.fragment) show(last);
    }
    write(() => localStorage);
    addEventListener("pagehide", () => {
      write(() => localStorage);
      write(() => sessionStorage);
    });
  }
}

function isReload() {
  const [entry] = performance.getEntriesByType("navigation");
  return /** @type {PerformanceNavigationTiming | undefined} */ (entry)?.type === "reload";
}

function show({ fragment, plan }) {
  history.replaceState(plan && { plan }, "", `${location.pathname}${location.search}${fragment}`);
}

// A storage throws, also when it is only named, where the browser keeps nothing, such as in a private window.

function read(storage) {
  try {
    const { fragment, plan } = JSON.parse(storage().getItem(KEY) ?? "null");
    return { fragment: fragment ?? "", plan: plan ?? null };
  } catch {
    return null; // there is none, or the browser keeps nothing
  }
}

function write(storage) {
  try {
    const visit = { fragment: location.hash, plan: history.state?.plan ?? null };
    storage().setItem(KEY, JSON.stringify(visit));
  } catch {
    // The browser keeps nothing: each visit is like the first one.
  }
}

function forget(storage) {
  try {
    storage().removeItem(KEY);
  } catch {
    // It has kept nothing.
  }
}
