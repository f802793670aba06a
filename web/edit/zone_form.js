// The form of the zones: the list to choose one from, its rule and its numbers.

import { tidy } from "../model/cells.js";
import { degreesOf, radiansOf } from "../model/degrees.js";
import { cornersOf, deleteZone, setZone, setZoneType, ZONE_RULES } from "../model/edit_zones.js";
import { zonesOf } from "../model/listed.js";
import { chosenIn, showChoices } from "../ui/choices.js";
import { byId, element, setText } from "../ui/dom.js";
import { count } from "../ui/format.js";
import { NumberField } from "../ui/number_field.js";

const TYPES = { blocked: "Blocked", speed: "Slow", one_way: "One-way" };
const NUMBERS = {
  linear_speed: { label: "Speed", unit: "m/s", of: "speed" },
  angular_speed: { label: "Turning", unit: "rad/s", of: "speed" },
  heading: { label: "Heading", unit: "°", of: "one_way" },
  half_angle: { label: "Half angle", unit: "°", of: "one_way" },
};

export class ZoneForm {
  #session;
  #choice;
  #list = byId("edited-zone");
  #form = byId("zone-form");
  #id = byId("zone-id");
  #type = byId("zone-type");
  #robots = byId("zone-robots");
  #numbers = new Map(); // name -> NumberField

  /** `choice`: see ZoneChoice. */
  constructor(session, choice) {
    this.#session = session;
    this.#choice = choice;
    this.#type.append(
      ...Object.entries(TYPES).map(([value, textContent]) => element("option", { value, textContent })),
    );
    for (const [name, { label, unit }] of Object.entries(NUMBERS)) {
      const accept = (value) => this.#set({ [name]: unit === "°" ? radiansOf(value) : roundOf(value) }, name);
      const field = new NumberField({ label, unit, accept, settle: () => session.endGesture() });
      this.#numbers.set(name, field);
      byId("zone-numbers").append(field.element);
    }
    this.#list.addEventListener("change", () => choice.choose(chosenIn(this.#list)));
    this.#id.addEventListener("input", () => this.#set({ id: this.#id.value }, "id"));
    this.#robots.addEventListener("change", () => this.#set({ robots: idsIn(this.#robots.value) }, "robots"));
    this.#type.addEventListener("change", () =>
      session.edit(setZoneType(session.request, choice.index, this.#type.value)),
    );
    byId("delete-zone").addEventListener("click", () => {
      session.edit(deleteZone(session.request, choice.index));
      choice.choose(null);
      this.#list.focus();
    });
    session.on("request", () => this.#refresh());
    choice.onChange(() => this.#refresh());
    this.#refresh();
  }

  #set(members, name) {
    const { index } = this.#choice;
    this.#session.edit(setZone(this.#session.request, index, members), `zone ${index} ${name}`);
  }

  #refresh() {
    const { zone, index } = this.#choice;
    this.#showList();
    this.#form.hidden = zone === null;
    if (zone === null) return;
    const pointer = `/zones/${index}`;
    this.#form.dataset.pointer = pointer;
    this.#id.dataset.pointer = `${pointer}/id`;
    if (this.#id.value !== zone.id) this.#id.value = zone.id ?? "";
    this.#type.value = zone.type;
    if (document.activeElement !== this.#robots) this.#robots.value = (zone.robots ?? []).join(", ");
    const shape = zone.mask === undefined ? count(cornersOf(zone).length, "corner") : "An image";
    setText(byId("zone-rule"), `${ZONE_RULES[zone.type] ?? ""} ${shape}.`);
    for (const [name, field] of this.#numbers) {
      const { of, unit } = NUMBERS[name];
      field.element.hidden = zone.type !== of || zone.mask !== undefined;
      field.input.dataset.pointer = `${pointer}/${name}`;
      const value = zone[name];
      field.show(unit === "°" ? degreesOf(value) : value);
    }
  }

  #showList() {
    const names = zonesOf(this.#session.request).map((zone, at) => zone?.id || `#${at}`);
    const none = names.length > 0 ? "None selected" : "No zones yet";
    showChoices(this.#list, names, none, this.#choice.index);
  }
}

const roundOf = (value) => (value === undefined ? value : tidy(value));

/** The ids in a text, separated by commas; undefined for none, which means all robots. */
function idsIn(text) {
  const ids = text
    .split(",")
    .map((id) => id.trim())
    .filter((id) => id !== "");
  return ids.length > 0 ? ids : undefined;
}
