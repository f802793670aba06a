// Zones of a scene: areas with a rule, each with its label. Positions and sizes in CSS pixels.

import { drawPath } from "./marks.js";
import { rasterOf } from "./mask_raster.js";

const COLOURS = { blocked: "danger", speed: "muted", one_way: "accent" }; // of the theme
const FILL = 0.14; // opacity
const BORDER = { width: 1.5, alpha: 0.9, dashes: [6, 4] };
const ARROW = { width: 2.5, alpha: 0.9 };
const LABEL_PIXELS = 12;
const ARROW_PIXELS = 34; // the longest
const ABOVE = 14; // from the middle to a label, where an arrow is in the middle

/** `screen(point)` is where a point of the world is, `scale` the pixels of a metre. */
export function drawZone(context, theme, zone, screen, scale) {
  const { type, mask, middle, heading, label } = zone;
  const colour = theme[COLOURS[type]];
  const extent =
    mask === null ? drawPolygon(context, colour, zone, screen) : drawMask(context, colour, zone, screen);
  const centre = screen(middle);
  if (heading !== null) drawArrow(context, colour, centre, heading, Math.min(ARROW_PIXELS, scale));
  drawLabel(context, theme, { x: centre.x, y: centre.y - (heading === null ? 0 : ABOVE) }, label, extent);
}

/** Returns its width. */
function drawPolygon(context, colour, { polygon }, screen) {
  const corners = polygon.map(screen);
  context.save();
  context.globalAlpha = FILL;
  context.fillStyle = colour;
  context.beginPath();
  for (const { x, y } of corners) context.lineTo(x, y);
  context.closePath();
  context.fill();
  context.restore();
  drawPath(context, [...corners, corners[0]], colour, BORDER);
  return Math.max(...corners.map(({ x }) => x)) - Math.min(...corners.map(({ x }) => x));
}

/** Returns the width of the map. */
function drawMask(context, colour, { type, mask, bounds }, screen) {
  const [corner, end] = [
    screen({ x: bounds.left, y: bounds.top }),
    screen({ x: bounds.right, y: bounds.bottom }),
  ];
  context.save();
  context.imageSmoothingEnabled = false;
  context.drawImage(rasterOf(mask, type, colour), corner.x, corner.y, end.x - corner.x, end.y - corner.y);
  context.restore();
  return end.x - corner.x;
}

function drawArrow(context, colour, centre, heading, length) {
  const [x, y] = [Math.cos(heading) * length, -Math.sin(heading) * length];
  const tip = { x: centre.x + x / 2, y: centre.y + y / 2 };
  const barb = (side) => ({ x: tip.x - 0.3 * (x + side * y), y: tip.y - 0.3 * (y - side * x) });
  drawPath(context, [{ x: tip.x - x, y: tip.y - y }, tip], colour, ARROW);
  drawPath(context, [barb(1), tip, barb(-1)], colour, ARROW);
}

/** Writes the label if it is not wider than the zone. */
function drawLabel(context, theme, { x, y }, label, width) {
  context.save();
  context.font = `600 ${LABEL_PIXELS * theme.zoom}px ${theme.font}`;
  if (context.measureText(label).width <= width) {
    context.textAlign = "center";
    context.textBaseline = "middle";
    context.fillStyle = theme.ink;
    context.fillText(label, x, y);
  }
  context.restore();
}
