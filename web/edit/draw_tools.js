// The tools that turn cells into walls or floor: freehand and as rectangles.

import { cellAt, cellsAlong, cellsBetween, isFree } from "../model/cells.js";
import { setCells } from "../model/edit_request.js";
import { count } from "../ui/format.js";
import { CellCursor } from "./cell_cursor.js";

/** @import {Cell} from "../model/types.js" */

const NO_MAP = "There is no map to draw on: create one under New map.";

let strokes = 0; // for unique names

/** Turns cells into walls, or floor, along a stroke. */
export class DrawTool {
  help;
  keys = "Keyboard: arrows and Enter; with Shift, a line.";
  #session;
  #cursor;
  #blocked;
  #last = null; // the last point of the stroke
  /** @type {string | null} */
  #gesture = null;

  /** `blocked`: whether it makes walls. */
  constructor(session, stage, blocked) {
    this.#session = session;
    this.#cursor = new CellCursor(session, stage);
    this.#blocked = blocked;
    const what = blocked ? "walls" : "free floor";
    this.help = `Drag to draw ${what}.`;
  }

  press(world) {
    if (this.#session.scene.grid === null) this.#session.announce(NO_MAP);
    strokes += 1;
    this.#gesture = `stroke ${strokes}`;
    this.#last = world;
    return true;
  }

  drag(world) {
    const { grid } = this.#session.scene;
    if (grid) this.#set(cellsAlong(grid, this.#last, world), this.#gesture);
    this.#last = world;
    this.#cursor.hover(world);
  }

  release(world) {
    this.drag(world);
    this.abort();
  }

  abort() {
    this.#session.endGesture();
  }

  hover(world) {
    this.#cursor.hover(world);
  }

  cursor() {
    return "crosshair";
  }

  paint(context, view) {
    this.#cursor.paint(context, view, { sign: this.#blocked ? "add" : "remove" });
  }

  key(event) {
    const { cell } = this.#cursor;
    if (cell === null) return false;
    if (event.key === "Enter" || event.key === " ") {
      this.#set([cell]);
    } else if (this.#cursor.key(event)) {
      if (event.shiftKey) this.#set([cell, this.#cursor.cell]);
    } else {
      return false;
    }
    this.#announceCell();
    return true;
  }

  /** @param {string | null} gesture */
  #set(cells, gesture = null) {
    const { request, scene } = this.#session;
    this.#session.edit(setCells(request, cells, this.#blocked, scene.grid), gesture);
  }

  #announceCell() {
    const cell = /** @type {Cell} */ (this.#cursor.cell);
    const state = isFree(this.#session.scene.grid, cell) ? "free" : "wall";
    this.#session.announce(`Column ${cell.column + 1}, row ${cell.row + 1} from the top: ${state}.`);
  }
}

/** Fills the rectangle between two corners with walls or, with Alt, with floor. */
export class BoxTool {
  help = "Drag from corner to corner to fill a box with walls.";
  keys = "Alt: erase. Keyboard: arrows, and Enter at both corners.";

  #session;
  #cursor;
  /** @type {Cell | null} */
  #corner = null;
  #frees = false;

  constructor(session, stage) {
    this.#session = session;
    this.#cursor = new CellCursor(session, stage);
    session.on("request", () => (this.#corner = null));
  }

  press(world) {
    const { grid } = this.#session.scene;
    if (grid === null) this.#session.announce(NO_MAP);
    this.#corner = grid && cellAt(grid, world);
    return true;
  }

  drag(world, event) {
    this.#frees = event.altKey;
    this.#cursor.hover(world);
  }

  release(world, event) {
    this.drag(world, event);
    const { grid } = this.#session.scene;
    if (grid && this.#corner) this.#fill(cellAt(grid, world), event.altKey);
    this.abort();
  }

  abort() {
    this.#corner = null;
    this.#frees = false;
  }

  hover(world) {
    this.#cursor.hover(world);
  }

  cursor() {
    return "crosshair";
  }

  paint(context, view) {
    this.#cursor.paint(context, view, { other: this.#corner, sign: this.#frees ? "remove" : "add" });
  }

  key(event) {
    const { cell } = this.#cursor;
    if (cell === null) return false;
    if (event.key === "Escape" && this.#corner) {
      this.abort();
      return true;
    }
    if (event.key !== "Enter" && event.key !== " ") return this.#moved(event);
    if (this.#corner) {
      this.#fill(cell, event.altKey);
      this.abort();
    } else {
      this.#corner = cell;
      this.#session.announce("First corner set.");
    }
    return true;
  }

  #moved(event) {
    if (!this.#cursor.key(event)) return false;
    const { column, row } = /** @type {Cell} */ (this.#cursor.cell);
    this.#session.announce(`Column ${column + 1}, row ${row + 1} from the top.`);
    return true;
  }

  #fill(cell, frees) {
    const { request, scene } = this.#session;
    const cells = cellsBetween(scene.grid, this.#corner, cell);
    this.#session.edit(setCells(request, cells, !frees, scene.grid));
    this.#session.announce(`${count(cells.length, "cell")} made ${frees ? "free" : "wall"}.`);
  }
}
