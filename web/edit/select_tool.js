// The tool that moves and rotates robots, by mouse, finger and keys.

import { ARROWS, snapHeading, snapPoint, stepped, turned } from "../model/placement.js";
import { paintHandles, paintPart, partAt } from "./handles.js";

const TURNS = { t: ["start", 1], T: ["start", -1], g: ["goal", 1], G: ["goal", -1] };

let gestures = 0; // for unique names

export class SelectTool {
  help = "Drag robots, goals and the handles that turn them.";
  keys = "Alt: no snapping. Shift: goals before starts.";

  #session;
  #stage;
  #choice;
  #actions;
  /** @type {any} */
  #hovered = null; // a part, see handles.js
  /** @type {any} */
  #drag = null; // {pose, turns, offset, gesture, moved}

  /** `choice`: see RobotChoice; `actions`: see RobotActions. */
  constructor(session, stage, choice, actions) {
    this.#session = session;
    this.#stage = stage;
    this.#choice = choice;
    this.#actions = actions;
  }

  press(world, event) {
    if (event.ctrlKey || event.metaKey) return false; // a click adds the robot to the chosen ones
    const part = this.#partAt(world, event);
    if (part === null) return false;
    const { robot, turns, place } = part;
    const draggedOut = event.shiftKey && part.pose === "start" && robot.goal === null;
    const pose = draggedOut ? "goal" : part.pose;
    const offset = { x: place.x - world.x, y: place.y - world.y };
    this.#choice.choose(robot.index);
    gestures += 1;
    this.#drag = { pose, turns, offset, gesture: `drag ${gestures}`, moved: false };
    return true;
  }

  drag(world, event) {
    const { pose, turns, offset, gesture } = this.#drag;
    const { robot } = this.#choice;
    if (!robot) return;
    this.#drag.moved = true;
    if (turns) {
      const theta = Math.atan2(world.y - robot[pose].y, world.x - robot[pose].x);
      this.#actions.setPose(pose, { theta: snapHeading(theta, event.altKey) }, gesture);
    } else {
      const point = { x: world.x + offset.x, y: world.y + offset.y };
      this.#actions.setPose(pose, snapPoint(this.#session.scene.grid, point, event.altKey), gesture);
    }
  }

  release() {
    if (this.#drag.moved) this.#actions.announcePose(this.#drag.pose);
    this.abort();
  }

  abort() {
    this.#drag = null;
    this.#session.endGesture();
  }

  hover(world) {
    const before = this.#hovered;
    this.#hovered = world && this.#partAt(world, null);
    if (this.#hovered !== before) this.#stage.redraw();
  }

  cursor(world) {
    const part = this.#partAt(world, null);
    if (part === null) return null;
    return part.turns ? "crosshair" : "move";
  }

  paint(context, view) {
    const { robot } = this.#choice;
    if (robot) paintHandles(context, view, robot);
    const hovered = this.#drag ? null : this.#hovered;
    if (hovered && this.#session.scene.robots.includes(hovered.robot)) {
      paintPart(context, view, hovered);
    }
  }

  key(event) {
    if (!this.#choice.robot) return false;
    if (event.ctrlKey || event.metaKey) {
      if (event.key.toLowerCase() !== "d" || event.shiftKey || event.altKey) return false;
      this.#actions.duplicate();
    } else if (event.key in ARROWS) {
      this.#step(event);
    } else if (event.key in TURNS && !event.altKey) {
      this.#turn(event, ...TURNS[event.key]);
    } else if (event.key === "Delete" || event.key === "Backspace") {
      this.#actions.delete();
    } else {
      return false;
    }
    return true;
  }

  #step(event) {
    const { robot } = this.#choice;
    const pose = event.shiftKey ? "goal" : "start";
    const { grid } = this.#session.scene;
    const place = stepped(grid, robot[pose] ?? robot.start, ARROWS[event.key], event.altKey);
    this.#actions.setPose(pose, place, this.#gestureOf(event));
    this.#actions.announcePose(pose);
    this.#stage.reveal(place);
  }

  #turn(event, pose, way) {
    const { robot } = this.#choice;
    if (!robot[pose]) return;
    const { theta } = robot[pose];
    this.#actions.setPose(pose, { theta: theta === null ? 0 : turned(theta, way) }, this.#gestureOf(event));
    this.#actions.announcePose(pose);
  }

  /** A key that is held down makes one undo step. */
  #gestureOf({ key, repeat }) {
    if (!repeat) gestures += 1;
    return `key ${key} ${gestures}`;
  }

  #partAt(world, event) {
    const { robot: chosen } = this.#choice;
    return partAt(world, { session: this.#session, stage: this.#stage, chosen, event });
  }
}
