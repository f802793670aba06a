// The page's entry in the browser's history: the fragment of its address says which request is open, and its state has
// what the fragment does not say: {plan: the id of the plan that is kept, name: of the request, key: of this entry}.

/** The state of the present entry; empty if it has none. */
export const entryState = () => history.state ?? {};

/** Changes members of the state, and the fragment if there is one. */
export function amendEntry(changes, fragment = location.hash) {
  history.replaceState({ ...entryState(), ...changes }, "", addressOf(fragment));
}

/** Begins another entry, so that the browser's button Back leads to the present one. */
export function pushEntry(state, fragment) {
  history.pushState(state, "", addressOf(fragment));
}

const addressOf = (fragment) => `${location.pathname}${location.search}${fragment}`;
