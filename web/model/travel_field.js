// How long a robot takes to the squares of a map, which are known from coarse to fine. Pure. Metres, seconds.

import { ticks } from "./gantt.js";

/** @import {Grid, Position} from "./types.js" */

const MAX_SQUARES = 10_000;
const STRIDES = [8, 4, 2, 1]; // squares from one to the next that is asked for, from coarse to fine
const NO_ROOM = -1;
const MAX_BANDS = 7;

/** The bands of times up to `most`: {step, count}, each `step` long, from 0. */
export function bandsUpTo(most) {
  const { step } = ticks({ from: 0, to: most }, MAX_BANDS);
  return { step, count: Math.max(1, Math.ceil(most / step - 1e-9)) };
}

/** The number of a band among so many, from 0 to MAX_BANDS - 1: the first and the last colour always occur. */
export function shadeOf(band, count) {
  return count === 1 ? 0 : Math.round((band * (MAX_BANDS - 1)) / (count - 1));
}

/** The band of a time, from 0. */
export const bandOf = (seconds, { step, count }) => Math.min(count - 1, Math.floor(seconds / step));

/** How many cells are along a side of a square, so that there are not too many squares. */
function cellsOfSquares({ columns, rows }) {
  let cells = 1;
  while (Math.ceil(columns / cells) * Math.ceil(rows / cells) > MAX_SQUARES) cells += 1;
  return cells;
}

export class TravelField {
  cells; // along a side of a square
  size; // of a square
  columns;
  rows;
  most = 0; // of the times that are known
  hasTimes = false; // whether anything is known but where the robot does not fit
  hasNoWay = false; // whether there are squares without a way
  known = 0; // squares
  #bounds;
  #seconds; // row by row from the top: NaN: not known, Infinity: no way, NO_ROOM: the robot fits nowhere in it

  /** @param {Grid} grid */
  constructor(grid) {
    this.cells = cellsOfSquares(grid);
    this.size = this.cells * grid.resolution;
    this.columns = Math.ceil(grid.columns / this.cells);
    this.rows = Math.ceil(grid.rows / this.cells);
    this.#bounds = grid.bounds;
    this.#seconds = new Float32Array(this.columns * this.rows).fill(NaN);
  }

  get count() {
    return this.#seconds.length;
  }

  /** The numbers of all squares, in steps. Each step is spread over the map and finer than the previous step. */
  *squares() {
    const had = new Uint8Array(this.count);
    for (const stride of STRIDES) {
      const first = Math.floor(stride / 2);
      for (let row = first; row < this.rows; row += stride) {
        for (let column = first; column < this.columns; column += stride) {
          const at = row * this.columns + column;
          if (had[at] === 0) yield at;
          had[at] = 1;
        }
      }
    }
  }

  /** The middle of a square, or of its part that is on the map. */
  middleOf(at) {
    const { left, right, top, bottom } = this.#bounds;
    const x = left + (at % this.columns) * this.size;
    const y = top - Math.floor(at / this.columns) * this.size;
    return { x: (x + Math.min(right, x + this.size)) / 2, y: (y + Math.max(bottom, y - this.size)) / 2 };
  }

  /**
   * Takes note of how long the robot takes to a square; null: there is no way.
   * @param {number | null} seconds
   */
  set(at, seconds) {
    this.#note(at, seconds ?? Infinity);
    this.hasTimes = true;
    if (seconds === null) this.hasNoWay = true;
    else this.most = Math.max(this.most, seconds);
  }

  /** Takes note of a square in which the robot fits nowhere. */
  setNoRoom(at) {
    this.#note(at, NO_ROOM);
  }

  #note(at, value) {
    this.#seconds[at] = value;
    this.known += 1;
  }

  /**
   * How long the robot takes to a square: {seconds, isNear}. Infinity if there is no way. `isNear`: the time is for
   * another square nearby, because its own time is not known. Null if the robot fits nowhere in the square, or if
   * nothing is known.
   */
  timeTo(column, row) {
    for (const stride of [...STRIDES].reverse()) {
      const [across, down] = [column, row].map((place) => place - (place % stride) + Math.floor(stride / 2));
      if (across >= this.columns || down >= this.rows) continue;
      const seconds = this.#seconds[down * this.columns + across];
      if (seconds >= 0) return { seconds, isNear: stride > 1 };
      if (stride === 1 && seconds === NO_ROOM) return null;
    }
    return null;
  }

  /**
   * How long the robot takes to a point, see timeTo; null also outside of the map.
   * @param {Position} point
   */
  timeAt({ x, y }) {
    const { left, right, top, bottom } = this.#bounds;
    if (x < left || x >= right || y <= bottom || y > top) return null;
    return this.timeTo(Math.floor((x - left) / this.size), Math.floor((top - y) / this.size));
  }
}
