// Keyboard shortcuts for the whole page, and the wheel.

const LINE = 16; // pixels
const MAX = 240; // pixels per wheel event that count for zooming

/**
 * `actions` maps KeyboardEvent.key, with "Control+" (which ⌘ also is) and "Shift+" where held, to a function.
 */
export function watchShortcuts(actions) {
  addEventListener("keydown", (event) => {
    if (event.defaultPrevented || event.altKey) return;
    const action = actions[nameOf(event)];
    if (!action || wantsKey(event)) return;
    event.preventDefault();
    action();
  });
}

/** Shift is named only with Control; alone it changes the key itself. */
function nameOf({ key, ctrlKey, metaKey, shiftKey }) {
  if (!ctrlKey && !metaKey) return key;
  return `Control+${shiftKey ? "Shift+" : ""}${key.length === 1 ? key.toLowerCase() : key}`;
}

function wantsKey({ target, key, ctrlKey, metaKey }) {
  if (target.closest("dialog")) return true;
  if (key === "Escape") return false;
  if (target.matches("textarea, input:not([type=range], [type=checkbox], [type=radio])")) return true;
  if (target.matches("select")) return key === " " || (key.length === 1 && !ctrlKey && !metaKey);
  return key === " " && target.matches("button, summary, a, [type=checkbox], [type=radio]");
}

/** How far an event of the wheel scrolls: {across, down}. */
export function wheelTravel({ deltaX, deltaY, deltaMode }) {
  const unit = deltaMode === WheelEvent.DOM_DELTA_LINE ? LINE : 1;
  return { across: deltaX * unit, down: deltaY * unit };
}

/** The factor that an event of the wheel zooms by, above 1 to show less. `gain`: its logarithm per pixel. */
export function wheelFactor(event, gain) {
  const { down } = wheelTravel(event);
  return Math.exp(-Math.max(-MAX, Math.min(MAX, down)) * gain);
}
