// The lattice in the scene, if it is asked for and its points are far enough apart to be told from each other.

import { latticePoints, spacingOf } from "../model/lattice.js";
import { toWorld } from "./view.js";

const LEAST = 8; // pixels between points
const DOT = 2; // pixels

export function showLattice(session, stage) {
  const paint = (context, { camera, viewport, scale, screen, theme }) => {
    const { grid } = session.scene;
    if (!stage.look.lattice || grid === null) return;
    const spacing = spacingOf(grid, session.request, session.answer);
    if (spacing * scale < LEAST) return;
    const corner = toWorld(camera, viewport, { x: 0, y: viewport.height });
    const end = toWorld(camera, viewport, { x: viewport.width, y: 0 });
    const part = { left: corner.x, bottom: corner.y, right: end.x, top: end.y };
    context.fillStyle = theme.muted;
    for (const point of latticePoints(grid, spacing, part)) {
      const { x, y } = screen(point);
      context.fillRect(x - DOT / 2, y - DOT / 2, DOT, DOT);
    }
  };
  stage.addOverlay(paint, { shared: true });
}
