// The goals of the selected robot in the order of its visits: where, for how long, and not before when.

import { tidy } from "../model/cells.js";
import { degreesOf, radiansOf } from "../model/degrees.js";
import { advanceGoal, appendGoal, removeGoalAt, setGoal } from "../model/edit_goals.js";
import { goalsOf } from "../model/goals.js";
import { robotsOf } from "../model/listed.js";
import { byId, element } from "../ui/dom.js";
import { NumberField } from "../ui/number_field.js";

const FIELDS = {
  x: { label: "x", unit: "m", required: true },
  y: { label: "y", unit: "m", required: true },
  theta: { label: "Heading", unit: "°" },
  service: { label: "Service time", unit: "s" },
  not_before: { label: "Not before", unit: "s" },
  radius_after: { label: "Radius after", unit: "m" },
};
const POSE = new Set(["x", "y", "theta"]);
const ASIDE = 3; // radii between the last goal and a new one

export class GoalsForm {
  #session;
  #choice;
  #list = byId("goals-list");
  #rows = /** @type {any[]} */ ([]); // {element, fields}

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
    const robot = this.#choice.robot;
    const from = this.#goals.at(-1) ?? robot?.start ?? { x: 0, y: 0 };
    const aside = ASIDE * (robot?.radius ?? 0);
    this.#edit((request, index) => appendGoal(request, index, { x: tidy(from.x + aside), y: from.y }));
    this.#session.announce(`Goal ${this.#goals.length} added.`);
  }

  #refresh() {
    const goals = this.#choice.index === null ? [] : this.#goals;
    while (this.#rows.length > goals.length) this.#rows.pop().element.remove();
    while (this.#rows.length < goals.length) {
      const row = this.#row(this.#rows.length);
      this.#rows.push(row);
      this.#list.append(row.element);
    }
    goals.forEach((goal, number) => this.#fill(this.#rows[number], goal, number));
  }

  #fill({ element: row, fields }, goal, number) {
    const { index } = this.#choice;
    const listed = Array.isArray(robotsOf(this.#session.request)[index]?.goals);
    const pointer = listed ? `/robots/${index}/goals/${number}` : `/robots/${index}/goal`;
    const isLast = number === this.#goals.length - 1; // whose pose the form of the robot has, too
    point(row, isLast ? null : pointer);
    for (const [name, field] of Object.entries(fields)) {
      const value = goal?.[name];
      point(field.input, isLast && POSE.has(name) ? null : `${pointer}/${name}`);
      field.show(name === "theta" ? degreesOf(value) : value);
    }
  }

  #row(number) {
    const fields = Object.fromEntries(
      Object.entries(FIELDS).map(([name, described]) => {
        const accept = (value) => {
          const inUnits = name === "theta" ? radiansOf(value) : value;
          const gesture = `robot ${this.#choice.index} goal ${number} ${name}`;
          this.#edit((request, index) => setGoal(request, index, number, { [name]: inUnits }), gesture);
        };
        return [name, new NumberField({ ...described, accept, settle: () => this.#session.endGesture() })];
      }),
    );
    const earlier = this.#button("Move up", number, advanceGoal);
    earlier.disabled = number === 0;
    const remove = this.#button("Remove", number, removeGoalAt);
    const parts = Object.values(fields).map((field) => field.element);
    const row = element(
      "li",
      { class: "field" },
      element("b", { textContent: `Goal ${number + 1}` }),
      element("div", { class: "parts" }, ...parts),
      element("div", { class: "row" }, earlier, remove),
    );
    return { element: row, fields };
  }

  #button(textContent, number, change) {
    const made = element("button", { type: "button", class: "quiet", textContent });
    made.setAttribute("aria-label", `${textContent}: goal ${number + 1}`);
    made.addEventListener("click", () => {
      this.#edit((request, index) => change(request, index, number));
      if (!made.isConnected) byId("append-goal").focus(); // the focus would be lost
    });
    return made;
  }
}

/** Sets what faults an element is for, see field_errors.js; null: none. */
function point(target, pointer) {
  if (pointer === null) delete target.dataset.pointer;
  else target.dataset.pointer = pointer;
}
