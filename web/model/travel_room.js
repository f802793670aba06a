// Where a robot may be asked to go: its disk touches no wall and no zone that is blocked for it. Pure. Metres.

import { maskOf } from "./drawn_map.js";
import { cornersOf } from "./edit_zones.js";
import { nextTask } from "./latest.js";
import { CONTACT, nearestFreePlace } from "./placement.js";
import { distanceToPolygon } from "./polygon.js";
import { isOnMap, OCCUPIED, zonesFor } from "./zones.js";

/** @import {Grid, Position, Robot} from "./types.js" */

const ON_BORDER = 1e-6; // cells: so near to a border is on it
const PIECE = 200_000; // cells that are looked at in one go

/**
 * The room of a robot. Zones that are only not entered do not take any.
 * @param {Grid} grid
 * @param {Robot} robot
 */
export async function roomOf(request, grid, robot) {
  const { id, radius } = robot;
  const walls = zonesFor(request, id).filter(({ type, enter }) => type === "blocked" && enter !== false);
  const masks = walls.flatMap(({ mask }) => {
    const drawn = maskOf(mask);
    return drawn !== null && isOnMap(drawn, grid) ? [drawn] : [];
  });
  let { blocked } = grid;
  for (const mask of masks) {
    blocked = mask.isFramed ? withCellsUnder(mask, grid, blocked) : withCells(mask, blocked);
    await nextTask();
  }
  const polygons = walls.map(cornersOf).filter((corners) => corners.length > 0);
  return new Room({ ...grid, blocked }, radius, polygons);
}

const withCells = ({ percents }, blocked) =>
  blocked.map((wall, at) => wall | Number(percents[at] >= OCCUPIED));

/** With the cells of the map that an occupied cell of a mask in a frame of its own overlaps. */
function withCellsUnder(mask, grid, blocked) {
  const made = blocked.slice();
  const cells = (from, to, most) => [
    Math.max(0, Math.floor(from / grid.resolution + ON_BORDER)),
    Math.min(most, Math.ceil(to / grid.resolution - ON_BORDER)),
  ];
  mask.percents.forEach((percent, at) => {
    if (percent < OCCUPIED) return;
    const left = mask.bounds.left + (at % mask.columns) * mask.resolution - grid.bounds.left;
    const top = grid.bounds.top - (mask.bounds.top - Math.floor(at / mask.columns) * mask.resolution);
    const [first, last] = cells(left, left + mask.resolution, grid.columns);
    const [highest, lowest] = cells(top, top + mask.resolution, grid.rows);
    for (let row = highest; row < lowest; row += 1)
      made.fill(1, row * grid.columns + first, row * grid.columns + Math.max(first, last));
  });
  return made;
}

class Room {
  #grid;
  #radius;
  #polygons;

  constructor(grid, radius, polygons) {
    this.#grid = grid;
    this.#radius = radius;
    this.#polygons = polygons;
  }

  /**
   * A place for each square of a field in which there is one, {at, place}, from coarse to fine. Takes note of the other
   * squares.
   * @param {import("./travel_field.js").TravelField} field
   */
  async *placesIn(field) {
    const across = (2 * this.#radius) / this.#grid.resolution + 1; // cells that a disk may touch, in a row
    const piece = Math.max(1, Math.floor(PIECE / (field.cells * across) ** 2));
    let looked = 0;
    for (const at of field.squares()) {
      const place = this.#placeNear(field.middleOf(at), field.size / 2);
      if (place === null) field.setNoRoom(at);
      else yield { at, place };
      looked += 1;
      if (looked % piece === 0) await nextTask();
    }
  }

  /**
   * @param {Position} point
   * @returns {Position | null}
   */
  #placeNear(point, within) {
    const place = nearestFreePlace(this.#grid, point, this.#radius, [], 0, within);
    const isClear = (corners) => distanceToPolygon(place, corners) >= this.#radius - CONTACT;
    return place !== null && this.#polygons.every(isClear) ? place : null;
  }
}
