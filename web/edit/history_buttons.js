// Undo and redo as buttons.

import { byId } from "../ui/dom.js";

export function watchHistoryButtons(session) {
  const undo = byId("undo");
  const redo = byId("redo");
  undo.addEventListener("click", () => session.undo());
  redo.addEventListener("click", () => session.redo());
  session.on("request", () => {
    const focused = document.activeElement;
    undo.disabled = !session.canUndo;
    redo.disabled = !session.canRedo;
    if (focused === undo && undo.disabled) redo.focus(); // the focus would be lost
    if (focused === redo && redo.disabled) undo.focus();
  });
}
