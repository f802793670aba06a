// The zones of a request, as they are drawn. Faulty zones are left out. Pure. Metres.

import { maskOf } from "./drawn_map.js";
import { zonesOf } from "./listed.js";

/** @import {Grid, Zone} from "./types.js" */

const TYPES = ["blocked", "speed", "one_way"];

/** From how many percent on a cell of a mask is blocked, as in the service. */
export const OCCUPIED = 65;

/**
 * `grid`: the grid of the map, which masks lie on, or null.
 * @param {Grid | null} grid
 * @returns {Zone[]}
 */
export function readZones(request, grid = null) {
  return zonesOf(request)
    .map((zone) => (isDrawable(zone) ? polygonZone(zone) : maskZone(zone, grid)))
    .filter((zone) => zone !== null);
}

/** The zones of a request that are for a robot. */
export const zonesFor = (request, id) =>
  zonesOf(request).filter(
    (zone) => isObject(zone) && (!Array.isArray(zone.robots) || zone.robots.includes(id)),
  );

const isObject = (value) => value !== null && typeof value === "object";

function polygonZone(zone) {
  return {
    type: zone.type,
    polygon: zone.polygon.map(({ x, y }) => ({ x, y })),
    mask: null,
    bounds: null,
    middle: middleOf(zone.polygon),
    heading: zone.type === "one_way" && Number.isFinite(zone.heading) ? zone.heading : null,
    label: labelOf(zone),
  };
}

/** Whether a mask lies on the map: in a frame of its own, or with a pixel for each of its cells. */
export const isOnMap = (mask, grid) =>
  grid !== null && (mask.isFramed || (mask.columns === grid.columns && mask.rows === grid.rows));

/** A zone with a mask, or null. */
function maskZone(zone, grid) {
  const mask = maskOf(zone?.mask);
  if (mask === null || !isOnMap(mask, grid)) return null;
  const { bounds, resolution } = mask.isFramed ? mask : grid;
  const { column, row } = middleOfMask(mask);
  const middle = { x: bounds.left + column * resolution, y: bounds.top - row * resolution };
  return { type: zone.type, polygon: [], mask, bounds, middle, heading: null, label: labelOf(zone) };
}

/** @type {WeakMap<import("./types.js").Mask, {column: number, row: number}>} */
const middles = new WeakMap(); // of millions of cells, and asked for after every edit

/** The mean of the centres of the cells that a mask covers, in cells from its upper left corner. */
function middleOfMask(mask) {
  const known = middles.get(mask);
  if (known) return known;
  let [count, columns, rows] = [0, 0, 0];
  for (let at = 0; at < mask.percents.length; at += 1) {
    if (mask.percents[at] === 0) continue;
    count += 1;
    columns += at % mask.columns;
    rows += Math.floor(at / mask.columns);
  }
  const most = Math.max(1, count);
  const middle = { column: columns / most + 0.5, row: rows / most + 0.5 };
  middles.set(mask, middle);
  return middle;
}

function isDrawable(zone) {
  const polygon = Array.isArray(zone?.polygon) ? zone.polygon : [];
  const isPlaced = polygon.every((corner) => Number.isFinite(corner?.x) && Number.isFinite(corner?.y));
  return polygon.length >= 3 && isPlaced && TYPES.includes(zone.type);
}

/** The centre of the corners: inside of the plain shapes that zones have. */
function middleOf(polygon) {
  const mean = (axis) => polygon.reduce((sum, corner) => sum + corner[axis], 0) / polygon.length;
  return { x: mean("x"), y: mean("y") };
}

/** Its name and what holds in it, such as "ward: at most 0.5 m/s". */
function labelOf({ id, type, enter, mask, linear_speed: linear, angular_speed: angular }) {
  const limits = [];
  if (Number.isFinite(linear)) limits.push(`${linear} m/s`);
  if (Number.isFinite(angular)) limits.push(`${angular} rad/s`);
  const rules = { blocked: "blocked", one_way: "one-way", speed: `at most ${limits.join(", ") || "?"}` };
  if (mask !== undefined) rules.speed = "slower";
  if (enter === false) rules.blocked = "no entry";
  return typeof id === "string" && id !== "" ? `${id}: ${rules[type]}` : rules[type];
}
