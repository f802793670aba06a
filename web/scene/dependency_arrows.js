// Dependencies as arrows. In the scene, an arrow leads from where a robot must have been to where another robot may
// then pass. In the timeline, it leads from one moment to the other. The marked robot waits by solid arrows. Other
// robots wait for it by dashed arrows.

import { yOf, xOf } from "../model/gantt.js";
import { drawPath } from "./marks.js";

const BARB = 9; // pixels
const SPREAD = 0.42; // radians
const DASHES = { waitsFor: [], heldFor: [5, 4] };

/** `arrows`: [{kind, from, to}], with from and to as {x, y} in the world. */
export function paintSceneArrows(context, { screen, theme }, arrows) {
  for (const { kind, from, to } of arrows) {
    drawArrow(context, screen(from), screen(to), colourOf(theme, kind), DASHES[kind]);
  }
}

/** `arrows`: [{kind, from, to}], with from and to as {robot, t}; `ids` are the rows, `layout` see gantt.js. */
export function paintTimelineArrows(context, theme, { layout, ids }, arrows) {
  const rows = new Map(ids.map((id, row) => [id, row]));
  const place = ({ robot, t }) => ({
    x: xOf(layout, t),
    y: yOf(layout, rows.get(robot)) + layout.rowHeight / 2,
  });
  context.save();
  context.beginPath();
  context.rect(layout.left, layout.top, layout.width, layout.height);
  context.clip();
  for (const { kind, from, to } of arrows) {
    drawArrow(context, place(from), place(to), colourOf(theme, kind), DASHES[kind]);
  }
  context.restore();
}

const colourOf = (theme, kind) => (kind === "waitsFor" ? theme.danger : theme.ink);

function drawArrow(context, from, to, colour, dashes) {
  const line = { width: 2, alpha: 1 };
  const heading = Math.atan2(to.y - from.y, to.x - from.x);
  const barb = (side) => ({
    x: to.x - BARB * Math.cos(heading + side * SPREAD),
    y: to.y - BARB * Math.sin(heading + side * SPREAD),
  });
  drawPath(context, [from, to], colour, { ...line, dashes });
  drawPath(context, [barb(1), to, barb(-1)], colour, line);
}
