// A picture of everything that does not move, painted once for each camera. While the camera moves over many robots,
// the last picture is shown in its new place instead, somewhat blurred. Now and then, a new picture is painted in
// parts; each frame paints one part.

import { contextOf } from "../ui/dom.js";

const MAX_STALE_MS = 400;
const PART_MS = 2; // of a frame

export class Backdrop {
  #canvases = [0, 1].map(() => document.createElement("canvas"));
  /** @type {Picture | null} */
  #shown = null;
  /** @type {Picture | null} */
  #next = null; // is being painted

  /** Has the picture painted again before it is drawn next. */
  drop() {
    this.#shown = this.#next = null;
  }

  /**
   * Draws the picture for a view {camera, viewport, ratio, width, height}. `paint(context)` paints it, as a generator
   * that yields now and then. It is painted at once, unless `moving`: then the last picture is enough. `background`:
   * the colour around it.
   */
  draw(context, view, { moving, background, paint }) {
    const shown =
      moving && this.#shown?.canShift(view) ? this.#refreshed(view, paint) : this.#exact(view, paint);
    shown.draw(context, view, background);
  }

  /** A new picture, on the canvas that is not shown. */
  #begin(view, paint) {
    const free = this.#canvases.find((canvas) => canvas !== this.#shown?.canvas);
    return new Picture(/** @type {HTMLCanvasElement} */ (free), view, paint);
  }

  /** The picture of this very view. */
  #exact(view, paint) {
    this.#next = null;
    if (this.#shown?.isOf(view)) return this.#shown;
    this.#shown = this.#begin(view, paint);
    this.#shown.paint(Infinity);
    return this.#shown;
  }

  /** The last picture, or the one of a view since then that is complete now. */
  #refreshed(view, paint) {
    const shown = /** @type {Picture} */ (this.#shown);
    if (shown.isOf(view)) return shown;
    const isStale = performance.now() - shown.begun >= MAX_STALE_MS;
    if (this.#next === null && isStale) this.#next = this.#begin(view, paint);
    if (!this.#next?.paint(PART_MS)) return shown;
    this.#shown = this.#next;
    this.#next = null;
    return this.#shown;
  }
}

class Picture {
  begun = performance.now();
  canvas;
  #view;
  #steps;

  constructor(canvas, view, paint) {
    this.canvas = canvas;
    this.#view = view;
    canvas.width = view.width;
    canvas.height = view.height;
    this.#steps = paint(contextOf(canvas, { alpha: false }));
  }

  isOf(view) {
    return keyOf(view) === keyOf(this.#view);
  }

  /** Whether it can be shown in its new place. */
  canShift({ width, height, ratio }) {
    const view = this.#view;
    return width === view.width && height === view.height && ratio === view.ratio;
  }

  /** Goes on for so many milliseconds; returns whether it is complete. */
  paint(milliseconds) {
    const end = performance.now() + milliseconds;
    while (performance.now() < end) if (this.#steps.next().done) return true;
    return false;
  }

  draw(context, view, background) {
    if (this.isOf(view)) {
      context.drawImage(this.canvas, 0, 0);
      return;
    }
    const { camera, ratio, width, height } = view;
    const own = this.#view.camera;
    const zoom = camera.scale / own.scale;
    const x = width / 2 - (width / 2) * zoom + (own.x - camera.x) * camera.scale * ratio;
    const y = height / 2 - (height / 2) * zoom - (own.y - camera.y) * camera.scale * ratio;
    context.fillStyle = background;
    context.fillRect(0, 0, width, height);
    context.drawImage(this.canvas, x, y, width * zoom, height * zoom);
  }
}

const keyOf = ({ camera, ratio, width, height }) =>
  [camera.x, camera.y, camera.scale, width, height, ratio].join();
