// Points and polygons. Pure. Metres.

/** Whether a point is in a polygon of these corners. */
export function isInPolygon({ x, y }, corners) {
  let isInside = false;
  corners.forEach((to, at) => {
    const from = corners.at(at - 1);
    if (from.y > y === to.y > y) return;
    if (x < from.x + ((y - from.y) / (to.y - from.y)) * (to.x - from.x)) isInside = !isInside;
  });
  return isInside;
}

/** The distance of a point from a polygon of these corners: 0 inside. */
export function distanceToPolygon(point, corners) {
  if (isInPolygon(point, corners)) return 0;
  const nearer = (nearest, to, at) => Math.min(nearest, distanceToSide(point, corners.at(at - 1), to));
  return corners.reduce(nearer, Infinity);
}

function distanceToSide(point, from, to) {
  const [x, y] = [to.x - from.x, to.y - from.y];
  const squared = x * x + y * y;
  const along = squared > 0 ? ((point.x - from.x) * x + (point.y - from.y) * y) / squared : 0;
  const share = Math.min(1, Math.max(0, along));
  return Math.hypot(from.x + share * x - point.x, from.y + share * y - point.y);
}
