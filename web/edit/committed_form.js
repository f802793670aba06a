// The committed actions of the selected robot: what they are, how many of its plan they are, and their JSON.

import { committable, committedOf, readCommitted, setCommitted } from "../model/edit_committed.js";
import { actionInWords } from "../model/itinerary.js";
import { robotsOf } from "../model/listed.js";
import { isAction } from "../model/plan_file.js";
import { byId, element, setText } from "../ui/dom.js";
import { count } from "../ui/format.js";
import { NumberField } from "../ui/number_field.js";

const MAX = 100; // actions in the list

export class CommittedForm {
  #session;
  #choice;
  #text = byId("committed-json");
  #fault = byId("committed-fault");
  #first = new NumberField({
    label: "Commit the first",
    step: "1",
    late: true,
    accept: (number) => this.#commitFirst(number ?? 0),
  });
  #shown = /** @type {any} */ (null); // the committed actions in the list

  /** `choice`: see RobotChoice. */
  constructor(session, choice) {
    this.#session = session;
    this.#choice = choice;
    byId("committed-number").append(this.#first.element);
    byId("remove-committed").addEventListener("click", () => this.#remove());
    this.#text.addEventListener("change", () => this.#read());
    session.on("request answer marks", () => this.#refresh());
  }

  get #robot() {
    return robotsOf(this.#session.request)[this.#choice.index];
  }

  get #committable() {
    const { actions = [], former = [] } = this.#session.tracks.get(this.#robot?.id) ?? {};
    return committable(this.#robot, actions.length > 0 ? actions : former);
  }

  #commit(actions) {
    this.#session.edit(setCommitted(this.#session.request, this.#choice.index, actions));
  }

  /** Commits the first actions; returns why not, if so. */
  #commitFirst(number) {
    const actions = this.#committable;
    if (!Number.isInteger(number) || number < 0 || number > actions.length)
      return `Enter a whole number from 0 to ${actions.length}.`;
    this.#commit(actions.slice(0, number));
    return "";
  }

  #remove() {
    this.#commit([]);
    this.#session.announce(`${this.#robot?.id} has no committed actions.`);
    this.#first.input.focus(); // as the button is disabled now
  }

  #read() {
    this.#showFault("");
    try {
      this.#commit(readCommitted(this.#text.value));
    } catch (error) {
      this.#showFault(`Enter the actions as JSON: ${/** @type {Error} */ (error).message}.`);
    }
  }

  #showFault(text) {
    setText(this.#fault, text);
    this.#text.setCustomValidity(text);
  }

  #refresh() {
    const { index } = this.#choice;
    if (index === null) return;
    const committed = committedOf(this.#robot);
    const pointer = `/robots/${index}/committed`;
    setText(byId("committed-count"), committed.length > 0 ? String(committed.length) : "");
    this.#text.dataset.pointer = pointer;
    byId("remove-committed").disabled = this.#robot?.committed === undefined;
    this.#first.show(committed.length, { note: `of ${count(this.#committable.length, "action")}` });
    const shown = this.#robot?.committed;
    if (shown === this.#shown && this.#text.dataset.robot === String(index)) return;
    this.#shown = shown;
    this.#text.dataset.robot = String(index);
    this.#text.value = textOf(shown);
    this.#showFault("");
    this.#list(committed);
  }

  #list(committed) {
    const items = committed.slice(0, MAX).map((action) => element("li", { textContent: inWords(action) }));
    if (committed.length > MAX)
      items.push(element("li", { textContent: `and ${count(committed.length - MAX, "other")}` }));
    byId("committed-list").replaceChildren(...items);
  }
}

/** The JSON, with a line for each action. */
function textOf(committed) {
  if (!Array.isArray(committed)) return JSON.stringify(committed) ?? "";
  return `[${committed.map((action) => JSON.stringify(action)).join(",\n")}]`;
}

/** An action with its times. A faulty action is shown as it is. */
function inWords(action) {
  if (!isAction(action)) return JSON.stringify(action);
  return `${action.t_start.toFixed(2)} to ${action.t_end.toFixed(2)} s: ${actionInWords(action)}`;
}
