// Actions on the selected robot by buttons and keys; each is one undo step and is announced.

import { deleteRobot, duplicateRobot, nameOf, removeGoal, setPose } from "../model/edit_request.js";
import { lastGoalOf } from "../model/goals.js";
import { robotsOf } from "../model/listed.js";
import { endDisks, nearestFreePlace, startDisks } from "../model/placement.js";
import { degrees } from "../ui/format.js";

const ROOM = 2.5; // radii between a start and its new goal

export class RobotActions {
  #session;
  #choice;

  /** `choice`: see RobotChoice. */
  constructor(session, choice) {
    this.#session = session;
    this.#choice = choice;
  }

  /** Moves or rotates the "start" or "goal" of the selected robot: sets the given members {x, y, theta}. */
  setPose(pose, members, gesture = null) {
    this.#session.edit(setPose(this.#session.request, this.#choice.index, pose, members), gesture);
  }

  /** Announces where the "start" or "goal" of the selected robot is now. */
  announcePose(pose) {
    const robot = robotsOf(this.#session.request)[this.#choice.index];
    const at = pose === "goal" ? lastGoalOf(robot) : robot?.[pose];
    const place = `(${at?.x}, ${at?.y}) m`;
    const heading = Number.isFinite(at?.theta) ? `, facing ${degrees(at.theta)}` : "";
    this.#session.announce(
      `${this.#name} ${pose === "goal" ? "has its goal" : "starts"} at ${place}${heading}.`,
    );
  }

  duplicate() {
    const { robot, index } = this.#choice;
    const { request, scene } = this.#session;
    if (index === null) return;
    const start = robot && this.#freePlace(robot, robot.start, startDisks(scene));
    const goal = robot?.goal && this.#freePlace(robot, robot.goal, endDisks(scene));
    this.#session.edit(duplicateRobot(request, index, start, goal));
    const name = this.#name;
    this.#choice.choose(robotsOf(this.#session.request).length - 1);
    this.#session.announce(`${name} duplicated as ${this.#name}.`);
  }

  delete() {
    const { index } = this.#choice;
    if (index === null) return;
    const name = this.#name;
    this.#choice.choose(null);
    this.#session.edit(deleteRobot(this.#session.request, index));
    this.#session.announce(`${name} deleted.`);
  }

  /** Gives the selected robot a goal beside its start, with any heading. */
  addGoal() {
    const { robot } = this.#choice;
    const others = endDisks(this.#session.scene, robot);
    const place = robot && this.#freePlace(robot, robot.start, others, ROOM * robot.radius);
    this.setPose("goal", place ?? { x: 0, y: 0 });
    this.announcePose("goal");
  }

  removeGoal() {
    this.#session.edit(removeGoal(this.#session.request, this.#choice.index));
    this.#session.announce(`${this.#name} has no goal: it stays at its start.`);
  }

  get #name() {
    return nameOf(this.#session.request, this.#choice.index);
  }

  /** The nearest place for a robot that is clear of walls and `others`; the point itself if there is none. */
  #freePlace({ radius }, point, others, beyond = 0) {
    const { grid } = this.#session.scene;
    const found = grid && nearestFreePlace(grid, point, radius, others, beyond);
    return found ?? { x: point.x, y: point.y };
  }
}
