// A second scene beside the first, with another plan of the same robots: one clock, one camera, one selection.

import { readTracks, robotPoseAt } from "../model/scene.js";
import { byId, element, setText } from "../ui/dom.js";
import { Painter } from "./draw.js";
import { watchGestures } from "./gestures.js";

const NAMES = ["this plan", "the other plan"];

export class OtherScene {
  #session;
  #stage;
  #canvas = element("canvas", { id: "other-scene", role: "img" });
  #captions = NAMES.map(() => element("p", { class: "scene-caption" }));
  #parts = element("div", { id: "comparison" }, this.#canvas, ...this.#captions);
  #painter = /** @type {Painter | null} */ (null); // while it is shown
  #painted = /** @type {any[]} */ ([]); // what the painter shows
  #tracks = new Map();

  constructor(session, stage) {
    this.#session = session;
    this.#stage = stage;
    const poseNow = (robot) => robotPoseAt(robot, this.#tracks.get(robot.id), session.player.time);
    watchGestures(
      this.#canvas,
      stage.cameraGestures(this.#canvas, (world) => stage.diskAt(world, poseNow)?.robot.id ?? null),
    );
    stage.addOverlay((_, view) => this.#paint(view));
  }

  /** Shows an answer, {plans, unplanned}, beside what is played, each under its name; null: no longer. */
  show(answer, names = NAMES) {
    this.#painter = null;
    if (answer === null) {
      this.#parts.remove();
      return;
    }
    this.#tracks = readTracks(this.#session.scene, answer);
    this.#painter = new Painter(this.#canvas);
    this.#painted = [];
    this.#canvas.setAttribute("aria-label", names[1]);
    this.#captions.forEach((caption, at) => setText(caption, names[at]));
    byId("scene").after(this.#parts);
    this.#stage.redraw();
  }

  /** Paints what the first scene has just painted, of the other plan; see Painter for `view`. */
  #paint({ camera, viewport, ratio, time, marked, moving, theme }) {
    if (this.#painter === null) return;
    const shown = [this.#session.scene, this.#tracks, theme, this.#stage.look];
    if (shown.some((part, at) => part !== this.#painted[at])) {
      this.#painted = shown;
      const [scene, tracks, , look] = shown;
      this.#painter.show(scene, tracks, theme, look);
    }
    const overlays = this.#stage.sharedOverlays;
    this.#painter.paint({ camera, viewport, ratio, time, marked, moving, overlays });
  }
}
