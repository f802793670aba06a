// Another plan of the same robots, drawn as dashed rings and paths beside what is played.

import { readTracks, robotPoseAt, robotRadiusAt } from "../model/scene.js";
import { drawPath, ring } from "./marks.js";

/** @import {Track} from "../model/types.js" */

const RING = { width: 2, alpha: 1, dashes: [4, 3] };
const PATH = { width: 1.5, alpha: 0.6, dashes: [2, 4] };
const LINK = { width: 1, alpha: 0.8, dashes: [] };
const MAX_PATHS = 60; // more would cover the map

export class Ghosts {
  #session;
  #stage;
  /** @type {Map<string, Track> | null} */
  #tracks = null; // by robot

  constructor(session, stage) {
    this.#session = session;
    this.#stage = stage;
    stage.addOverlay((context, view) => this.#paint(context, view));
  }

  /** Shows the plans of another answer to the session's request as ghosts, or none (null). */
  show(answer) {
    this.#tracks = answer && readTracks(this.#session.scene, answer);
    this.#stage.redraw();
  }

  #paint(context, view) {
    if (this.#tracks === null) return;
    const { marked } = view;
    const all = this.#session.scene.robots.length <= MAX_PATHS;
    for (const robot of this.#session.scene.robots) {
      const track = this.#tracks.get(robot.id);
      if (track === undefined || track.cost === null) continue; // it has no plan there
      if (all || marked.has(robot.id)) drawPath(context, track.path.map(view.screen), view.theme.muted, PATH);
      this.#paintRobot(context, view, robot, track);
    }
  }

  #paintRobot(context, { screen, scale, theme, time }, robot, track) {
    const pose = robotPoseAt(robot, track, time);
    const [ghost, place] = [screen(pose), screen(this.#session.poseOf(robot.id, time))];
    const radius = Math.max(3, robotRadiusAt(robot, track, time) * scale);
    ring(context, ghost, radius, theme.ink, RING);
    if (Math.hypot(ghost.x - place.x, ghost.y - place.y) < 1) return;
    drawPath(context, [place, ghost], theme.ink, LINK);
  }
}
