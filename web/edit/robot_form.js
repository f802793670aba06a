// The forms of robots: the list to select one from, the form of the selected robot, the defaults of all
// robots.

import { degreesOf, radiansOf } from "../model/degrees.js";
import { nameOf, setDefault, setRobot } from "../model/edit_request.js";
import { alternativesOf, lastGoalOf, lastGoalPlace } from "../model/goals.js";
import { robotsOf } from "../model/listed.js";
import { robotIndexOf } from "../model/problem.js";
import { chosenIn } from "../ui/choices.js";
import { byId, element, setText } from "../ui/dom.js";
import { NumberField } from "../ui/number_field.js";

export const ROBOT_NUMBERS = [
  { name: "radius", label: "Radius", unit: "m" },
  { name: "linear_speed", label: "Speed", unit: "m/s" },
  { name: "angular_speed", label: "Turning", unit: "rad/s" },
];
const OWN_NUMBERS = [
  { name: "vicinity", label: "Vicinity", unit: "m", usual: 0 },
  { name: "weight", label: "Weight", unit: "", usual: 1 },
];
const POSES = ["start", "goal"];
const HOW_TO_CHOOSE = "Select a robot here or in the scene.";
const HOW_TO_ADD = "A request needs at least one robot: add one with the robot tool.";

export class RobotForm {
  #session;
  #choice;
  #actions;
  #form = byId("robot-form");
  #id = byId("robot-id");
  #idle = byId("robot-idle");
  #hasGoal = byId("robot-has-goal");
  #numbers = new Map(); // name -> NumberField
  #poses = new Map(); // "start" or "goal" -> {x, y, theta}, each a NumberField

  /** `choice`: see RobotChoice; `actions`: see RobotActions. */
  constructor(session, choice, actions) {
    this.#session = session;
    this.#choice = choice;
    this.#actions = actions;
    this.#build();
    this.#id.addEventListener("input", () => this.#set("id", this.#id.value));
    this.#id.addEventListener("change", () => session.endGesture());
    this.#idle.addEventListener("change", () => {
      this.#set("idle", this.#idle.value || undefined);
      session.endGesture();
    });
    this.#hasGoal.addEventListener("change", () => {
      if (this.#hasGoal.checked) actions.addGoal();
      else actions.removeGoal();
    });
    byId("duplicate-robot").addEventListener("click", () => actions.duplicate());
    byId("delete-robot").addEventListener("click", () => {
      actions.delete();
      byId("edited-robot").focus();
    });
    session.on("request marks", () => this.#refresh());
    this.#refresh();
  }

  #build() {
    const settle = () => this.#session.endGesture();
    for (const { name, label, unit } of [...ROBOT_NUMBERS, ...OWN_NUMBERS]) {
      const accept = (value) => this.#set(name, value);
      this.#numbers.set(name, new NumberField({ label, unit, accept, settle }));
    }
    byId("robot-numbers").append(...[...this.#numbers.values()].map(({ element }) => element));
    for (const pose of POSES) {
      const field = (name, described) =>
        new NumberField({ ...described, accept: (value) => this.#setPose(pose, name, value), settle });
      const fields = {
        x: field("x", { label: "x", unit: "m", required: true }),
        y: field("y", { label: "y", unit: "m", required: true }),
        theta: field("theta", { label: "Heading", unit: "°" }),
      };
      this.#poses.set(pose, fields);
      byId(`robot-${pose}-numbers`).append(...Object.values(fields).map(({ element }) => element));
    }
  }

  #set(name, value) {
    const { index } = this.#choice;
    this.#session.edit(setRobot(this.#session.request, index, name, value), `robot ${index} ${name}`);
  }

  /** Sets x or y, metres, or theta, degrees. */
  #setPose(pose, name, value) {
    const inUnits = name === "theta" ? radiansOf(value) : value;
    this.#actions.setPose(pose, { [name]: inUnits }, `robot ${this.#choice.index} ${pose} ${name}`);
  }

  #refresh() {
    const { index } = this.#choice;
    this.#form.hidden = index === null || this.#session.chosen.length > 1; // see GroupForm
    byId("no-robot").hidden = index !== null;
    if (index === null) return;
    const robot = robotsOf(this.#session.request)[index] ?? {};
    const pointer = `/robots/${index}`;
    this.#form.dataset.pointer = pointer;
    this.#id.dataset.pointer = `${pointer}/id`;
    const id = typeof robot.id === "string" ? robot.id : "";
    if (this.#id.value !== id) this.#id.value = id;
    const defaults = this.#session.request?.robot_defaults;
    for (const [name, field] of this.#numbers) {
      field.input.dataset.pointer = `${pointer}/${name}`;
      field.show(robot[name], { placeholder: String(defaults?.[name] ?? usualOf(name)) });
    }
    this.#idle.dataset.pointer = `${pointer}/idle`;
    this.#idle.value = typeof robot.idle === "string" ? robot.idle : "";
    const goal = lastGoalOf(robot);
    this.#refreshPose("start", robot.start, `${pointer}/start`);
    this.#refreshPose("goal", goal, `${pointer}/${lastGoalPlace(robot)}`);
    this.#hasGoal.checked = goal !== undefined;
    byId("robot-goal-numbers").hidden = goal === undefined || alternativesOf(goal).length > 0;
  }

  #refreshPose(pose, place, pointer) {
    const fields = this.#poses.get(pose);
    byId(`robot-${pose}`).dataset.pointer = pointer;
    for (const [name, field] of Object.entries(fields)) field.input.dataset.pointer = `${pointer}/${name}`;
    fields.x.show(place?.x);
    fields.y.show(place?.y);
    const theta = place?.theta;
    const known = typeof theta === "number";
    const otherwise = pose === "goal" ? "any" : "0";
    const note = known ? `= ${Number(theta.toFixed(4))} rad` : "";
    fields.theta.show(degreesOf(theta), { placeholder: otherwise, note });
  }
}

const usualOf = (name) => OWN_NUMBERS.find((each) => each.name === name)?.usual ?? "";

export function watchRobotPicker(session, choice) {
  const list = byId("edited-robot");
  list.addEventListener("change", () => choice.choose(chosenIn(list)));
  let listed = [];
  session.on("request problem", () => {
    const names = namesOf(session);
    if (names.join("\n") !== listed.join("\n")) {
      listed = names;
      list.replaceChildren(
        ...names.map((name, at) => element("option", { value: at - 1, textContent: name })),
      );
      list.options[0].value = "";
    }
    list.value = choice.index ?? "";
    list.disabled = names.length === 1;
    setText(byId("no-robot"), list.disabled ? HOW_TO_ADD : HOW_TO_CHOOSE);
  });
  session.on("marks", () => (list.value = choice.index ?? ""));
}

/** The names in the list: for no robot, then for each robot. */
function namesOf({ request, problem }) {
  const faulty = new Set((problem?.errors ?? []).map(({ pointer = "" }) => robotIndexOf(pointer)));
  const sign = (index) => (faulty.has(index) ? "⚠ " : "");
  const names = robotsOf(request).map((_, index) => sign(index) + nameOf(request, index));
  return [names.length > 0 ? "None selected" : "No robots yet", ...names];
}

export function watchDefaultsForm(session) {
  /** @type {[string, NumberField][]} */
  const fields = ROBOT_NUMBERS.map(({ name, label, unit }) => {
    const accept = (value) => session.edit(setDefault(session.request, name, value), `default ${name}`);
    const field = new NumberField({ label, unit, accept, settle: () => session.endGesture() });
    field.input.dataset.pointer = `/robot_defaults/${name}`;
    return [name, field];
  });
  byId("default-numbers").append(...fields.map(([, { element }]) => element));
  session.on("request", () => {
    for (const [name, field] of fields) {
      field.show(session.request?.robot_defaults?.[name], { placeholder: "none" });
    }
  });
}
