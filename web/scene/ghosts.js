// Another plan of the same robots, drawn as dashed rings and paths beside what is played.

import { pathOf, poseAt } from "../model/timeline.js";
import { drawPath, ring } from "./marks.js";

const RING = { width: 2, alpha: 1, dashes: [4, 3] };
const PATH = { width: 1.5, alpha: 0.6, dashes: [2, 4] };
const LINK = { width: 1, alpha: 0.8, dashes: [] };
const MOST_PATHS = 60; // more would cover the map

export class Ghosts {
  #session;
  #stage;
  /** @type {Map<string, any[]> | null} */
  #actions = null; // by robot
  /** @type {Map<string, any[]>} */
  #paths = new Map();

  constructor(session, stage) {
    this.#session = session;
    this.#stage = stage;
    stage.addOverlay((context, view) => this.#paint(context, view));
  }

  /** Shows plans ([{robot, actions}]) as ghosts, or none (null). */
  show(plans) {
    this.#actions = plans && new Map(plans.map(({ robot, actions }) => [robot, actions]));
    this.#paths = new Map((plans ?? []).map(({ robot, actions }) => [robot, pathOf(actions)]));
    this.#stage.redraw();
  }

  #paint(context, view) {
    if (this.#actions === null) return;
    const { marked } = view;
    const all = this.#session.scene.robots.length <= MOST_PATHS;
    for (const robot of this.#session.scene.robots) {
      if (!this.#actions.has(robot.id)) continue;
      if (all || marked.has(robot.id)) this.#paintPath(context, view, robot.id);
      this.#paintRobot(context, view, robot);
    }
  }

  #paintPath(context, { screen, theme }, id) {
    drawPath(context, (this.#paths.get(id) ?? []).map(screen), theme.muted, PATH);
  }

  #paintRobot(context, { screen, scale, theme, time }, robot) {
    const pose = poseAt(this.#actions?.get(robot.id) ?? [], robot.start, time);
    const [ghost, place] = [screen(pose), screen(this.#session.poseOf(robot.id, time))];
    const radius = Math.max(3, robot.radius * scale);
    ring(context, ghost, radius, theme.ink, RING);
    if (Math.hypot(ghost.x - place.x, ghost.y - place.y) < 1) return;
    drawPath(context, [place, ghost], theme.ink, LINK);
  }
}
