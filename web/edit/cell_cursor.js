// The cell that a tool works on: under the mouse, or moved by the arrow keys.

import { cellAt, centreOf, isInside } from "../model/cells.js";

/** @import {Cell} from "../model/types.js" */

const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

export class CellCursor {
  #session;
  #stage;
  /** @type {Cell | null} */
  #cell = null;
  #shown = false;

  constructor(session, stage) {
    this.#session = session;
    this.#stage = stage;
  }

  /**
   * The cell, within the map; null without a map.
   * @returns {Cell | null}
   */
  get cell() {
    const { grid } = this.#session.scene;
    if (grid === null) return null;
    const { column, row } = this.#cell ?? cellAt(grid, this.#stage.middle);
    return {
      column: Math.min(grid.columns - 1, Math.max(0, column)),
      row: Math.min(grid.rows - 1, Math.max(0, row)),
    };
  }

  /** Whether the mouse is at the cell, or keys move it. */
  get isSeen() {
    return this.cell !== null && (this.#shown || document.activeElement === this.#stage.canvas);
  }

  /** The mouse is at a world point, or has left (null). */
  hover(world) {
    const { grid } = this.#session.scene;
    const cell = world && grid && cellAt(grid, world);
    this.#shown = cell !== null && isInside(grid, cell);
    if (this.#shown) this.#cell = cell;
    this.#stage.redraw();
  }

  /** Moves it if an arrow key was pressed; returns whether it did. */
  key({ key, ctrlKey, metaKey, altKey }) {
    if (!(key in ARROWS) || ctrlKey || metaKey || altKey || this.cell === null) return false;
    const [right, down] = ARROWS[key];
    const { column, row } = this.cell;
    this.#cell = { column: column + right, row: row + down };
    this.#cell = this.cell;
    this.#stage.reveal(centreOf(this.#session.scene.grid, this.#cell));
    this.#stage.redraw();
    return true;
  }

  /**
   * Paints a frame around the cell and, if given, all up to `other`; `sign`: "add" or "remove".
   * @param {{other?: Cell | null, sign: string}} frame
   */
  paint(context, { scale, screen, theme }, frame) {
    const { other = null, sign } = frame;
    const { cell } = this;
    if (cell === null || (!this.isSeen && other === null)) return;
    const { grid } = this.#session.scene;
    const end = other ?? cell;
    const half = (grid.resolution * scale) / 2;
    const [a, b] = [screen(centreOf(grid, cell)), screen(centreOf(grid, end))];
    const [left, top] = [Math.min(a.x, b.x) - half, Math.min(a.y, b.y) - half];
    const [width, height] = [Math.abs(a.x - b.x) + 2 * half, Math.abs(a.y - b.y) + 2 * half];
    context.save();
    context.fillStyle = context.strokeStyle = theme.accent;
    context.lineWidth = 2;
    context.strokeRect(left, top, width, height);
    context.globalAlpha = 0.14;
    context.fillRect(left, top, width, height);
    context.globalAlpha = 1;
    paintSign(context, left + width / 2, top + height / 2, Math.min(half * 0.5, 7), sign);
    context.restore();
  }
}

/** A plus or a minus. */
function paintSign(context, x, y, arm, sign) {
  if (arm < 2) return;
  context.beginPath();
  context.moveTo(x - arm, y);
  context.lineTo(x + arm, y);
  if (sign === "add") {
    context.moveTo(x, y - arm);
    context.lineTo(x, y + arm);
  }
  context.stroke();
}
