// Marks of what is wrong in a scene: a ring or a band in the colour of danger, and always a sign beside it.

import { ring } from "./marks.js";

/** Rings a disk of the world and puts an exclamation mark at it. `radius` in metres. */
export function markWrong(context, { scale, screen, theme }, point, radius) {
  const { x, y } = screen(point);
  const rim = Math.max(radius * scale, 4) + 3;
  ring(context, { x, y }, rim, theme.danger, { width: 2.5, alpha: 1, dashes: [6, 3] });
  drawExclamation(context, theme, x + rim * 0.75, y - rim * 0.75);
}

/** Brings out a row of the map, 0 the top one. */
export function markRow(context, { scale, screen, theme }, { bounds, resolution }, row) {
  const corner = screen({ x: bounds.left, y: bounds.top - row * resolution });
  const width = (bounds.right - bounds.left) * scale;
  context.save();
  context.strokeStyle = theme.danger;
  context.lineWidth = 2.5;
  context.setLineDash([6, 3]);
  context.strokeRect(corner.x, corner.y, width, Math.max(2, resolution * scale));
  context.restore();
  drawExclamation(context, theme, corner.x, corner.y);
}

function drawExclamation(context, theme, x, y) {
  context.save();
  context.fillStyle = theme.danger;
  context.beginPath();
  context.arc(x, y, 8, 0, 2 * Math.PI);
  context.fill();
  context.fillStyle = theme.floor;
  context.font = `700 12px ${theme.font}`;
  context.textAlign = "center";
  context.textBaseline = "middle";
  context.fillText("!", x, y + 0.5);
  context.restore();
}
