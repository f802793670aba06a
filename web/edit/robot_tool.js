// The tool that adds robots: a click for the start and one for the goal; a drag from there turns the robot. What is about to
// be placed is shown to scale, beside walls and others where it is too near to them.

import { centreOf } from "../model/cells.js";
import { addRobot, nameOf, numbersOfNext } from "../model/edit_request.js";
import { robotsOf } from "../model/listed.js";
import {
  endDisks,
  lastRadius,
  placeWithRoom,
  snapHeading,
  snapPoint,
  startDisks,
} from "../model/placement.js";
import { drawPath, markWrong, ring } from "../scene/marks.js";
import { metres } from "../ui/format.js";
import { CellCursor } from "./cell_cursor.js";

const SHOWN = { width: 2, alpha: 1, dashes: [] };
const WAY = { width: 1.5, alpha: 0.8, dashes: [3, 5] };

let gestures = 0; // for unique names

export class RobotTool {
  help = "Click where a robot starts, and then where it goes. Drag instead, and it faces the pointer.";
  keys = "Alt: exactly here. Esc: without a goal.";

  #session;
  #choice;
  #actions;
  #cursor;
  /** @type {any} */
  #pressed = null; // {start: null if it does not fit, gesture, index: of the robot, null until it is added, pose} while pressed
  /** @type {string | null} */
  #added = null; // the id of the robot that was added last, by a click
  #isRefused = false; // the last click placed nothing
  #tell = /** @type {(text: string) => void} */ (() => {});

  /** `choice`: see RobotChoice; `actions`: see RobotActions. */
  constructor(session, stage, choice, actions) {
    this.#session = session;
    this.#choice = choice;
    this.#actions = actions;
    this.#cursor = new CellCursor(session, stage);
    session.on("request", ({ opened }) => opened && (this.#added = null));
  }

  /** The robot that the next click gives its goal, or null. */
  get awaiting() {
    const { robot } = this.#choice;
    return this.#added !== null && robot?.id === this.#added && robot.goal === null ? robot : null;
  }

  /** `tell(text)` shows why the last click placed nothing; "": it did. */
  onRefusal(tell) {
    this.#tell = tell;
  }

  press(world, event) {
    this.#refuse("");
    gestures += 1;
    const gesture = `add ${gestures}`;
    const { awaiting } = this;
    if (awaiting !== null) {
      this.#pressed = { start: awaiting.start, gesture, index: awaiting.index, pose: "goal" };
      this.#aim(world, event);
    } else {
      this.#pressed = { start: this.#startAt(world, event), gesture, index: null, pose: "start" };
    }
    return true;
  }

  drag(world, event) {
    this.#cursor.hover(world);
    const { start, gesture, pose } = this.#pressed;
    if (start === null) return;
    if (this.#pressed.index === null) this.#add();
    const from = this.#choice.robot?.[pose];
    if (!from) return;
    const theta = snapHeading(Math.atan2(world.y - from.y, world.x - from.x), event.altKey);
    this.#actions.setPose(pose, { theta }, gesture);
  }

  release() {
    const { start, index } = this.#pressed;
    if (start === null) {
      const { radius } = numbersOfNext(this.#session.request);
      this.#refuse(`A robot with a radius of ${metres(radius)} does not fit here.`);
    } else {
      if (index === null) this.#add();
      if (!this.#isRefused) this.#announce();
    }
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

  /** Shows to scale what a click would place. */
  paint(context, view) {
    const { cell } = this.#cursor;
    const { scene, request } = this.#session;
    if (this.#pressed || cell === null || !this.#cursor.isSeen) return;
    const { awaiting } = this;
    const point = centreOf(scene.grid, cell);
    const radius = awaiting?.radius ?? numbersOfNext(request).radius;
    const place = awaiting ? this.#goalAt(point, {}) : this.#startAt(point, {});
    if (place === null) {
      markWrong(context, view, point, radius);
      return;
    }
    const { screen, scale, theme } = view;
    const at = screen(place);
    if (awaiting) drawPath(context, [screen(awaiting.start), at], theme.accent, WAY);
    context.save();
    context.globalAlpha = awaiting ? 0.14 : 0.4;
    context.fillStyle = theme.accent;
    context.beginPath();
    context.arc(at.x, at.y, Math.max(radius * scale, 3), 0, 2 * Math.PI);
    context.fill();
    context.restore();
    ring(context, at, Math.max(radius * scale, 3), theme.accent, SHOWN);
  }

  key(event) {
    const { cell } = this.#cursor;
    if (cell === null) return false;
    if (event.key !== "Enter" && event.key !== " ") {
      const isMoved = this.#cursor.key(event);
      if (isMoved) this.#announcePlace();
      return isMoved;
    }
    this.press(centreOf(this.#session.scene.grid, cell), event);
    this.release();
    return true;
  }

  #add() {
    const { start, gesture } = this.#pressed;
    this.#session.edit(addRobot(this.#session.request, start), gesture);
    const robots = robotsOf(this.#session.request);
    this.#pressed.index = robots.length - 1;
    this.#added = robots.at(-1).id;
    this.#choice.choose(this.#pressed.index);
  }

  /** Puts the goal of the robot at a world point, unless that is its start. */
  #aim(world, event) {
    const { start, gesture } = this.#pressed;
    const goal = this.#goalAt(world, event);
    const radius = this.#choice.robot?.radius ?? 0;
    if (goal === null) {
      const { grid } = this.#session.scene;
      const isOutside = grid !== null && !isWithin(grid.bounds, world);
      this.#refuse(isOutside ? "The goal would be outside the map." : "The robot does not fit there.");
      return;
    }
    this.#refuse("");
    if (Math.hypot(goal.x - start.x, goal.y - start.y) <= radius) return;
    this.#actions.setPose("goal", goal, gesture);
  }

  /** Where the arrow keys have led, and whether what is placed next fits there. */
  #announcePlace() {
    const { scene, request } = this.#session;
    const { cell } = this.#cursor;
    if (cell === null) return;
    const point = centreOf(scene.grid, cell);
    const place = this.awaiting ? this.#goalAt(point, {}) : this.#startAt(point, {});
    const what = this.awaiting ? `Goal of ${this.awaiting.id}` : "Start";
    const where = `(${Number(point.x.toFixed(3))}, ${Number(point.y.toFixed(3))}) m`;
    const { radius } = this.awaiting ?? numbersOfNext(request);
    const fit = place === null ? `, too near for a radius of ${metres(radius)}` : "";
    this.#session.announce(`${what} at ${where}${fit}`);
  }

  #refuse(text) {
    this.#isRefused = text !== "";
    this.#tell(text);
    if (text !== "") this.#session.announce(text);
  }

  #announce() {
    const { request } = this.#session;
    const { index } = this.#pressed;
    const { start, goal } = robotsOf(request)[index];
    const aim = goal ? `with its goal at (${goal.x}, ${goal.y}) m` : "without a goal";
    this.#session.announce(`${nameOf(request, index)} starts at (${start.x}, ${start.y}) m, ${aim}.`);
  }

  #startAt(world, event) {
    const { radius } = numbersOfNext(this.#session.request);
    return this.#placeAt(world, radius, startDisks(this.#session.scene), event);
  }

  #goalAt(world, event) {
    const { robot } = this.#choice;
    if (!robot) return null;
    return this.#placeAt(world, lastRadius(robot), endDisks(this.#session.scene, robot), event);
  }

  /** Where a disk is put by a click: beside what is in its way, or null if that is too far; with Alt, exactly there. */
  #placeAt(world, radius, others, { altKey = false }) {
    const { grid } = this.#session.scene;
    return grid && !altKey ? placeWithRoom(grid, world, radius, others) : snapPoint(grid, world, altKey);
  }
}

const isWithin = ({ left, right, bottom, top }, { x, y }) =>
  x >= left && x <= right && y >= bottom && y <= top;
