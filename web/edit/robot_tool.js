// The tool that adds robots.

import { centreOf } from "../model/cells.js";
import { addRobot, nameOf } from "../model/edit_request.js";
import { robotsOf } from "../model/listed.js";
import { snapPoint } from "../model/placement.js";
import { CellCursor } from "./cell_cursor.js";

let gestures = 0; // for unique names

export class RobotTool {
  help = "Drag from a start to a goal to add a robot; a click adds one without a goal.";
  keys = "Alt: no snapping.";

  #session;
  #choice;
  #actions;
  #cursor;
  /** @type {any} */
  #pressed = null; // {start, gesture, added} while pressed

  /** `choice`: see RobotChoice; `actions`: see RobotActions. */
  constructor(session, stage, choice, actions) {
    this.#session = session;
    this.#choice = choice;
    this.#actions = actions;
    this.#cursor = new CellCursor(session, stage);
  }

  press(world, event) {
    gestures += 1;
    this.#pressed = { start: this.#snap(world, event), gesture: `add ${gestures}`, added: false };
    return true;
  }

  drag(world, event) {
    const { start, gesture } = this.#pressed;
    this.#add();
    this.#cursor.hover(world);
    const goal = this.#snap(world, event);
    const radius = this.#choice.robot?.radius ?? 0;
    if (Math.hypot(goal.x - start.x, goal.y - start.y) > radius) this.#actions.setPose("goal", goal, gesture);
  }

  release() {
    this.#add();
    this.#announce();
    this.abort();
  }

  abort() {
    this.#pressed = null;
    this.#session.endGesture();
  }

  hover(world) {
    this.#cursor.hover(world);
  }

  cursor() {
    return "copy";
  }

  paint(context, view) {
    if (!this.#pressed) this.#cursor.paint(context, view, { sign: "add" });
  }

  key(event) {
    const { cell } = this.#cursor;
    if (cell === null) return false;
    if (event.key !== "Enter" && event.key !== " ") return this.#cursor.key(event);
    this.press(centreOf(this.#session.scene.grid, cell), event);
    this.release();
    return true;
  }

  #add() {
    if (this.#pressed.added) return;
    this.#pressed.added = true;
    const { start, gesture } = this.#pressed;
    this.#session.edit(addRobot(this.#session.request, start), gesture);
    this.#choice.choose(robotsOf(this.#session.request).length - 1);
  }

  #announce() {
    const { request } = this.#session;
    const index = robotsOf(request).length - 1;
    const { start, goal } = request.robots[index];
    const where = `(${start.x}, ${start.y}) m`;
    const aim = goal ? `with its goal at (${goal.x}, ${goal.y}) m` : "without a goal";
    this.#session.announce(`${nameOf(request, index)} added at ${where}, ${aim}.`);
  }

  #snap(world, { altKey }) {
    return snapPoint(this.#session.scene.grid, world, altKey);
  }
}
