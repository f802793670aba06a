// The lattice: the points, besides starts and goals, at which robots may stop. Pure. Metres.

import { cellAt, isFree } from "./cells.js";

/** The distance of its points: as the answer tells it, as the request asks for, or the size of a cell. */
export function spacingOf(grid, request, answer) {
  const asked = request?.options?.lattice_spacing;
  return answer?.lattice_spacing ?? (asked > 0 ? asked : grid.resolution);
}

/**
 * The points in a part of the map {left, bottom, right, top} whose cells are free. They are the centres of squares of a
 * size; the number of squares is the nearest that fits.
 */
export function latticePoints(grid, spacing, part) {
  const { left, bottom, right, top } = grid.bounds;
  const range = (from, to, zero, end) => {
    const first = Math.max(0, Math.ceil((from - zero) / spacing - 0.5));
    const last = Math.min(
      Math.floor((end - zero) / spacing + 0.5) - 1,
      Math.floor((to - zero) / spacing - 0.5),
    );
    return { first, last };
  };
  const across = range(part.left, part.right, left, right);
  const up = range(part.bottom, part.top, bottom, top);
  const points = [];
  for (let row = up.first; row <= up.last; row += 1) {
    for (let column = across.first; column <= across.last; column += 1) {
      const point = { x: left + (column + 0.5) * spacing, y: bottom + (row + 0.5) * spacing };
      if (isFree(grid, cellAt(grid, point))) points.push(point);
    }
  }
  return points;
}
