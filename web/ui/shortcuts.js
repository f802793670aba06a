// Single keys for the whole page; silent while someone types or a control wants the key itself.

/** `actions` maps KeyboardEvent.key, with "Control+" (which ⌘ also is) and "Shift+" where held, to a function. */
export function watchShortcuts(actions) {
  addEventListener("keydown", (event) => {
    if (event.defaultPrevented || event.altKey) return;
    const action = actions[nameOf(event)];
    if (!action || wantsKey(event.target, event.key)) return;
    event.preventDefault();
    action();
  });
}

/** Shift is named with Control only, as alone it makes another key. */
function nameOf({ key, ctrlKey, metaKey, shiftKey }) {
  if (!ctrlKey && !metaKey) return key;
  return `Control+${shiftKey ? "Shift+" : ""}${key.length === 1 ? key.toLowerCase() : key}`;
}

function wantsKey(target, key) {
  if (target.closest("dialog")) return true;
  if (key === "Escape") return false;
  if (target.matches("textarea, input:not([type=range], [type=checkbox], [type=radio])")) return true;
  if (target.matches("select")) return key === " " || key.length === 1;
  return key === " " && target.matches("button, summary, a, [type=checkbox], [type=radio]");
}
