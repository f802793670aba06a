// The marks of a scene: robots, starts, goals, paths. Positions and sizes in CSS pixels, angles in radians,
// counter-clockwise as in the world.

const SMALLEST_DOT = 2.5; // pixels: the least radius of a robot
const SMALLEST_LABEL = 8; // font pixels
const CROSS = { width: 2, alpha: 0.9 };

/**
 * A robot as a disk with a wedge for its heading. If there is room, it has its label or, if `state` is not null, the
 * sign of its state. A robot without a plan is hollow and crossed out.
 */
export function drawRobot(
  context,
  theme,
  { centre, theta, radius, colour, label, state, unplanned, name, tags },
) {
  const shown = Math.max(radius, SMALLEST_DOT);
  if (name !== null) drawHalo(context, centre, shown, theme);
  if (unplanned) drawUnplanned(context, theme, centre, shown, colour);
  else drawDisk(context, theme, { centre, theta, radius: shown, colour, label, state });
  if (name) drawName(context, theme, centre, shown, name, tags);
}

/** The start of a robot: a faint ring. */
export function drawStart(context, centre, radius, colour) {
  if (radius < SMALLEST_DOT) return;
  ring(context, centre, radius - 0.5, colour, { width: 1, alpha: 0.45, dashes: [2, 3] });
}

/** A goal: a ring and, if the heading matters, a tick in the direction of the heading. */
export function drawGoal(context, centre, theta, radius, colour) {
  const shown = Math.max(radius, SMALLEST_DOT);
  const width = Math.min(2, Math.max(1, shown / 6));
  ring(context, centre, shown - width / 2, colour, { width, alpha: 0.9, dashes: [] });
  if (theta === null || shown < 4) return;
  context.save();
  context.globalAlpha = 0.9;
  context.strokeStyle = colour;
  context.lineWidth = Math.min(2.5, width * 1.4);
  context.lineCap = "round";
  context.beginPath();
  context.moveTo(centre.x + Math.cos(theta) * shown * 0.5, centre.y - Math.sin(theta) * shown * 0.5);
  context.lineTo(centre.x + Math.cos(theta) * shown * 1.3, centre.y - Math.sin(theta) * shown * 1.3);
  context.stroke();
  context.restore();
}

/** A pose at which a goal may be served, of no robot as long as none has chosen it: a dotted ring. */
export function drawAlternative(context, theme, centre, radius) {
  const shown = Math.max(radius, SMALLEST_DOT);
  ring(context, centre, shown - 0.5, theme.muted, { width: 1.5, alpha: 0.8, dashes: [1, 3] });
}

/** The number of a goal, in its ring. */
export function drawNumber(context, theme, centre, radius, colour, number) {
  const size = Math.min(14, radius * 1.3);
  if (size < SMALLEST_LABEL) return;
  context.font = `600 ${size.toFixed(1)}px ${theme.font}`;
  context.textAlign = "center";
  context.textBaseline = "middle";
  context.fillStyle = colour;
  context.fillText(String(number), centre.x, centre.y + size * 0.06);
}

/** Something that moves on its own: a disk with a cross, in no robot's colour. */
export function drawObstacle(context, theme, centre, radius) {
  const shown = Math.max(radius, SMALLEST_DOT);
  context.beginPath();
  context.arc(centre.x, centre.y, shown, 0, 2 * Math.PI);
  context.fillStyle = theme.muted;
  context.fill();
  ring(context, centre, shown, theme.ink, { width: 1.5, alpha: 0.9, dashes: [] });
  const arm = shown * 0.5;
  drawPath(
    context,
    [
      { x: centre.x - arm, y: centre.y },
      { x: centre.x + arm, y: centre.y },
    ],
    theme.floor,
    CROSS,
  );
  drawPath(
    context,
    [
      { x: centre.x, y: centre.y - arm },
      { x: centre.x, y: centre.y + arm },
    ],
    theme.floor,
    CROSS,
  );
}

/** @param {{width: number, alpha: number, dashes?: number[]}} line */
export function drawPath(context, points, colour, line) {
  const { width, alpha, dashes = [] } = line;
  if (points.length < 2) return;
  context.save();
  context.globalAlpha = alpha;
  context.strokeStyle = colour;
  context.lineWidth = width;
  context.lineJoin = context.lineCap = "round";
  context.setLineDash(dashes);
  context.beginPath();
  context.moveTo(points[0].x, points[0].y);
  for (let at = 1; at < points.length; at += 1) context.lineTo(points[at].x, points[at].y);
  context.stroke();
  context.restore();
}

function drawDisk(context, theme, { centre, theta, radius, colour, label, state }) {
  context.beginPath();
  context.arc(centre.x, centre.y, radius, 0, 2 * Math.PI);
  context.fillStyle = colour;
  context.fill();
  if (radius < 4) return;
  const labelled =
    state === null
      ? drawLabel(context, theme, centre, radius, label)
      : drawStateSign(context, theme, centre, radius, state);
  context.save();
  context.translate(centre.x, centre.y);
  context.rotate(-theta);
  context.fillStyle = theme.floor;
  context.beginPath();
  context.moveTo(radius * 0.92, 0);
  if (labelled) {
    context.lineTo(radius * 0.7, radius * 0.28);
    context.lineTo(radius * 0.7, -radius * 0.28);
  } else {
    context.lineTo(-radius * 0.32, radius * 0.5);
    context.lineTo(-radius * 0.06, 0);
    context.lineTo(-radius * 0.32, -radius * 0.5);
  }
  context.closePath();
  context.fill();
  context.restore();
}

/** Writes the label in the disk if there is room; returns whether it did. */
function drawLabel(context, theme, centre, radius, label) {
  const widest = Math.min(15, radius * 0.82);
  if (widest < SMALLEST_LABEL) return false;
  context.font = `600 ${widest.toFixed(1)}px ${theme.font}`;
  const share = Math.min(1, (radius * 1.1) / context.measureText(label).width);
  const size = widest * share;
  if (size < SMALLEST_LABEL) return false;
  if (share < 1) context.font = `600 ${size.toFixed(1)}px ${theme.font}`;
  context.textAlign = "center";
  context.textBaseline = "middle";
  context.fillStyle = theme.floor;
  context.fillText(label, centre.x, centre.y + size * 0.06);
  return true;
}

/**
 * Two bars for waiting, a turn's arc, a tick for arrived; moving is the wedge alone. Returns whether it drew
 * a sign.
 */
function drawStateSign(context, theme, centre, radius, state) {
  const size = radius * 0.42;
  if (size < 2 || !["waiting", "turning", "arrived", "parked"].includes(state)) return false;
  const { x, y } = centre;
  context.strokeStyle = theme.floor;
  context.lineWidth = Math.max(1.2, radius * 0.16);
  context.lineCap = context.lineJoin = "round";
  context.beginPath();
  if (state === "waiting") {
    context.moveTo(x - size * 0.45, y - size * 0.7);
    context.lineTo(x - size * 0.45, y + size * 0.7);
    context.moveTo(x + size * 0.45, y - size * 0.7);
    context.lineTo(x + size * 0.45, y + size * 0.7);
  } else if (state === "turning") {
    context.arc(x, y, size * 0.75, -0.6, Math.PI * 1.1);
  } else if (state === "arrived") {
    context.moveTo(x - size * 0.8, y);
    context.lineTo(x - size * 0.2, y + size * 0.6);
    context.lineTo(x + size * 0.8, y - size * 0.6);
  } else {
    context.rect(x - size * 0.5, y - size * 0.5, size, size);
  }
  context.stroke();
  return true;
}

function drawUnplanned(context, theme, centre, radius, colour) {
  context.beginPath();
  context.arc(centre.x, centre.y, radius, 0, 2 * Math.PI);
  context.fillStyle = theme.floor;
  context.fill();
  const width = Math.min(2.5, Math.max(1.5, radius / 6));
  ring(context, centre, radius - width / 2, colour, { width, alpha: 1, dashes: [] });
  const arm = radius * 0.4;
  context.save();
  context.strokeStyle = theme.danger;
  context.lineWidth = width;
  context.lineCap = "round";
  context.beginPath();
  context.moveTo(centre.x - arm, centre.y - arm);
  context.lineTo(centre.x + arm, centre.y + arm);
  context.moveTo(centre.x + arm, centre.y - arm);
  context.lineTo(centre.x - arm, centre.y + arm);
  context.stroke();
  context.restore();
}

function drawHalo(context, centre, radius, theme) {
  ring(context, centre, radius + 4, theme.ink, { width: 2, alpha: 0.85, dashes: [] });
}

/** Writes the name above the disk, or where `tags` (see TagPlaces) has room. */
function drawName(context, theme, centre, radius, name, tags) {
  drawTag(context, theme, tags.place(centre, radius + 17, tagWidth(context, theme, name)), name);
}

function tagWidth(context, theme, text) {
  context.font = `600 ${12 * theme.zoom}px ${theme.font}`;
  return context.measureText(text).width + 12;
}

/** A short text on its own background, centred at a point. */
export function drawTag(context, theme, { x, y }, text) {
  context.save();
  const width = tagWidth(context, theme, text);
  const height = 18 * theme.zoom;
  context.textAlign = "center";
  context.textBaseline = "middle";
  context.fillStyle = theme.ink;
  context.beginPath();
  context.roundRect(x - width / 2, y - height / 2, width, height, 5);
  context.fill();
  context.fillStyle = theme.floor;
  context.fillText(text, x, y + 0.5);
  context.restore();
}

/** @param {{width: number, alpha: number, dashes: number[]}} line */
export function ring(context, centre, radius, colour, line) {
  const { width, alpha, dashes } = line;
  context.save();
  context.globalAlpha = alpha;
  context.strokeStyle = colour;
  context.lineWidth = width;
  context.setLineDash(dashes);
  context.beginPath();
  context.arc(centre.x, centre.y, Math.max(0, radius), 0, 2 * Math.PI);
  context.stroke();
  context.restore();
}

/** A cross that is open in its middle, which it marks. */
export function drawCrosshair(context, theme, { x, y }) {
  for (const [across, down] of [
    [1, 0],
    [-1, 0],
    [0, 1],
    [0, -1],
  ]) {
    const arm = [4, 12].map((far) => ({ x: x + across * far, y: y + down * far }));
    drawPath(context, arm, theme.floor, { width: 4, alpha: 0.9 });
    drawPath(context, arm, theme.ink, { width: 2, alpha: 1 });
  }
}

/** Rings a disk of the world and puts an exclamation mark at it. `radius` in metres. */
export function markWrong(context, { scale, screen, theme }, point, radius) {
  const { x, y } = screen(point);
  const rim = Math.max(radius * scale, 4) + 3;
  ring(context, { x, y }, rim, theme.danger, { width: 2.5, alpha: 1, dashes: [6, 3] });
  drawExclamation(context, theme, x + rim * 0.75, y - rim * 0.75);
}

/** Marks a row of the map, 0 the top one. */
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
