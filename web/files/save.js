// The Save menu: files, a command line, a program, a link.

import { planFile } from "../model/plan_file.js";
import { byId, makeClosable, setText } from "../ui/dom.js";
import { count, grouped } from "../ui/format.js";
import { LONGEST_LINK } from "./address.js";
import { saveText } from "./downloads.js";

const SHOWN_MS = 1500;

/** `address`: see Address; `needsToken()` resolves to whether the service asks for a token. */
export function watchSaving(session, address, needsToken) {
  const [request, plan, link] = ["save-request", "save-plan", "copy-link"].map(byId);
  const moment = byId("copy-moment");
  const curl = ["copy-curl", "welcome-curl"].map(byId);
  const python = ["copy-python", "welcome-python"].map(byId);
  const note = byId("save-note");
  const stem = () => fileStem(session.name);
  const menu = byId("save-menu");
  /** @type {Promise<boolean> | null} */
  let token = null; // whether the service asks for one
  makeClosable(menu);
  const learn = () => {
    token ??= needsToken().catch(() => {
      token = null; // the next one asks again
      return false;
    });
    return token;
  };
  menu.addEventListener("toggle", () => menu.open && learn());
  byId("welcome").addEventListener("pointerenter", learn);
  byId("welcome").addEventListener("focusin", learn);
  session.on("answer", () => {
    for (const button of [request, ...curl, ...python, link]) button.disabled = session.request === null;
    moment.disabled = !session.hasPlan;
    plan.disabled = session.answer === null || session.outdated !== null;
    note.hidden = true;
  });
  request.addEventListener("click", () => saveText(`${stem()}.json`, session.text));
  plan.addEventListener("click", () => {
    saveText(`${stem()}.plan.json`, JSON.stringify(planFile(session.request, session.answer)));
  });
  const copies = (buttons, write) => {
    for (const button of buttons) {
      button.addEventListener("click", async () =>
        copyFrom(button, write(session, document.baseURI, await learn()), session),
      );
    }
  };
  copies(curl, curlCommand);
  copies(python, pythonProgram);
  const copyLink = async (button, at) => {
    const { address: made, length } = await address.link(at);
    note.hidden = length <= LONGEST_LINK;
    setText(note, tooLong(length, session.scene));
    if (note.hidden) copyFrom(button, made, session);
  };
  link.addEventListener("click", () => copyLink(link, null));
  moment.addEventListener("click", () => copyLink(moment, session.player.time));
}

function tooLong(length, { grid, robots }) {
  const cells = count((grid?.columns ?? 0) * (grid?.rows ?? 0), "cell");
  return (
    `This request is too large for a link: with ${cells} and ${count(robots.length, "robot")} it would have ` +
    `${count(length, "character")}, and links of more than ${grouped(LONGEST_LINK)} are often truncated. ` +
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
 * The command that plans the request from a POSIX shell. Examples are fetched, other requests inlined. `token`: whether
 * the service asks for a token, which the command takes from the variable TOKEN.
 */
export function curlCommand({ example, text }, base, token) {
  const curl = token ? `curl -sS -H "Authorization: Bearer $TOKEN"` : "curl -sS";
  const post = `${curl} ${new URL("v1/plan", base)} -H 'Content-Type: application/json' --data-binary @-`;
  if (example !== null)
    return `${curl} ${new URL(`v1/examples/${encodeURIComponent(example)}`, base)} | ${post}`;
  return `${post} <<'JSON'\n${text}\nJSON\n`;
}

/**
 * The program that plans the request with the client for Python, like curlCommand. The text of a request is a raw string
 * where that can hold it, so that it can be read.
 */
export function pythonProgram({ example, text }, base, token) {
  const readable = !text.includes("'''") && !text.endsWith("'") && !text.endsWith("\\");
  const literal = readable ? `r'''${text}'''` : JSON.stringify(text);
  const url = JSON.stringify(new URL(".", base).href.replace(/\/$/, ""));
  const lines = [
    ...(example === null ? ["import json"] : []),
    ...(token ? ["import os"] : []),
    "from fleetplan import Client  # pip install ./clients/python",
    "",
    `client = Client(${url}${token ? ', token=os.environ["TOKEN"]' : ""})`,
    example === null
      ? `request = json.loads(${literal})`
      : `request = client.example(${JSON.stringify(example)})`,
    "answer = client.plan(request)",
    'for plan in answer["plans"]:',
    '    print(plan["robot"], plan["cost"], plan["actions"])',
  ];
  return `${lines.join("\n")}\n`;
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
