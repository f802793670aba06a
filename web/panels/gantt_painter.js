// Paints the timeline: the smallest gap over time, an axis of time, and a row per robot. The type of an
// action is shown by form: driving is a full bar, turning half a bar, waiting an open one. Sizes in CSS
// pixels.

import { spellsBelow } from "../model/clearance.js";
import { rowsSeen, thinned, ticks, xOf, yOf } from "../model/gantt.js";
import { REASONS } from "./unplanned_card.js";

export const STRIP = 44; // the height of the curve above the rows
export const AXIS = 20; // the height of the axis between

const PAD = 8;
const LABELLED = 14; // pixels: lower rows have no room for names
const SWATCH = 5; // radius
const TICK_WIDTH = 72; // pixels per tick label
const LEAST_BAR = 1; // so that short actions are visible
const CONTACT = 1e-6; // metres: nearer is contact, further overlapping a collision
const FONT = 12;
const HINT = "Plan to see the actions of all robots over time";
const STATUS = { parked: "Parked", ready: "", outdated: "" };

/**
 * `chart` has
 *
 * - layout (see model/gantt.js; its rows begin below the strip and the axis),
 * - ids (row by row), session and colours (see RobotColours),
 * - curve (see clearanceOf, or null),
 * - beyondVicinity (see FleetMotion),
 * - threshold (of gaps, metres, or null).
 */
export function paintGantt(context, chart) {
  const { layout, colours } = chart;
  const { theme } = colours;
  context.clearRect(0, 0, layout.left + layout.width + PAD, layout.top + layout.height);
  context.textBaseline = "middle";
  context.textAlign = "left";
  paintRows(context, chart);
  context.clearRect(0, 0, layout.left + layout.width + PAD, layout.top);
  paintAxis(context, layout, theme);
  clipped(context, layout, 0, STRIP, () => paintCurve(context, layout, theme, chart.curve, chart.threshold));
  paintStripLabel(context, layout, theme, chart);
  if (chart.session.answer === null) paintHint(context, layout, theme);
}

function paintHint(context, { left }, theme) {
  context.font = `${FONT}px ${theme.font}`;
  context.fillStyle = theme.muted;
  context.fillText(HINT, left + PAD, STRIP / 2);
}

function paintAxis(context, layout, theme) {
  const { left, width, range, top, height } = layout;
  if (range.to <= range.from) return;
  const { step, times } = ticks(range, width / TICK_WIDTH);
  const digits = Math.max(0, Math.ceil(-Math.log10(step) - 1e-9));
  context.font = `${FONT - 1}px ${theme.font}`;
  context.textAlign = "center";
  for (const time of times) {
    const x = Math.round(xOf(layout, time));
    context.fillStyle = theme.muted;
    const text = `${time.toFixed(digits)} s`;
    const half = context.measureText(text).width / 2;
    context.fillText(text, Math.min(left + width - half, Math.max(left + half, x)), STRIP + AXIS / 2 + 1);
    context.fillStyle = theme.edge;
    context.globalAlpha = 0.3;
    context.fillRect(x, 0, 1, STRIP);
    context.fillRect(x, top, 1, height);
    context.globalAlpha = 1;
  }
  context.textAlign = "left";
}

function paintStripLabel(context, layout, theme, { curve, beyondVicinity }) {
  context.font = `${FONT - 1}px ${theme.font}`;
  context.fillStyle = theme.muted;
  context.fillText(beyondVicinity ? "Beyond vicinity" : "Smallest gap", PAD, STRIP / 2 - (curve ? 7 : 0));
  if (curve === null) return;
  context.fillText(`0 to ${largestGap(curve, layout.range).toFixed(1)} m`, PAD, STRIP / 2 + 8);
}

/** The curve on a square-root scale, which spreads small gaps; below it contacts and overlaps. */
function paintCurve(context, layout, theme, curve, threshold) {
  if (curve === null) return;
  const { t, gap } = curve;
  const most = largestGap(curve, layout.range);
  const bottom = STRIP - 5;
  const yAt = (value) => bottom - Math.sqrt(Math.min(most, Math.max(0, value)) / most) * (bottom - 5);
  if (threshold !== null) paintThreshold(context, layout, theme, curve, threshold, yAt);
  context.beginPath();
  const shown = thinned(curve, layout.range, layout.width);
  const [first, last] = [shown[0], shown[shown.length - 1]];
  const right = Math.max(layout.left + layout.width, xOf(layout, t[last]));
  context.moveTo(Math.min(layout.left, xOf(layout, t[first])), yAt(gap[first]));
  for (const k of shown) context.lineTo(xOf(layout, t[k]), yAt(gap[k]));
  context.lineTo(right, yAt(gap[last]));
  context.strokeStyle = theme.accent;
  context.lineWidth = 1.5;
  context.lineJoin = "round";
  context.stroke();
  context.lineTo(right, bottom);
  context.lineTo(Math.min(layout.left, xOf(layout, t[first])), bottom);
  context.globalAlpha = 0.14;
  context.fillStyle = theme.accent;
  context.fill();
  context.globalAlpha = 1;
  shown.forEach((k, at) => paintContact(context, layout, theme, curve, [k, shown[at + 1]], bottom));
}

/** A line at the threshold, and the times at which the gap is below it. */
function paintThreshold(context, layout, theme, curve, threshold, yAt) {
  context.fillStyle = context.strokeStyle = theme.danger;
  context.globalAlpha = 0.2;
  for (const { from, to } of spellsBelow(curve, threshold)) {
    const x = xOf(layout, curve.t[from]);
    const end = xOf(layout, curve.t[to + 1] ?? curve.t[to]);
    context.fillRect(x - 1, 0, Math.max(2, end - x), STRIP);
  }
  context.globalAlpha = 0.8;
  context.setLineDash([4, 3]);
  context.lineWidth = 1;
  context.beginPath();
  context.moveTo(layout.left, yAt(threshold));
  context.lineTo(layout.left + layout.width, yAt(threshold));
  context.stroke();
  context.setLineDash([]);
  context.globalAlpha = 1;
}

/** Marks contact below the curve and overlap over its whole height, up to the next point if it continues. */
function paintContact(context, layout, theme, { t, gap }, [k, next], bottom) {
  if (gap[k] > CONTACT) return;
  const overlap = gap[k] < -CONTACT;
  const x = Math.round(xOf(layout, t[k])) - 1;
  const goesOn = overlap ? gap[next] < -CONTACT : Math.abs(gap[next]) <= CONTACT;
  const width = goesOn ? Math.max(1, Math.round(xOf(layout, t[next])) - 1 - x) : 2;
  context.fillStyle = overlap ? theme.danger : theme.ink;
  context.fillRect(x, bottom - 1, width, 6);
  if (!overlap) return;
  context.globalAlpha = 0.35;
  context.fillRect(x, 0, width, bottom - 1);
  context.globalAlpha = 1;
}

/** The largest gap in a range of time; at least 0, the gap of contact. */
function largestGap({ t, gap }, { from, to }) {
  let largest = CONTACT;
  for (let k = 0; k < t.length; k += 1) {
    if (t[k] >= from && t[k] <= to && gap[k] < Infinity) largest = Math.max(largest, gap[k]);
  }
  return largest;
}

function paintRows(context, { layout, ids, session, colours }) {
  const { first, end } = rowsSeen(layout);
  const { theme } = colours;
  for (let row = first; row < end; row += 1) {
    const robot = session.robot(ids[row]);
    const track = session.tracks.get(robot.id);
    const top = yOf(layout, row);
    paintGround(context, layout, theme, top, robot.id === session.hovered, session.marked.has(robot.id));
    paintLabel(context, layout, theme, { top, robot, track, colour: colours.of(robot.index) });
    clipped(context, layout, top, layout.rowHeight, () => {
      if (track.status === "planned")
        paintActions(context, layout, theme, top, track, colours.of(robot.index));
      else if (track.status === "outdated") paintFormer(context, layout, theme, top, track);
      else paintStatus(context, layout, theme, top, track);
    });
  }
}

function paintGround(context, { left, width, rowHeight }, theme, top, hovered, marked) {
  if (!hovered && !marked) return;
  context.globalAlpha = marked ? 0.16 : 0.08;
  context.fillStyle = marked ? theme.accent : theme.ink;
  context.fillRect(0, top, left + width + PAD, rowHeight);
  context.globalAlpha = 1;
  if (!marked) return;
  context.fillStyle = theme.accent;
  context.fillRect(0, top, 3, rowHeight);
}

function paintLabel(context, { left, rowHeight }, theme, { top, robot, track, colour }) {
  const middle = top + rowHeight / 2;
  if (rowHeight < LABELLED) {
    context.fillStyle = colour;
    context.fillRect(PAD, top + 1, left - 2 * PAD, rowHeight - 2);
    return;
  }
  context.beginPath();
  context.arc(PAD + SWATCH, middle, SWATCH - 0.75, 0, 2 * Math.PI);
  context.fillStyle = context.strokeStyle = colour;
  context.lineWidth = 1.5;
  if (track.status !== "unplanned") context.fill();
  context.stroke();
  context.font = `${FONT}px ${theme.font}`;
  context.fillStyle = theme.ink;
  const room = left - 3 * PAD - 2 * SWATCH;
  context.fillText(shortened(context, robot.id, room), 2 * PAD + 2 * SWATCH, middle + 0.5);
}

/** The text, or its end if it is too long, as ids differ there. */
function shortened(context, text, room) {
  if (context.measureText(text).width <= room) return text;
  let from = 1;
  while (from < text.length && context.measureText(`…${text.slice(from)}`).width > room) from += 1;
  return `…${text.slice(from)}`;
}

function paintActions(context, layout, theme, top, { actions, lowerBound }, colour) {
  const middle = Math.round(top + layout.rowHeight / 2);
  const full = Math.round(layout.rowHeight * 0.56);
  const half = Math.round(full / 2);
  context.fillStyle = context.strokeStyle = colour;
  context.lineWidth = 1;
  for (const { type, t_start, t_end } of actions) {
    if (t_end < layout.range.from || t_start > layout.range.to) continue;
    const x = xOf(layout, t_start);
    const width = Math.max(LEAST_BAR, xOf(layout, t_end) - x);
    if (type === "translate") context.fillRect(x, middle - full / 2, width, full);
    else if (type === "rotate") context.fillRect(x, middle + full / 2 - half, width, half);
    else context.strokeRect(x + 0.5, middle - 1.5, Math.max(0, width - 1), 3);
  }
  if (!Number.isFinite(lowerBound)) return;
  context.fillStyle = theme.ink;
  context.fillRect(Math.round(xOf(layout, lowerBound)) - 1, top + 2, 2, layout.rowHeight - 4);
}

/** The actions of a plan that no longer holds, faint and without colour. */
function paintFormer(context, layout, theme, top, { former }) {
  context.globalAlpha = 0.35;
  paintActions(context, layout, theme, top, { actions: former, lowerBound: null }, theme.muted);
  context.globalAlpha = 1;
}

function paintStatus(context, layout, theme, top, { status, unplanned }) {
  const text = unplanned ? `✕ ${REASONS[unplanned.reason] ?? unplanned.reason}` : STATUS[status];
  context.font = `${unplanned ? "600 " : ""}${FONT}px ${theme.font}`;
  context.fillStyle = unplanned ? theme.danger : theme.muted;
  context.fillText(text, layout.left + PAD, top + layout.rowHeight / 2 + 0.5);
}

/** Paints within the time axis of the chart. */
function clipped(context, { left, width }, top, height, paint) {
  context.save();
  context.beginPath();
  context.rect(left, top, width + PAD, height);
  context.clip();
  paint();
  context.restore();
}
