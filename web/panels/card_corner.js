// In which corner of the scene a card hides the least. Pure. Pixels from the scene's upper left corner.

const CORNERS = ["top-right", "bottom-right", "bottom-left"]; // those liked best first

/**
 * The corner for a card of some width and height in a scene {width, height}, `margin` {top, side, bottom} away
 * from its edges, that covers the fewest of the points.
 */
export function cornerFor({ width, height }, scene, margin, points) {
  const covered = CORNERS.map((corner) => {
    const left = corner.endsWith("left") ? margin.side : scene.width - margin.side - width;
    const top = corner.startsWith("top") ? margin.top : scene.height - margin.bottom - height;
    const isUnder = ({ x, y }) => x >= left && x <= left + width && y >= top && y <= top + height;
    return points.filter(isUnder).length;
  });
  return CORNERS[covered.indexOf(Math.min(...covered))];
}
