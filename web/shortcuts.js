// Single keys for the whole page; silent while someone types or a control wants the key itself.

/** `actions` maps KeyboardEvent.key to a function. */
export function watchShortcuts(actions) {
  addEventListener("keydown", (event) => {
    if (event.defaultPrevented || event.ctrlKey || event.metaKey || event.altKey) return;
    const action = actions[event.key];
    if (!action || wantsKey(event.target, event.key)) return;
    event.preventDefault();
    action();
  });
}

function wantsKey(target, key) {
  if (key === "Escape") return false;
  if (target.matches("textarea, input:not([type=range])")) return true;
  if (target.matches("select")) return key === " " || key.length === 1;
  return key === " " && target.matches("button, summary, a");
}
