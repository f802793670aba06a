// One picture of all that is seen of the scene: alone, or with the scene of another plan beside it and their captions.

import { contextOf } from "../ui/dom.js";
import { drawTag } from "./marks.js";
import { readTheme } from "./palette.js";

export class ScenePicture {
  #stage;
  #joined = document.createElement("canvas");

  constructor(stage) {
    this.#stage = stage;
  }

  /** Paints it, with so many pixels a CSS pixel; returns the canvas, the same one while the same scenes are seen. */
  paint(ratio = window.devicePixelRatio || 1) {
    const { canvas } = this.#stage;
    this.#stage.paint(ratio);
    const frame = canvas.parentElement;
    const other = frame.querySelector("#other-scene");
    if (other === null) return canvas;
    this.#join(frame, [canvas, other], ratio);
    return this.#joined;
  }

  #join(frame, scenes, ratio) {
    const [width, height] = [frame.clientWidth, frame.clientHeight].map((size) => Math.round(size * ratio));
    if (this.#joined.width !== width || this.#joined.height !== height) {
      Object.assign(this.#joined, { width, height });
    }
    const context = contextOf(this.#joined);
    context.setTransform(1, 0, 0, 1, 0, 0);
    for (const scene of scenes) {
      context.drawImage(scene, Math.round(scene.offsetLeft * ratio), Math.round(scene.offsetTop * ratio));
    }
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    const theme = readTheme();
    for (const caption of frame.querySelectorAll(".scene-caption")) {
      const { offsetLeft, offsetTop, offsetWidth, offsetHeight } = caption;
      const middle = { x: offsetLeft + offsetWidth / 2, y: offsetTop + offsetHeight / 2 };
      drawTag(context, theme, middle, caption.textContent);
    }
  }
}
