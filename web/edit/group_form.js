// The form of several chosen robots: what is set here is set for all of them.

import { deleteRobots, differ, moveRobots, setRobots, sharedValue } from "../model/edit_group.js";
import { byId, setText } from "../ui/dom.js";
import { count } from "../ui/format.js";
import { NumberField } from "../ui/number_field.js";
import { ROBOT_NUMBERS } from "./robot_form.js";

export class GroupForm {
  #session;
  #form = byId("group-form");
  #numbers = new Map(); // name -> NumberField
  #by = { x: 0, y: 0 }; // metres

  constructor(session) {
    this.#session = session;
    for (const { name, label, unit } of ROBOT_NUMBERS) {
      const accept = (value) => this.#set(name, value);
      const field = new NumberField({ label, unit, accept, settle: () => session.endGesture() });
      this.#numbers.set(name, field);
      byId("group-numbers").append(field.element);
    }
    for (const axis of ["x", "y"]) {
      const accept = (value) => void (this.#by[axis] = value);
      const field = new NumberField({ label: `By ${axis}`, unit: "m", required: true, accept });
      field.show(0);
      byId("group-way").append(field.element);
    }
    byId("move-starts").addEventListener("click", () => this.#move("start"));
    byId("move-goals").addEventListener("click", () => this.#move("goal"));
    byId("delete-group").addEventListener("click", () => this.#delete());
    session.on("request marks", () => this.#refresh());
  }

  get #indices() {
    return this.#session.chosen.map((id) => this.#session.robot(id).index);
  }

  #set(name, value) {
    const { request } = this.#session;
    this.#session.edit(setRobots(request, this.#indices, name, value), `group ${name}`);
  }

  #move(pose) {
    this.#session.edit(moveRobots(this.#session.request, this.#indices, pose, this.#by));
    this.#session.announce(`${count(this.#indices.length, `${pose}`)} moved.`);
  }

  #delete() {
    const indices = this.#indices;
    this.#session.edit(deleteRobots(this.#session.request, indices));
    this.#session.announce(`${count(indices.length, "robot")} deleted.`);
    byId("edited-robot").focus();
  }

  #refresh() {
    const indices = this.#indices;
    this.#form.hidden = indices.length < 2;
    if (this.#form.hidden) return;
    setText(byId("group-title"), `${count(indices.length, "robot")} selected`);
    const { request } = this.#session;
    for (const [name, field] of this.#numbers) {
      const placeholder = differ(request, indices, name)
        ? "various"
        : String(request?.robot_defaults?.[name] ?? "");
      field.show(sharedValue(request, indices, name), { placeholder });
    }
  }
}
