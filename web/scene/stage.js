// The scene on the page: canvas, camera, gestures and keys. Features add overlays, which paint on top of each
// frame, and a tool, which may handle presses and keys before the camera.

import { robotPoseAt } from "../model/scene.js";
import { Signals } from "../model/signals.js";
import { byId } from "../ui/dom.js";
import { Painter } from "./draw.js";
import { watchGestures } from "./gestures.js";
import { fit, keepInSight, panBy, scaleLimits, toScreen, toWorld, zoomAt } from "./view.js";

const MARGIN = 24; // pixels around a fitted map
const HEADROOM = 64; // pixels above it, where the view's buttons are
const FOOTROOM = 28; // pixels below it, where the scale is
const REST_MS = 120; // without a movement of the camera
const KEY_PAN = 60; // pixels
const KEY_ZOOM = 1.4;
const LEGIBLE = 10; // pixels: the least radius of a robot in the middle
const FRAMED = 40; // pixels: the largest radius of the smallest disk that is framed with others
const REACH = { mouse: 6, touch: 24 }; // pixels: the least radius for picking a robot
const NOWHERE = { left: 0, bottom: 0, right: 1, top: 1 };

/**
 * The members of a tool, all optional. World points are in metres.
 *
 * - press(world, event) returns whether the tool handles the press
 * - drag(world, event) follows, unless it is a click
 * - release(world, event) ends it, or abort() if the press became a pinch
 * - hover(world or null)
 * - key(event) returns whether it handled the key
 * - cursor(world) returns a CSS cursor or null
 * - paint(context, view) paints on top, see addOverlay
 */
export class Stage {
  #session;
  #colours;
  #canvas = byId("scene");
  #painter = new Painter(this.#canvas);
  #viewport = { width: 0, height: 0 };
  #camera = { x: 0, y: 0, scale: 1 };
  #fitted = true; // the camera fits the viewport until it is moved
  #look = { colours: "robot", paths: "whole", heat: "none", lattice: false, travel: null };
  #overlays = [];
  #shared = []; // the overlays that other scenes show, too
  #ownTool = {};
  #lentTool = /** @type {any} */ (null);
  #baseTool = {};
  #pressed = {}; // the tool that handles the press
  #scheduled = false;
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  #rest; // set while the camera is being moved
  #signals = new Signals();
  #pointer = "mouse"; // or "touch": what was used last
  #beside = 0; // pixels at the right that the view's buttons take

  /** `colours`: see RobotColours. */
  constructor(session, colours) {
    this.#session = session;
    this.#colours = colours;
    new ResizeObserver(() => this.#resize()).observe(this.#canvas);
    colours.onChange(() => this.#show());
    session.on("answer", () => this.#show());
    session.on("request", ({ opened }) => (opened || this.#fitted) && this.#fit());
    session.on("time marks", () => this.redraw());
    watchGestures(this.#canvas, this.#gestures());
    this.#canvas.addEventListener("keydown", (event) => this.#onKey(event));
    byId("fit").addEventListener("click", () => this.fit());
    byId("zoom-in").addEventListener("click", () => this.zoomIn());
    byId("zoom-out").addEventListener("click", () => this.zoomOut());
  }

  /**
   * `paint(context, view)` paints on top of each frame, in CSS pixels; see Painter for `view`. `shared`: also on the
   * scene of another plan. There, the tracks of the view are the tracks of that plan.
   */
  addOverlay(paint, { shared = false } = {}) {
    this.#overlays.push(paint);
    if (shared) this.#shared.push(paint);
    this.redraw();
  }

  /** What is painted on top of the scene of another plan, see addOverlay; with the tool that is lent. */
  get sharedOverlays() {
    const tool = this.#lentTool;
    return tool?.paint ? [...this.#shared, tool.paint.bind(tool)] : this.#shared;
  }

  /** Sets the tool for presses that the current one leaves. */
  setBaseTool(tool) {
    this.#baseTool = tool;
    this.addOverlay((context, view) => tool.paint(context, view));
  }

  /** Sets a tool that comes before the current one, or none again (null). */
  lendTool(tool) {
    this.#lentTool = tool;
    this.#showTool();
  }

  /** Sets the current tool; null: none. */
  setTool(tool) {
    this.#ownTool = tool ?? {};
    this.#showTool();
  }

  get #tool() {
    return this.#lentTool ?? this.#ownTool;
  }

  #showTool() {
    this.#canvas.setAttribute("role", this.#tool.key ? "application" : "img"); // screen readers pass its keys
    this.#canvas.style.cursor = "";
    this.#offerSwipes();
    this.redraw();
  }

  /**
   * The display options: {colours, paths, heat, lattice, travel}.
   *
   * - colours: "robot" or "state"
   * - paths: "whole", "remaining" or "none"
   * - heat: "none", "waiting" or "passage"
   * - lattice: whether it is shown
   * - travel: {field: a TravelField} or null
   */
  get look() {
    return this.#look;
  }

  setLook(changes) {
    this.#look = { ...this.#look, ...changes };
    this.#show();
  }

  /** Pixels per metre. */
  get scale() {
    return this.#camera.scale;
  }

  get canvas() {
    return this.#canvas;
  }

  /** Shows the whole map. */
  fit() {
    this.#fit();
    this.#signals.emit("pan");
  }

  #fit() {
    this.#fitted = true;
    if (this.#viewport.width > 0) this.#camera = this.#cameraFor(this.#bounds());
    this.#offerSwipes();
    this.redraw();
  }

  zoomIn() {
    this.#zoom(this.#middle(), KEY_ZOOM);
  }

  zoomOut() {
    this.#zoom(this.#middle(), 1 / KEY_ZOOM);
  }

  /** Moves the camera if necessary so that a world point is visible. */
  reveal(point) {
    const { x, y } = this.screenOf(point, 0);
    const { width, height } = this.#viewport;
    if (x > 40 && x < width - 40 && y > HEADROOM && y < height - 40) return;
    this.#move({ ...this.#camera, x: point.x, y: point.y });
  }

  /** Puts a world point into the middle, large enough to see a disk of the radius there (metres). */
  centre({ x, y }, radius) {
    const { max } = this.#scaleLimits();
    const scale = Math.max(this.#camera.scale, Math.min(max, LEGIBLE / radius));
    this.#move({ x, y, scale });
  }

  /** Shows some disks ({x, y, radius}, metres) together, in the middle and large enough to tell them apart. */
  frame(disks) {
    if (disks.length === 0) return;
    const least = Math.min(...disks.map(({ radius }) => radius));
    const room = 4 * Math.max(...disks.map(({ radius }) => radius));
    const [xs, ys] = ["x", "y"].map((axis) => disks.map((disk) => disk[axis]));
    const bounds = {
      left: Math.min(...xs) - room,
      right: Math.max(...xs) + room,
      bottom: Math.min(...ys) - room,
      top: Math.max(...ys) + room,
    };
    const camera = this.#cameraFor(bounds);
    const { min, max } = this.#scaleLimits();
    const scale = Math.max(min, Math.min(camera.scale, max, FRAMED / least));
    const middle = { x: (bounds.left + bounds.right) / 2, y: (bounds.bottom + bounds.top) / 2 };
    this.#move({ ...middle, scale });
  }

  /** Puts a world point into the middle, by hand. */
  moveTo({ x, y }) {
    this.#move({ ...this.#camera, x, y });
    this.#signals.emit("pan");
  }

  /** Calls `listener` when the camera is moved by hand. */
  onPan(listener) {
    this.#signals.on("pan", listener);
  }

  /** Calls `listener` with the point of the world at the pointer, or that was touched; null: the pointer has left. */
  onPoint(listener) {
    this.#signals.on("point", listener);
  }

  /** The world point in the middle of the view. */
  get middle() {
    return { x: this.#camera.x, y: this.#camera.y };
  }

  /** Where a disk of the world is on the canvas: {x, y, radius}, CSS pixels. */
  screenOf(point, radius) {
    return { ...toScreen(this.#camera, this.#viewport, point), radius: radius * this.#camera.scale };
  }

  /** The id of the robot whose disk, now, is at a world point, the nearest if there are several, or null. */
  robotAt(world) {
    return this.diskAt(world)?.robot.id ?? null;
  }

  /**
   * The robot whose disk, now or put at placeOf(robot) ({x, y} or null), is at a world point, the nearest:
   * {robot, place}, or null.
   */
  diskAt(world, placeOf = (robot) => this.#poseNow(robot)) {
    let found = null;
    let nearest = Infinity;
    for (const robot of this.#session.scene.robots) {
      const place = placeOf(robot);
      const distance = place ? Math.hypot(place.x - world.x, place.y - world.y) : Infinity;
      if (distance > this.reach(robot.radius) || distance >= nearest) continue;
      nearest = distance;
      found = { robot, place };
    }
    return found;
  }

  #poseNow(robot) {
    const { tracks, player } = this.#session;
    return robotPoseAt(robot, tracks.get(robot.id), player.time);
  }

  /** The distance from the centre of a disk of this radius within which a pointer picks it, metres. */
  reach(radius) {
    return Math.max(radius, REACH[this.#pointer] / this.#camera.scale);
  }

  /** Paints with the next frame. */
  redraw() {
    if (this.#scheduled) return;
    this.#scheduled = true;
    requestAnimationFrame(() => this.#scheduled && this.paint());
  }

  /** Paints at once, with so many pixels a CSS pixel. */
  paint(ratio = window.devicePixelRatio || 1) {
    this.#scheduled = false;
    const { player, marked } = this.#session;
    this.#painter.paint({
      camera: this.#camera,
      viewport: this.#viewport,
      ratio,
      time: player.time,
      marked,
      moving: this.#rest !== undefined,
      overlays: this.#tool.paint ? [...this.#overlays, this.#tool.paint.bind(this.#tool)] : this.#overlays,
    });
  }

  #show() {
    const { scene, tracks } = this.#session;
    this.#painter.show(scene, tracks, this.#colours.theme, this.#look);
    this.redraw();
  }

  /**
   * Gestures on a canvas of the stage's size (see watchGestures). They move the camera and select robots.
   * `robotAt(world)` returns the id of the robot there, or null.
   */
  cameraGestures(canvas, robotAt) {
    const world = (pixel) => toWorld(this.#camera, this.#viewport, pixel);
    return {
      pan: (dx, dy, isSwipe) => (isSwipe && this.#seesAll) || this.#pan(dx, dy),
      zoom: (pixel, factor) => this.#zoom(pixel, factor),
      hover: (pixel) => {
        this.#pointer = "mouse"; // fingers do not hover
        const id = pixel && robotAt(world(pixel));
        canvas.classList.toggle("on-robot", id !== null);
        this.#session.hover(id);
      },
      click: (pixel, event) => this.#click(robotAt(world(pixel)), event),
      press: (_, event) => {
        this.#pointer = pointerOf(event);
        return false;
      },
    };
  }

  #gestures() {
    const world = (pixel) => toWorld(this.#camera, this.#viewport, pixel);
    const ofCamera = this.cameraGestures(this.#canvas, (point) => this.robotAt(point));
    return {
      ...ofCamera,
      hover: (pixel) => {
        this.#showHover(pixel && world(pixel));
        this.#signals.emit("point", pixel && world(pixel));
        ofCamera.hover(pixel);
      },
      press: (pixel, event) => {
        this.#pointer = pointerOf(event);
        if (event.pointerType !== "mouse") this.#signals.emit("point", world(pixel));
        const tools = [this.#tool, this.#baseTool];
        const taker = tools.find((tool) => tool.press?.(world(pixel), event) ?? false);
        this.#pressed = taker ?? {};
        const taken = taker !== undefined;
        if (taken) this.#session.hover(null); // a drag does not highlight the robots below it
        return taken;
      },
      drag: (pixel, event) => this.#pressed.drag?.(world(pixel), event),
      release: (pixel, event) => this.#pressed.release?.(world(pixel), event),
      abort: () => this.#pressed.abort?.(),
    };
  }

  #click(id, { ctrlKey, metaKey }) {
    if (!ctrlKey && !metaKey) this.#session.toggle(id);
    else if (id !== null) this.#session.toggleChosen(id);
  }

  #showHover(world) {
    this.#canvas.style.cursor = (world && this.#tool.cursor?.(world)) ?? "";
    this.#tool.hover?.(world);
  }

  #resize() {
    const box = this.#canvas.getBoundingClientRect();
    const before = toWorld(this.#camera, this.#viewport, this.#middle());
    this.#viewport = { width: box.width, height: box.height };
    this.#beside = byId("fit").parentElement.offsetWidth + 2 * MARGIN;
    if (this.#fitted) this.#fit();
    else this.#move({ ...this.#camera, ...before });
    this.paint();
  }

  #middle() {
    return { x: this.#viewport.width / 2, y: this.#viewport.height / 2 };
  }

  /** The camera that shows all of the bounds, below the view's buttons or beside them, where they are larger. */
  #cameraFor(bounds) {
    const margin = Math.min(MARGIN, this.#viewport.width * 0.03);
    const around = { left: margin, right: margin, bottom: FOOTROOM, top: margin };
    const below = fit(bounds, this.#viewport, { ...around, top: HEADROOM });
    const beside = fit(bounds, this.#viewport, { ...around, right: this.#beside });
    return beside.scale > below.scale ? beside : below;
  }

  /** Whether the whole map is in sight: there is nothing to swipe to. */
  get #seesAll() {
    const { left, right, bottom, top } = this.#bounds();
    const [a, b] = [
      { x: left, y: top },
      { x: right, y: bottom },
    ].map((corner) => toScreen(this.#camera, this.#viewport, corner));
    return a.x >= 0 && a.y >= 0 && b.x <= this.#viewport.width && b.y <= this.#viewport.height;
  }

  /** Lets a finger scroll the page where the scene has no use for that. */
  #offerSwipes() {
    this.#canvas.style.touchAction = this.#seesAll && !this.#tool.press ? "pan-y" : "none";
  }

  #bounds() {
    return this.#session.scene.grid?.bounds ?? NOWHERE;
  }

  #move(camera) {
    this.#fitted = false;
    this.#camera = keepInSight(camera, this.#bounds());
    this.#offerSwipes();
    clearTimeout(this.#rest);
    this.#rest = setTimeout(() => {
      this.#rest = undefined;
      this.redraw();
    }, REST_MS);
    this.redraw();
  }

  #pan(dx, dy) {
    this.#move(panBy(this.#camera, dx, dy));
    this.#signals.emit("pan");
  }

  #zoom(pixel, factor) {
    this.#move(zoomAt(this.#camera, this.#viewport, pixel, factor, this.#scaleLimits()));
  }

  #scaleLimits() {
    const cell = this.#session.scene.grid?.resolution ?? 1;
    return scaleLimits(this.#cameraFor(this.#bounds()).scale, cell);
  }

  #onKey(event) {
    if (this.#tool.key?.(event)) {
      event.preventDefault();
      return;
    }
    const steps = { ArrowLeft: [1, 0], ArrowRight: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
    const step = steps[event.key];
    if (!step || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    this.#pan(step[0] * KEY_PAN, step[1] * KEY_PAN);
  }
}

const pointerOf = ({ pointerType }) => (pointerType === "touch" ? "touch" : "mouse");
