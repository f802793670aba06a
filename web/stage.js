// The scene on the page: canvas, camera, gestures and keys.

import { byId } from "./dom.js";
import { Painter } from "./draw.js";
import { watchGestures } from "./gestures.js";
import { readTheme } from "./palette.js";
import { robotPoseAt } from "./scene.js";
import { fit, keepInSight, panBy, scaleLimits, toScreen, toWorld, zoomAt } from "./view.js";

const MARGIN = 24; // pixels left free around a fitted map
const HEADROOM = 64; // pixels above it, where the view's buttons are
const KEY_PAN = 60; // pixels
const KEY_ZOOM = 1.4;
const REACH = 6; // pixels around a small robot that still pick it

export class Stage {
  #canvas = byId("scene");
  #painter = new Painter(this.#canvas);
  #viewport = { width: 0, height: 0 };
  #camera = { x: 0, y: 0, scale: 1 };
  #fitted = true; // the camera follows the viewport until someone moves it
  #scene = { grid: null, robots: [] };
  #tracks = new Map();
  #theme = readTheme();
  #time = 0;
  #marked = new Set();
  #scheduled = false;

  /** `told` has hover(id or null) and select(id or null). */
  constructor(told) {
    new ResizeObserver(() => this.#resize()).observe(this.#canvas);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
      this.#theme = readTheme();
      this.show(this.#scene, this.#tracks);
    });
    watchGestures(this.#canvas, {
      pan: (dx, dy) => this.#move(panBy(this.#camera, dx, dy)),
      zoom: (pixel, factor) => this.#zoom(pixel, factor),
      hover: (pixel) => {
        const id = pixel && this.#robotAt(pixel);
        this.#canvas.classList.toggle("on-robot", id !== null);
        told.hover(id);
      },
      click: (pixel) => told.select(this.#robotAt(pixel)),
    });
    this.#canvas.addEventListener("keydown", (event) => this.#onArrow(event));
    byId("fit").addEventListener("click", () => this.fit());
    byId("zoom-in").addEventListener("click", () => this.zoomIn());
    byId("zoom-out").addEventListener("click", () => this.zoomOut());
  }

  /** What to draw from now on; keeps the camera. */
  show(scene, tracks) {
    this.#scene = scene;
    this.#tracks = tracks;
    this.#painter.show(scene, tracks, this.#theme);
    this.#schedule();
  }

  /** The moment and the robots to bring out. */
  update(time, marked) {
    this.#time = time;
    this.#marked = marked;
    this.#schedule();
  }

  describe(text) {
    this.#canvas.setAttribute("aria-label", text);
  }

  fit() {
    this.#fitted = true;
    if (this.#viewport.width > 0) this.#camera = fit(this.#bounds(), this.#viewport, this.#insets());
    this.#schedule();
  }

  zoomIn() {
    this.#zoom(this.#middle(), KEY_ZOOM);
  }

  zoomOut() {
    this.#zoom(this.#middle(), 1 / KEY_ZOOM);
  }

  /** Where a disk of the world is on the canvas: {x, y, radius}, CSS pixels. */
  screenOf(point, radius) {
    return { ...toScreen(this.#camera, this.#viewport, point), radius: radius * this.#camera.scale };
  }

  #resize() {
    const box = this.#canvas.getBoundingClientRect();
    const before = toWorld(this.#camera, this.#viewport, this.#middle());
    this.#viewport = { width: box.width, height: box.height };
    if (this.#fitted) this.fit();
    else this.#move({ ...this.#camera, ...before });
    this.#paint();
  }

  #middle() {
    return { x: this.#viewport.width / 2, y: this.#viewport.height / 2 };
  }

  #insets() {
    const margin = Math.min(MARGIN, this.#viewport.width * 0.03);
    return { left: margin, right: margin, bottom: margin, top: HEADROOM };
  }

  #bounds() {
    return this.#scene.grid?.bounds ?? { left: 0, bottom: 0, right: 1, top: 1 };
  }

  #move(camera) {
    this.#fitted = false;
    this.#camera = keepInSight(camera, this.#bounds());
    this.#schedule();
  }

  #zoom(pixel, factor) {
    const cell = this.#scene.grid?.resolution ?? 1;
    const limits = scaleLimits(this.#bounds(), this.#viewport, this.#insets(), cell);
    this.#move(zoomAt(this.#camera, this.#viewport, pixel, factor, limits));
  }

  #onArrow(event) {
    const steps = { ArrowLeft: [1, 0], ArrowRight: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
    const step = steps[event.key];
    if (!step) return;
    event.preventDefault();
    this.#move(panBy(this.#camera, step[0] * KEY_PAN, step[1] * KEY_PAN));
  }

  /** The id of the robot under a pixel, the nearest if there are several, or null. */
  #robotAt(pixel) {
    const world = toWorld(this.#camera, this.#viewport, pixel);
    let found = null;
    let nearest = Infinity;
    for (const robot of this.#scene.robots) {
      const pose = robotPoseAt(robot, this.#tracks.get(robot.id), this.#time);
      const distance = Math.hypot(pose.x - world.x, pose.y - world.y);
      const reach = Math.max(robot.radius, REACH / this.#camera.scale);
      if (distance > reach || distance >= nearest) continue;
      nearest = distance;
      found = robot.id;
    }
    return found;
  }

  #schedule() {
    if (this.#scheduled) return;
    this.#scheduled = true;
    requestAnimationFrame(() => this.#paint());
  }

  #paint() {
    this.#scheduled = false;
    this.#painter.paint({
      camera: this.#camera,
      viewport: this.#viewport,
      ratio: window.devicePixelRatio || 1,
      time: this.#time,
      marked: this.#marked,
    });
  }
}
