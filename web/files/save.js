// The Save menu: files, a command line, a link.

import { planFile } from "../model/plan_file.js";
import { byId, makeClosable, setText } from "../ui/dom.js";
import { count } from "../ui/format.js";
import { LONGEST_LINK } from "./address.js";
import { saveText } from "./downloads.js";

const SHOWN_MS = 1500;

/** `address`: see Address; `needsToken()` resolves to whether the service asks for a token. */
export function watchSaving(session, address, needsToken) {
  const [request, plan, curl, link] = ["save-request", "save-plan", "copy-curl", "copy-link"].map(byId);
  const note = byId("save-note");
  const stem = () => fileStem(session.name);
  const menu = byId("save-menu");
  let token = false;
  makeClosable(menu);
  menu.addEventListener("toggle", async () => {
    if (menu.open) token = await needsToken().catch(() => token); // known before anything is copied
  });
  session.on("answer", () => {
    for (const button of [request, curl, link]) button.disabled = session.request === null;
    plan.disabled = session.answer === null || session.outdated !== null;
    note.hidden = true;
  });
  request.addEventListener("click", () => saveText(`${stem()}.json`, session.text));
  plan.addEventListener("click", () => {
    saveText(`${stem()}.plan.json`, JSON.stringify(planFile(session.request, session.answer)));
  });
  curl.addEventListener("click", () =>
    copyFrom(curl, curlCommand(session, document.baseURI, token), session),
  );
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
    `${count(length, "character")}, and links of more than ${LONGEST_LINK.toLocaleString("en")} are often truncated. ` +
    "Save the request and send the file."
  );
}

/** Copies a text and confirms it on the button. */
async function copyFrom(button, text, session) {
  const label = button.dataset.label ?? button.textContent;
  button.dataset.label = label;
  setText(button, (await copyText(text)) ? "Copied" : "Could not copy");
  session.announce(button.textContent);
  setTimeout(() => setText(button, label), SHOWN_MS);
}

/** A file name, without extension, for a request's name. */
export function fileStem(name) {
  return name.replace(/(\.plan)?\.(json|map|scen|ya?ml)$/i, "").replace(/[^\w.-]+/g, "-") || "request";
}

/**
 * The command that plans the request from a POSIX shell; examples are fetched, other requests inlined. `token`: whether
 * the service asks for one, which the command takes from the variable TOKEN.
 */
export function curlCommand({ example, text }, base, token) {
  const curl = token ? `curl -sS -H "Authorization: Bearer $TOKEN"` : "curl -sS";
  const post = `${curl} ${new URL("v1/plan", base)} -H 'Content-Type: application/json' --data-binary @-`;
  if (example !== null)
    return `${curl} ${new URL(`v1/examples/${encodeURIComponent(example)}`, base)} | ${post}`;
  return `${post} <<'JSON'\n${text}\nJSON\n`;
}

/** Copies a text to the clipboard; returns whether that succeeded. */
export async function copyText(text) {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    return copyThroughSelection(text); // no clipboard API without a secure context
  }
}

function copyThroughSelection(text) {
  const before = /** @type {HTMLElement | null} */ (document.activeElement);
  const area = document.createElement("textarea");
  area.className = "visually-hidden";
  area.value = text;
  document.body.append(area);
  area.select();
  const copied = document.execCommand("copy");
  area.remove();
  before?.focus();
  return copied;
}
