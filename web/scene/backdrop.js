// A picture of what does not move, painted once for each camera. While the camera moves over many robots, the last
// picture is shown in its new place instead, somewhat blurred, and painted again now and then.

import { contextOf } from "../ui/dom.js";

const MOST_STALE_MS = 400;

export class Backdrop {
  #canvas = document.createElement("canvas");
  #key = "";
  #camera = { x: 0, y: 0, scale: 1 };
  #painted = -Infinity; // when, of performance.now()

  /** Has the picture painted again before it is drawn next. */
  drop() {
    this.#key = "";
  }

  /**
   * Draws the picture for a view {camera, viewport, ratio, width, height}; `paint(context)` paints it, unless `moving`: then
   * the last one will do. `background`: the colour around it.
   */
  draw(context, view, { moving, background, paint }) {
    const { camera, ratio, width, height } = view;
    const key = [camera.x, camera.y, camera.scale, width, height, ratio].join();
    const isStale = key !== this.#key;
    if (isStale && !(moving && this.#canShift(width, height))) this.#refresh(view, key, paint);
    if (key === this.#key) {
      context.drawImage(this.#canvas, 0, 0);
      return;
    }
    const zoom = camera.scale / this.#camera.scale;
    const x = width / 2 - (width / 2) * zoom + (this.#camera.x - camera.x) * camera.scale * ratio;
    const y = height / 2 - (height / 2) * zoom - (this.#camera.y - camera.y) * camera.scale * ratio;
    context.fillStyle = background;
    context.fillRect(0, 0, width, height);
    context.drawImage(this.#canvas, x, y, width * zoom, height * zoom);
  }

  #canShift(width, height) {
    const isAlike = this.#key !== "" && this.#canvas.width === width && this.#canvas.height === height;
    return isAlike && performance.now() - this.#painted < MOST_STALE_MS;
  }

  #refresh({ camera, width, height }, key, paint) {
    this.#key = key;
    this.#camera = camera;
    this.#painted = performance.now();
    this.#canvas.width = width;
    this.#canvas.height = height;
    paint(contextOf(this.#canvas, { alpha: false }));
  }
}
