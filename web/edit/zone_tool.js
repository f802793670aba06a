// The tool that draws zones and moves their corners, by mouse, finger and keys.

import { tidy } from "../model/cells.js";
import {
  addZone,
  cornersOf,
  deleteZone,
  insertCorner,
  moveCorner,
  moveZone,
  removeCorner,
} from "../model/edit_zones.js";
import { zonesOf } from "../model/listed.js";
import { ARROWS, snapPoint } from "../model/placement.js";
import { isInPolygon } from "../model/polygon.js";
import { drawPath, ring } from "../scene/marks.js";
import { reachOf } from "./handles.js";

const CORNER = 5; // pixels, radii of the handles
const MIDDLE = 3.5;

let gestures = 0; // for unique names

export class ZoneTool {
  help = "Drag from corner to corner to draw a zone; drag its corners and sides.";
  keys = "Alt: no snapping. Enter: a new zone; then arrows move it, with Shift its last corner. Del: delete.";

  #session;
  #stage;
  #choice;
  /** @type {any} */
  #drag = null; // {corner (its number, or null for a new zone), from, to, gesture}

  /** `choice`: see ZoneChoice. */
  constructor(session, stage, choice) {
    this.#session = session;
    this.#stage = stage;
    this.#choice = choice;
    choice.onChange(() => stage.redraw());
  }

  press(world, event) {
    gestures += 1;
    const gesture = `zone ${gestures}`;
    const handle = this.#handleAt(world, event);
    if (handle === null) {
      const from = this.#snapped(world, event);
      this.#drag = { corner: null, from, to: from, gesture };
      return true;
    }
    this.#drag = { corner: handle.corner, gesture };
    if (handle.isMiddle) {
      this.#edit((request, index) => insertCorner(request, index, handle.corner, handle.place));
      this.#drag.corner += 1;
    }
    return true;
  }

  drag(world, event) {
    const point = this.#snapped(world, event);
    const { corner } = this.#drag;
    if (corner === null) this.#drag.to = point;
    else this.#edit((request, index) => moveCorner(request, index, corner, point));
    this.#stage.redraw();
  }

  release(world, event) {
    const { corner, from, to } = this.#drag;
    if (corner === null && from.x !== to.x && from.y !== to.y) this.#add(from, to);
    else if (corner === null) this.#choice.choose(this.#zoneAt(world));
    else if (event.altKey && event.shiftKey)
      this.#edit((request, index) => removeCorner(request, index, corner));
    this.abort();
  }

  abort() {
    this.#drag = null;
    this.#session.endGesture();
    this.#stage.redraw();
  }

  cursor(world) {
    return this.#handleAt(world, null) === null ? "crosshair" : "move";
  }

  key(event) {
    if (event.key === "Enter") this.#addInMiddle();
    else if (this.#choice.index === null) return false;
    else if (event.key in ARROWS) this.#step(event);
    else if (event.key === "Delete" || event.key === "Backspace") this.#delete();
    else return false;
    return true;
  }

  paint(context, view) {
    const { screen, theme } = view;
    if (this.#drag?.corner === null) {
      const { from, to } = this.#drag;
      const box = [from, { x: to.x, y: from.y }, to, { x: from.x, y: to.y }, from];
      drawPath(context, box.map(screen), theme.accent, { width: 2, alpha: 1, dashes: [6, 4] });
    }
    for (const { place, isMiddle } of this.#handles()) {
      const radius = isMiddle ? MIDDLE : CORNER;
      context.beginPath();
      context.fillStyle = isMiddle ? theme.floor : theme.accent;
      const { x, y } = screen(place);
      context.arc(x, y, radius, 0, 2 * Math.PI);
      context.fill();
      ring(context, { x, y }, radius, theme.accent, { width: 2, alpha: 1, dashes: [] });
    }
  }

  #add(from, to) {
    this.#session.edit(addZone(this.#session.request, from, to));
    this.#choice.choose(zonesOf(this.#session.request).length - 1);
    this.#session.announce(`${this.#choice.zone.id} drawn; it is blocked.`);
  }

  #addInMiddle() {
    const size = this.#cell;
    const { x, y } = this.#onCorner(this.#stage.middle);
    this.#add({ x: tidy(x - size), y: tidy(y - size) }, { x: tidy(x + size), y: tidy(y + size) });
  }

  #step(event) {
    const { right, up } = ARROWS[event.key];
    const size = this.#cell * (event.altKey ? 0.1 : 1);
    const by = { x: right * size, y: up * size };
    if (!event.repeat) gestures += 1;
    this.#drag = { gesture: `zone ${gestures}` };
    if (event.shiftKey) this.#stretch(by);
    else this.#edit((request, index) => moveZone(request, index, by));
    this.#drag = null;
  }

  /** Moves the corner across from the first one. For a rectangle, also moves the corners beside it. */
  #stretch(by) {
    const corners = cornersOf(this.#choice.zone);
    const far = Math.floor(corners.length / 2);
    corners.forEach((corner, at) => {
      const x = corner.x === corners[far].x && corner.x !== corners[0].x ? corner.x + by.x : corner.x;
      const y = corner.y === corners[far].y && corner.y !== corners[0].y ? corner.y + by.y : corner.y;
      this.#edit((request, index) => moveCorner(request, index, at, { x: tidy(x), y: tidy(y) }));
    });
  }

  #delete() {
    const { id } = this.#choice.zone;
    this.#edit(deleteZone);
    this.#choice.choose(null);
    this.#session.announce(`${id} deleted.`);
  }

  /** Edits the chosen zone, with the gesture under way if there is one. */
  #edit(change) {
    const { index } = this.#choice;
    if (index !== null) this.#session.edit(change(this.#session.request, index), this.#drag?.gesture ?? null);
  }

  get #cell() {
    return this.#session.scene.grid?.resolution ?? 1;
  }

  #snapped(world, event) {
    return event.altKey ? snapPoint(this.#session.scene.grid, world, true) : this.#onCorner(world);
  }

  /** The nearest corner of a cell. */
  #onCorner({ x, y }) {
    const { origin } = this.#session.scene.grid ?? { origin: { x: 0, y: 0 } };
    const nearest = (value, zero) => tidy(zero + Math.round((value - zero) / this.#cell) * this.#cell);
    return { x: nearest(x, origin.x), y: nearest(y, origin.y) };
  }

  /** The corners of the chosen zone, and the middles of its sides: [{corner, isMiddle, place}]. */
  #handles() {
    const corners = cornersOf(this.#choice.zone);
    return corners.flatMap((place, corner) => {
      const next = corners[(corner + 1) % corners.length];
      const middle = { x: (place.x + next.x) / 2, y: (place.y + next.y) / 2 };
      return [
        { corner, isMiddle: false, place },
        { corner, isMiddle: true, place: middle },
      ];
    });
  }

  #handleAt(world, event) {
    const reach = reachOf(event, this.#stage.scale);
    const near = this.#handles().filter(
      ({ place }) => Math.hypot(place.x - world.x, place.y - world.y) <= reach,
    );
    return near.find(({ isMiddle }) => !isMiddle) ?? near[0] ?? null;
  }

  /** The last zone that a point is in, or null. */
  #zoneAt(world) {
    const found = zonesOf(this.#session.request).findLastIndex((zone) => isInPolygon(world, cornersOf(zone)));
    return found < 0 ? null : found;
  }
}
