// The buttons that take request and answer away.

import { byId, setText } from "../ui/dom.js";
import { copyText, curlCommand, fileStem, saveText } from "./exports.js";

const TOLD_MS = 1500;

export function watchSaving(session) {
  const [request, answer, curl] = ["save-request", "save-answer", "copy-curl"].map(byId);
  session.on("answer", () => {
    request.disabled = curl.disabled = session.text === "";
    answer.disabled = session.answer === null;
  });
  request.addEventListener("click", () => saveText(`${fileStem(session.name)}.json`, session.text));
  answer.addEventListener("click", () => {
    saveText(`${fileStem(session.name)}.plan.json`, session.answerText);
  });
  curl.addEventListener("click", async () => {
    const copied = await copyText(curlCommand(session, document.baseURI));
    setText(curl, copied ? "Copied" : "Could not copy");
    session.say(curl.textContent);
    setTimeout(() => setText(curl, "Copy as curl"), TOLD_MS);
  });
}
