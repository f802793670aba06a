// Distances from polygons. Pure. Metres.

/** The distance of a point from a polygon of these corners: 0 inside. */
export function distanceToPolygon(point, corners) {
  let isInside = false;
  let nearest = Infinity;
  corners.forEach((to, at) => {
    const from = corners.at(at - 1);
    nearest = Math.min(nearest, distanceToSide(point, from, to));
    if (from.y > point.y === to.y > point.y) return;
    const crossing = from.x + ((point.y - from.y) / (to.y - from.y)) * (to.x - from.x);
    if (crossing > point.x) isInside = !isInside;
  });
  return isInside ? 0 : nearest;
}

function distanceToSide(point, from, to) {
  const [x, y] = [to.x - from.x, to.y - from.y];
  const squared = x * x + y * y;
  const along = squared > 0 ? ((point.x - from.x) * x + (point.y - from.y) * y) / squared : 0;
  const share = Math.min(1, Math.max(0, along));
  return Math.hypot(from.x + share * x - point.x, from.y + share * y - point.y);
}
