// Where robots are placed: snapped to the middle of a cell and round headings, and nearby free places. Pure.

import { cellAt, centreOf, isFree, tidy } from "./cells.js";

/** @import {Robot, Scene} from "./types.js" */

const HEADING = Math.PI / 12; // radians: 15 degrees
const FINE = 0.01; // of a cell: the precision of a hand
export const CONTACT = 5e-7; // metres: disks that overlap by no more are in contact, as for the service

/** The middle of the nearest cell; if `free`, the point itself in round metres. Without a grid: the same. */
export function snapPoint(grid, point, free) {
  if (grid && !free) return centreOf(grid, cellAt(grid, point));
  const step = 10 ** Math.floor(Math.log10((grid?.resolution ?? 1) * FINE));
  return { x: tidy(Math.round(point.x / step) * step), y: tidy(Math.round(point.y / step) * step) };
}

/** A heading, radians in (-pi, pi], at the nearest 15 degrees; if `free`, at the nearest degree. */
export function snapHeading(theta, free) {
  const step = free ? Math.PI / 180 : HEADING;
  return normalised(Math.round(theta / step) * step);
}

/** The next heading of 15 degrees, counter-clockwise for 1, clockwise for -1. */
export function turned(theta, way) {
  const steps = theta / HEADING;
  const near = Math.round(steps);
  const aligned = Math.abs(steps - near) < 1e-9;
  const next = aligned ? near + way : way > 0 ? Math.ceil(steps) : Math.floor(steps);
  return normalised(next * HEADING);
}

/** Where the arrow keys lead, in the directions of the map. */
export const ARROWS = {
  ArrowLeft: { right: -1, up: 0 },
  ArrowRight: { right: 1, up: 0 },
  ArrowUp: { right: 0, up: 1 },
  ArrowDown: { right: 0, up: -1 },
};

/** A point moved by a cell, from centre to centre, or by a fraction of a cell if `fine`. */
export function stepped(grid, point, { right, up }, fine) {
  const size = (grid?.resolution ?? 1) * (fine ? 0.1 : 1);
  const moved = { x: tidy(point.x + right * size), y: tidy(point.y + up * size) };
  return grid && !fine ? snapPoint(grid, moved, false) : moved;
}

function normalised(theta) {
  const turn = 2 * Math.PI;
  const rest = theta - turn * Math.ceil(theta / turn - 0.5);
  return Math.abs(rest) < 1e-12 ? 0 : rest;
}

/** Where robots start, as disks. */
export const startDisks = ({ robots }) => robots.map(({ start, radius }) => ({ ...start, radius }));

/** The radius of a robot at its last goal, after all loads. */
export const lastRadius = ({ radius, radiiAfter }) => radiiAfter.findLast((each) => each !== null) ?? radius;

/** Where a robot goes, as a disk. Null if the goal may be at one of several poses. */
function endDisk(robot) {
  if (robot.goal === null && robot.alternatives.at(-1)?.length > 0) return null;
  return { ...(robot.goal ?? robot.start), radius: robot.goal ? lastRadius(robot) : robot.radius };
}

/** Where robots other than `but` stay at the end, as disks. Robots that yield need not stay, so others may go there. */
export const endDisks = ({ robots }, /** @type {Robot | null} */ but = null) =>
  robots
    .filter(({ id, yields }) => id !== but?.id && !yields)
    .map(endDisk)
    .filter((disk) => disk !== null);

/**
 * The middle of the cell at a world point, or of a cell within a radius of it, where a disk fits. Null if there is no
 * such cell.
 */
export function placeWithRoom(grid, point, radius, others) {
  return nearestFreePlace(grid, snapPoint(grid, point, false), radius, others, 0, radius);
}

/**
 * The robots that touch a wall or another robot at their start or goal: [{robot, pose: "start" or "goal"}], each once.
 * @param {Scene} scene
 */
export function misplaced(scene) {
  const { grid, robots } = scene;
  const [starts, ends] = [startDisks(scene), robots.map(endDisk)];
  const staying = ends.map((disk, at) => (robots[at].yields ? null : disk));
  const fits = (disk, at, disks) => {
    const others = disks.filter((each, other) => each !== null && other !== at);
    return grid === null || hasRoom(grid, disk, disk.radius, others);
  };
  return robots.flatMap((robot, at) => {
    if (!fits(starts[at], at, starts)) return [{ robot, pose: "start" }];
    return robot.goal !== null && !fits(ends[at], at, robot.yields ? [] : staying)
      ? [{ robot, pose: "goal" }]
      : [];
  });
}

/**
 * The middle of the cell nearest to a world point where a disk of this radius touches neither walls nor `others`, disks
 * [{x, y, radius}]. It is at least `beyond` and at most `within` metres away. Null if there is no such cell.
 */
export function nearestFreePlace(grid, point, radius, others, beyond = 0, within = Infinity) {
  const home = cellAt(grid, point);
  let best = null;
  let nearest = within + CONTACT;
  const farthest = Math.max(grid.columns, grid.rows) + Math.hypot(home.column, home.row);
  for (let ring = 0; ring <= farthest && (ring - 1) * grid.resolution <= nearest; ring += 1) {
    for (const cell of ringOf(home, ring)) {
      if (!isFree(grid, cell)) continue;
      const place = centreOf(grid, cell);
      const distance = Math.hypot(place.x - point.x, place.y - point.y);
      if (distance >= nearest || distance < beyond - CONTACT) continue;
      if (!hasRoom(grid, place, radius, others)) continue;
      nearest = distance;
      best = place;
    }
  }
  return best;
}

/** The cells at `ring` steps from one, right of it first. */
function* ringOf({ column, row }, ring) {
  if (ring === 0) yield { column, row };
  for (let at = 0; at < 2 * ring; at += 1) {
    const along = at % 2 === 0 ? at / 2 : -(at + 1) / 2; // 0, -1, 1, -2, …: the nearest first
    yield { column: column + ring, row: row + along };
    yield { column: column - ring, row: row - along };
    yield { column: column - along, row: row + ring };
    yield { column: column + along, row: row - ring };
  }
}

function hasRoom(grid, place, radius, others) {
  const { origin, resolution, rows } = grid;
  const first = cellAt(grid, { x: place.x - radius, y: place.y + radius });
  const last = cellAt(grid, { x: place.x + radius, y: place.y - radius });
  for (let { row } = first; row <= last.row; row += 1) {
    for (let { column } = first; column <= last.column; column += 1) {
      if (isFree(grid, { column, row })) continue;
      const left = origin.x + column * resolution;
      const bottom = origin.y + (rows - 1 - row) * resolution;
      const x = Math.max(left, Math.min(left + resolution, place.x));
      const y = Math.max(bottom, Math.min(bottom + resolution, place.y));
      if (Math.hypot(x - place.x, y - place.y) < radius - CONTACT) return false;
    }
  }
  return others.every((other) => {
    return Math.hypot(other.x - place.x, other.y - place.y) >= radius + other.radius - CONTACT;
  });
}
