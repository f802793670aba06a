// Where a robot may be asked to go: its disk touches no wall and no zone that is blocked for it. Pure. Metres.

import { maskOf } from "./drawn_map.js";
import { cornersOf } from "./edit_zones.js";
import { nextTask } from "./latest.js";
import { CONTACT, nearestFreePlace } from "./placement.js";
import { distanceToPolygon } from "./polygon.js";
import { OCCUPIED, zonesFor } from "./zones.js";

/** @import {Grid, Position, Robot} from "./types.js" */

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
    return drawn !== null && isOn(drawn, grid) ? [drawn] : [];
  });
  let { blocked } = grid;
  for (const { percents } of masks) {
    blocked = blocked.map((wall, at) => wall | Number(percents[at] >= OCCUPIED));
    await nextTask();
  }
  const polygons = walls.map(cornersOf).filter((corners) => corners.length > 0);
  return new Room({ ...grid, blocked }, radius, polygons);
}

const isOn = (mask, { columns, rows }) => mask.columns === columns && mask.rows === rows;

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
