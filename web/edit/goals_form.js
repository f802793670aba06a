// The goals of the selected robot in the order of its visits: where, for how long, and not before when. A goal may be
// served at one of several poses.

import { tidy } from "../model/cells.js";
import { degreesOf, radiansOf } from "../model/degrees.js";
import {
  advanceGoal,
  appendAlternative,
  appendGoal,
  removeAlternative,
  removeGoalAt,
  setAlternative,
  setGoal,
} from "../model/edit_goals.js";
import { alternativesOf, goalsOf } from "../model/goals.js";
import { robotsOf } from "../model/listed.js";
import { byId, element, setCount } from "../ui/dom.js";
import { NumberField } from "../ui/number_field.js";

const POSE = {
  x: { label: "x", unit: "m", required: true },
  y: { label: "y", unit: "m", required: true },
  theta: { label: "Heading", unit: "°" },
};
const ALTERNATIVE = { ...POSE, bias: { label: "Bias", unit: "s" } };
const FIELDS = {
  ...POSE,
  service: { label: "Service time", unit: "s" },
  not_before: { label: "Not before", unit: "s" },
  due: { label: "Due", unit: "s" },
  radius_after: { label: "Radius after", unit: "m" },
  linear_speed_after: { label: "Speed after", unit: "m/s" },
  linear_acceleration_after: { label: "Acceleration after", unit: "m/s²" },
  linear_deceleration_after: { label: "Deceleration after", unit: "m/s²" },
};
const ASIDE = 3; // radii between the last pose and a new one
const MAX_POSES = 100; // of a goal

export class GoalsForm {
  #session;
  #choice;
  #list = byId("goals-list");
  #rows = /** @type {any[]} */ ([]); // {element, fields, poses: {list, rows: {element, fields}[]}, more}

  /** `choice`: see RobotChoice. */
  constructor(session, choice) {
    this.#session = session;
    this.#choice = choice;
    byId("append-goal").addEventListener("click", () => this.#append());
    session.on("request marks", () => this.#refresh());
  }

  get #goals() {
    return goalsOf(robotsOf(this.#session.request)[this.#choice.index]);
  }

  #edit(change, gesture = /** @type {any} */ (null)) {
    this.#session.edit(change(this.#session.request, this.#choice.index), gesture);
  }

  #append() {
    const last = this.#goals.at(-1);
    const beside = this.#beside(alternativesOf(last).at(-1) ?? last);
    this.#edit((request, index) => appendGoal(request, index, beside));
    this.#session.announce(`Goal ${this.#goals.length} added.`);
  }

  #appendPose(number) {
    const goal = this.#goals[number];
    const beside = this.#beside(alternativesOf(goal).at(-1) ?? goal);
    this.#edit((request, index) => appendAlternative(request, index, number, beside));
    this.#session.announce(`Pose ${alternativesOf(this.#goals[number]).length} of goal ${number + 1} added.`);
  }

  /** A place beside a pose, or beside the start if there is none. */
  #beside(pose) {
    const robot = this.#choice.robot;
    const from = pose ?? robot?.start ?? { x: 0, y: 0 };
    return { x: tidy(from.x + ASIDE * (robot?.radius ?? 0)), y: from.y };
  }

  #refresh() {
    const goals = this.#choice.index === null ? [] : this.#goals;
    setCount(this.#list, this.#rows, goals.length, (number) => this.#row(number));
    goals.forEach((goal, number) => this.#fill(this.#rows[number], goal, number));
  }

  #fill({ element: row, fields, poses, more }, goal, number) {
    const { index } = this.#choice;
    const listed = Array.isArray(robotsOf(this.#session.request)[index]?.goals);
    const pointer = listed ? `/robots/${index}/goals/${number}` : `/robots/${index}/goal`;
    const isLast = number === this.#goals.length - 1; // whose pose the form of the robot has, too
    point(row, isLast ? null : pointer);
    const alternatives = alternativesOf(goal);
    for (const [name, field] of Object.entries(fields)) {
      if (name in POSE) field.element.hidden = alternatives.length > 0;
      point(field.input, isLast && name in POSE ? null : `${pointer}/${name}`);
      showMember(field, name, goal?.[name]);
    }
    setCount(poses.list, poses.rows, alternatives.length, (at) => this.#poseRow(number, at));
    alternatives.forEach((pose, at) => {
      const place = poses.rows[at];
      point(place.element, `${pointer}/any_of/${at}`);
      for (const [name, field] of Object.entries(place.fields)) {
        point(field.input, `${pointer}/any_of/${at}/${name}`);
        showMember(field, name, pose?.[name]);
      }
    });
    more.disabled = alternatives.length >= MAX_POSES;
  }

  #row(number) {
    const fields = this.#fields(
      FIELDS,
      `goal ${number}`,
      (members) => (request, index) => setGoal(request, index, number, members),
    );
    const which = `goal ${number + 1}`;
    const earlier = this.#button("Move up", which, (request, index) => advanceGoal(request, index, number));
    earlier.disabled = number === 0;
    const remove = this.#button("Remove", which, (request, index) => removeGoalAt(request, index, number));
    const more = element("button", { type: "button", class: "quiet", textContent: "Or another pose" });
    more.setAttribute("aria-label", `Or another pose: ${which}`);
    more.addEventListener("click", () => this.#appendPose(number));
    const list = element("ol", { class: "poses-list" });
    const row = element(
      "li",
      { class: "field" },
      element("b", { textContent: `Goal ${number + 1}` }),
      list,
      partsOf(fields),
      element("div", { class: "row" }, more, earlier, remove),
    );
    return { element: row, fields, poses: { list, rows: [] }, more };
  }

  #poseRow(number, at) {
    const fields = this.#fields(
      ALTERNATIVE,
      `goal ${number} pose ${at}`,
      (members) => (request, index) => setAlternative(request, index, number, at, members),
    );
    const remove = this.#button("Remove", `pose ${at + 1} of goal ${number + 1}`, (request, index) =>
      removeAlternative(request, index, number, at),
    );
    const title = element("b", { textContent: `${at === 0 ? "At" : "Or at"} pose ${at + 1}` });
    const parts = partsOf(fields);
    parts.append(remove);
    return { element: element("li", { class: "field" }, title, parts), fields };
  }

  /** Fields by name; `setter(members)` is the change of a request that sets them, `place` names what is edited. */
  #fields(described, place, setter) {
    return Object.fromEntries(
      Object.entries(described).map(([name, each]) => {
        const accept = (value) => {
          const inUnits = name === "theta" ? radiansOf(value) : value;
          this.#edit(setter({ [name]: inUnits }), `robot ${this.#choice.index} ${place} ${name}`);
        };
        return [name, new NumberField({ ...each, accept, settle: () => this.#session.endGesture() })];
      }),
    );
  }

  #button(textContent, which, change) {
    const made = element("button", { type: "button", class: "quiet", textContent });
    made.setAttribute("aria-label", `${textContent}: ${which}`);
    made.addEventListener("click", () => {
      this.#edit(change);
      if (!made.isConnected) byId("append-goal").focus(); // the focus would be lost
    });
    return made;
  }
}

const partsOf = (fields) =>
  element("div", { class: "parts" }, ...Object.values(fields).map((field) => field.element));

const showMember = (field, name, value) => field.show(name === "theta" ? degreesOf(value) : value);

/** Sets what faults an element is for, see field_errors.js; null: none. */
function point(target, pointer) {
  if (pointer === null) delete target.dataset.pointer;
  else target.dataset.pointer = pointer;
}
