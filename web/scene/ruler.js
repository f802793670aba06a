// The ruler: the distance and heading from one point to another. By mouse or finger, drag from point to point. By keys,
// arrows move the end by a cell, or with Alt by a tenth of a cell. Enter moves the start to the end.

import { cellAt, centreOf } from "../model/cells.js";
import { ARROWS } from "../model/placement.js";
import { wayBetween } from "../model/scale.js";
import { byId } from "../ui/dom.js";
import { drawPath, drawTag, ring } from "./marks.js";

const FINE = 0.1; // of a cell
const HELP = "Ruler: drag from point to point, or use arrows and Enter; Escape ends it.";

export class Ruler {
  #session;
  #stage;
  #button = byId("ruler");
  #on = false;
  /** @type {any} */
  #from = null; // {x, y}, metres
  /** @type {any} */
  #to = null;

  constructor(session, stage) {
    this.#session = session;
    this.#stage = stage;
    this.#button.addEventListener("click", () => this.toggle());
    session.on("request", ({ opened }) => opened && this.#set(false));
    session.on("planning", () => session.planning !== null && this.#set(false));
  }

  toggle() {
    this.#set(!this.#on);
    if (!this.#on) return;
    this.#stage.canvas.focus();
    this.#session.announce(HELP);
  }

  #set(on) {
    this.#on = on;
    this.#from = this.#to = null;
    this.#button.setAttribute("aria-pressed", String(on));
    this.#stage.lendTool(on ? this : null);
  }

  press(world) {
    this.#from = this.#to = this.#snapped(world);
    return true;
  }

  drag(world) {
    this.#to = this.#snapped(world);
    this.#stage.redraw();
  }

  release(world) {
    this.drag(world);
    if (wayBetween(this.#from, this.#to).distance === 0) this.#from = this.#to = null;
    else this.#session.announce(this.#words());
  }

  abort() {
    this.#from = this.#to = null;
    this.#stage.redraw();
  }

  cursor() {
    return "crosshair";
  }

  key(event) {
    if (event.key === "Escape") {
      this.#set(false);
      return true;
    }
    const arrow = ARROWS[event.key];
    if (!arrow && event.key !== "Enter") return false;
    this.#begin();
    if (arrow) this.#step(arrow, event.altKey);
    else this.#from = this.#to;
    this.#stage.reveal(this.#to);
    this.#stage.redraw();
    this.#session.announce(this.#words());
    return true;
  }

  paint(context, { screen, theme }) {
    if (this.#from === null) return;
    const [a, b] = [screen(this.#from), screen(this.#to)];
    drawPath(context, [a, b], theme.floor, { width: 5, alpha: 0.8 });
    drawPath(context, [a, b], theme.accent, { width: 2, alpha: 1 });
    for (const end of [a, b]) ring(context, end, 4, theme.accent, { width: 2, alpha: 1, dashes: [] });
    drawTag(context, theme, { x: (a.x + b.x) / 2, y: (a.y + b.y) / 2 - 16 }, this.#words());
  }

  /** Begins at the selected robot, or in the middle of the view. */
  #begin() {
    if (this.#from !== null) return;
    const { selected, scene } = this.#session;
    const { middle } = this.#stage;
    const place =
      this.#session.poseOf(selected) ?? (scene.grid && centreOf(scene.grid, cellAt(scene.grid, middle)));
    const { x, y } = place ?? middle;
    this.#from = this.#to = { x, y };
  }

  #step({ right, up }, fine) {
    const cell = (this.#session.scene.grid?.resolution ?? 1) * (fine ? FINE : 1);
    this.#to = { x: this.#to.x + right * cell, y: this.#to.y + up * cell };
  }

  /** The centre of a robot, or of a goal, that is at the point; else the point. */
  #snapped(world) {
    const { x, y } =
      (this.#stage.diskAt(world) ?? this.#stage.diskAt(world, (robot) => robot.goal))?.place ?? world;
    return { x, y };
  }

  #words() {
    const { distance, heading, across, up } = wayBetween(this.#from, this.#to);
    return `${distance.toFixed(3)} m at ${heading.toFixed(1)}° (${across.toFixed(2)}, ${up.toFixed(2)})`;
  }
}
