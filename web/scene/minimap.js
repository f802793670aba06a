// The minimap: while the scene is zoomed in, the whole map with the robots and the part that is in sight. A press or a
// drag moves the scene there; keys pan in the scene itself.

import { byId, contextOf } from "../ui/dom.js";
import { MapRaster } from "./map_raster.js";
import { fit, toScreen, toWorld } from "./view.js";

const LONGEST = 150; // pixels of its longer side
const FROM = 1.25; // times the scale at which the map fits
const EVERY_MS = 100; // between paintings
const DOT = 1.5;
const NO_INSETS = { left: 0, right: 0, top: 0, bottom: 0 };

export class Minimap {
  #session;
  #stage;
  #canvas = byId("minimap");
  #raster = new MapRaster();
  #base = document.createElement("canvas");
  #painted = /** @type {any} */ ({}); // {grid, wall, floor}, of the base
  #last = -Infinity;
  #timer = /** @type {any} */ (null);

  constructor(session, stage) {
    this.#session = session;
    this.#stage = stage;
    stage.addOverlay((_, view) => this.#show(view));
    this.#canvas.addEventListener("pointerdown", (event) => {
      this.#canvas.setPointerCapture(event.pointerId);
      this.#go(event);
    });
    this.#canvas.addEventListener("pointermove", (event) => {
      if (this.#canvas.hasPointerCapture(event.pointerId)) this.#go(event);
    });
  }

  get #size() {
    const { bounds } = this.#session.scene.grid;
    const [across, down] = [bounds.right - bounds.left, bounds.top - bounds.bottom];
    const share = LONGEST / Math.max(across, down);
    return {
      width: Math.max(24, Math.round(across * share)),
      height: Math.max(24, Math.round(down * share)),
    };
  }

  #go({ offsetX, offsetY }) {
    const camera = fit(this.#session.scene.grid.bounds, this.#size, NO_INSETS);
    this.#stage.moveTo(toWorld(camera, this.#size, { x: offsetX, y: offsetY }));
  }

  #show(view) {
    const { grid } = this.#session.scene;
    const isIn = grid !== null && view.scale > FROM * fit(grid.bounds, view.viewport, NO_INSETS).scale;
    this.#canvas.hidden = !isIn;
    clearTimeout(this.#timer);
    if (!isIn) return;
    const wait = EVERY_MS - (performance.now() - this.#last);
    if (wait <= 0) this.#paint(view);
    else this.#timer = setTimeout(() => this.#paint(view), wait);
  }

  #paint({ camera, viewport, theme, time }) {
    const { grid, robots } = this.#session.scene;
    if (grid === null) return;
    this.#last = performance.now();
    const ratio = window.devicePixelRatio || 1;
    const { width, height } = this.#size;
    this.#refreshBase(grid, theme, width * ratio, height * ratio);
    Object.assign(this.#canvas, { width: width * ratio, height: height * ratio });
    Object.assign(this.#canvas.style, { width: `${width}px`, height: `${height}px` });
    const context = contextOf(this.#canvas);
    context.drawImage(this.#base, 0, 0);
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    const small = fit(grid.bounds, { width, height }, NO_INSETS);
    context.fillStyle = theme.accent;
    for (const { id } of robots) {
      const { x, y } = toScreen(small, { width, height }, this.#session.poseOf(id, time));
      context.fillRect(x - DOT, y - DOT, 2 * DOT, 2 * DOT);
    }
    const corner = toScreen(small, { width, height }, toWorld(camera, viewport, { x: 0, y: 0 }));
    const share = small.scale / camera.scale;
    context.strokeStyle = theme.ink;
    context.lineWidth = 1.5;
    context.strokeRect(corner.x, corner.y, viewport.width * share, viewport.height * share);
  }

  /** The map alone, which is painted again only when it or the theme changes. */
  #refreshBase(grid, theme, width, height) {
    const { floor, wall } = theme;
    const known = this.#painted;
    if (known.grid === grid && known.wall === wall && known.width === width) return;
    this.#painted = { grid, wall, width };
    Object.assign(this.#base, { width, height });
    const context = contextOf(this.#base);
    context.fillStyle = floor;
    context.fillRect(0, 0, width, height);
    this.#raster.show(grid, [null, wall]);
    this.#raster.draw(context, 0, 0, Math.min(width / grid.columns, height / grid.rows));
  }
}
