// The menu that takes away what is shown: as files, as a command line, as a link.

import { byId, setText } from "../ui/dom.js";
import { count } from "../ui/format.js";
import { makeClosable } from "../ui/menu.js";
import { copyText, curlCommand, fileStem, saveBlob, saveText } from "./exports.js";
import { LONGEST_LINK } from "./link_state.js";
import { planFile } from "./plan_file.js";

const TOLD_MS = 1500;

/** `stage`: see Stage; `address`: see Address. */
export function watchSaving(session, stage, address) {
  const [request, plan, picture, curl, link] = [
    "save-request",
    "save-plan",
    "save-picture",
    "copy-curl",
    "copy-link",
  ].map(byId);
  const note = byId("save-note");
  const stem = () => fileStem(session.name);
  makeClosable(byId("save-menu"));
  session.on("answer", () => {
    for (const button of [request, picture, curl, link]) button.disabled = session.request === null;
    plan.disabled = session.answer === null;
    note.hidden = true;
  });
  request.addEventListener("click", () => saveText(`${stem()}.json`, session.text));
  plan.addEventListener("click", () => {
    saveText(`${stem()}.plan.json`, JSON.stringify(planFile(session.request, session.answer)));
  });
  picture.addEventListener("click", () => {
    stage.paint(); // whatever is due with the next frame
    stage.canvas.toBlob((blob) => saveBlob(`${stem()}.png`, blob), "image/png");
  });
  curl.addEventListener("click", () => copyFrom(curl, curlCommand(session, document.baseURI), session));
  link.addEventListener("click", async () => {
    const { address: made, length } = await address.link();
    note.hidden = length <= LONGEST_LINK;
    setText(note, tooLong(length, session.scene));
    if (note.hidden) copyFrom(link, made, session);
  });
}

function tooLong(length, { grid, robots }) {
  const cells = count((grid?.columns ?? 0) * (grid?.rows ?? 0), "cell");
  return (
    `This request is too large for a link: with ${cells} and ${count(robots.length, "robot")} it would have ` +
    `${count(length, "character")}, and more than ${LONGEST_LINK.toLocaleString("en")} get lost on the way. ` +
    "Save the request and send the file."
  );
}

/** Copies a text and says so on the button that was pressed. */
async function copyFrom(button, text, session) {
  const label = button.dataset.label ?? button.textContent;
  button.dataset.label = label;
  setText(button, (await copyText(text)) ? "Copied" : "Could not copy");
  session.say(button.textContent);
  setTimeout(() => setText(button, label), TOLD_MS);
}
