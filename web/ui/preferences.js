// How somebody likes the page, kept in this browser: the fold and height of the timeline, the speed, the View menu.

const KEY = "fleetplan-preferences"; // of the local storage: an object

export class Preferences {
  #values = read();

  /** What was set under a name, or else the value `otherwise`. */
  get(name, otherwise) {
    return this.#values[name] ?? otherwise;
  }

  set(name, value) {
    this.#values[name] = value;
    try {
      localStorage.setItem(KEY, JSON.stringify(this.#values));
    } catch {
      // The browser keeps nothing, such as in a private window: it lasts as long as the page.
    }
  }
}

/**
 * Of a page that keeps nothing.
 * @type {{get: (name: string, otherwise: any) => any, set: (name: string, value: any) => void}}
 */
export const NO_PREFERENCES = { get: (_, otherwise) => otherwise, set: () => {} };

function read() {
  try {
    const kept = JSON.parse(localStorage.getItem(KEY) ?? "{}");
    return kept !== null && typeof kept === "object" ? kept : {};
  } catch {
    return {};
  }
}
