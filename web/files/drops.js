// Files dropped anywhere on the page.

import { byId } from "../ui/dom.js";

/** Calls open([File, …]) with the files of each drop. */
export function watchDrops(open) {
  const hint = byId("drop-hint");
  const carriesFiles = (event) => event.dataTransfer?.types.includes("Files");
  addEventListener("dragover", (event) => {
    if (!carriesFiles(event)) return;
    event.preventDefault();
    hint.hidden = false;
  });
  addEventListener("dragleave", (event) => {
    if (event.relatedTarget === null) hint.hidden = true;
  });
  addEventListener("drop", (event) => {
    if (!carriesFiles(event)) return;
    event.preventDefault();
    hint.hidden = true;
    const files = [...event.dataTransfer.files];
    if (files.length > 0) open(files);
  });
}
