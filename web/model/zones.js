// The zones of a request, as they are drawn. Faulty ones are left out. Pure. Metres.

/** @import {Zone} from "./types.js" */

const TYPES = ["blocked", "speed", "one_way"];

/** @returns {Zone[]} */
export function readZones(request) {
  const listed = Array.isArray(request?.zones) ? request.zones : [];
  return listed.filter(isDrawable).map((zone) => ({
    type: zone.type,
    polygon: zone.polygon.map(({ x, y }) => ({ x, y })),
    middle: middleOf(zone.polygon),
    heading: zone.type === "one_way" && Number.isFinite(zone.heading) ? zone.heading : null,
    label: labelOf(zone),
  }));
}

function isDrawable(zone) {
  const polygon = Array.isArray(zone?.polygon) ? zone.polygon : [];
  const isPlaced = polygon.every((corner) => Number.isFinite(corner?.x) && Number.isFinite(corner?.y));
  return polygon.length >= 3 && isPlaced && TYPES.includes(zone.type);
}

/** The centre of the corners: inside of the plain shapes that zones have. */
function middleOf(polygon) {
  const mean = (axis) => polygon.reduce((sum, corner) => sum + corner[axis], 0) / polygon.length;
  return { x: mean("x"), y: mean("y") };
}

/** Its name and what holds in it, such as "ward: at most 0.5 m/s". */
function labelOf({ id, type, linear_speed: linear, angular_speed: angular }) {
  const limits = [];
  if (Number.isFinite(linear)) limits.push(`${linear} m/s`);
  if (Number.isFinite(angular)) limits.push(`${angular} rad/s`);
  const rules = { blocked: "blocked", one_way: "one way", speed: `at most ${limits.join(", ") || "?"}` };
  return typeof id === "string" && id !== "" ? `${id}: ${rules[type]}` : rules[type];
}
