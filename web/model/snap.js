// Where things land that are placed by hand: in the middle of a cell and at round headings, or nearly anywhere.
// Pure.

import { cellAt, centreOf, tidy } from "./cells.js";

const HEADING = Math.PI / 12; // radians: 15 degrees
const FINE = 0.01; // of a cell: the digits that a hand can mean

/** The middle of the nearest cell; if `free`, the point itself in round metres. Without a grid: likewise. */
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

/** A point moved by steps of a share of a cell; a whole step leads from cell to cell. */
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
