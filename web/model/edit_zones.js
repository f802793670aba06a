// Edits of the zones of a request, see edit_request.js. Zones are identified by their index. Pure. Metres, radians.

import { tidy } from "./cells.js";
import { objectOf, unusedId, withMembers } from "./edit_request.js";
import { zonesOf } from "./listed.js";

const SPEED = 0.5; // m/s, of a new slow zone
const HALF_ANGLE = 1.5708; // radians: a right angle

/** What the types of zones ask of robots. */
export const ZONE_RULES = {
  blocked: "No part of a robot may be inside. Contact with the border is allowed, as with a wall.",
  speed: "A robot whose centre is inside drives at most this fast.",
  one_way:
    "A robot whose centre is inside drives within the half angle of the heading. It may wait and turn.",
};

/** The corners of a zone; empty if it has none, as one with a mask. */
export function cornersOf(zone) {
  return Array.isArray(zone?.polygon) ? zone.polygon : [];
}

/** The request with a blocked zone from corner to corner at the end. */
export function addZone(request, a, b) {
  const polygon = [a, { x: b.x, y: a.y }, b, { x: a.x, y: b.y }].map(({ x, y }) => ({ x, y }));
  const zone = { id: unusedId(zonesOf(request), "zone-"), type: "blocked", polygon };
  return { ...objectOf(request), zones: [...zonesOf(request), zone] };
}

/** The request with members of a zone set, or removed if undefined. */
export function setZone(request, index, members) {
  return withZone(request, index, (zone) => withMembers(zone, members));
}

/**
 * The request with a zone of another type. It has the members that this type needs, and no members that it must not
 * have.
 */
export function setZoneType(request, index, type) {
  return withZone(request, index, (zone) => {
    const { linear_speed, angular_speed, heading, half_angle, ...rest } = zone;
    const limits = { linear_speed, angular_speed };
    if (type === "speed") {
      const known = linear_speed === undefined && angular_speed === undefined && zone.mask === undefined;
      return withMembers({ ...rest, type }, known ? { linear_speed: SPEED } : limits);
    }
    if (type === "one_way")
      return { ...rest, type, heading: heading ?? 0, half_angle: half_angle ?? HALF_ANGLE };
    return { ...rest, type };
  });
}

/** The request with a corner of a zone at another point. */
export function moveCorner(request, index, corner, { x, y }) {
  return withCorners(request, index, (corners) =>
    corners.map((each, at) => (at === corner ? { x, y } : each)),
  );
}

/** The request with a corner more, after one of a zone. */
export function insertCorner(request, index, after, { x, y }) {
  return withCorners(request, index, (corners) => [
    ...corners.slice(0, after + 1),
    { x, y },
    ...corners.slice(after + 1),
  ]);
}

/** The request without a corner of a zone, which keeps at least three. */
export function removeCorner(request, index, corner) {
  return withCorners(request, index, (corners) =>
    corners.length > 3 ? corners.filter((_, number) => number !== corner) : corners,
  );
}

/** The request with a zone moved by {x, y}. */
export function moveZone(request, index, by) {
  return withCorners(request, index, (corners) =>
    corners.map(({ x, y }) => ({ x: tidy(x + by.x), y: tidy(y + by.y) })),
  );
}

export function deleteZone(request, index) {
  const zones = zonesOf(request).filter((_, at) => at !== index);
  return withMembers(objectOf(request), { zones: zones.length > 0 ? zones : undefined });
}

function withCorners(request, index, change) {
  return withZone(request, index, (zone) => ({ ...zone, polygon: change(cornersOf(zone)) }));
}

function withZone(request, index, change) {
  const zones = zonesOf(request).map((zone, at) => (at === index ? change(objectOf(zone)) : zone));
  return { ...objectOf(request), zones };
}
