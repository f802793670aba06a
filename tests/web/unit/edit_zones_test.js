import assert from "node:assert/strict";
import { test } from "node:test";

import * as zones from "../../../web/model/edit_zones.js";

const at = (x, y) => ({ x, y });
const EMPTY = { map: { rows: [".."] }, robots: [] };
const drawn = zones.addZone(EMPTY, at(1, 1), at(3, 2));

test("a zone is drawn from corner to corner, blocked, with a fresh id", () => {
  assert.deepEqual(drawn.zones, [
    { id: "zone-1", type: "blocked", polygon: [at(1, 1), at(3, 1), at(3, 2), at(1, 2)] },
  ]);
  assert.equal(zones.addZone(drawn, at(0, 0), at(1, 1)).zones[1].id, "zone-2");
  assert.equal("zones" in EMPTY, false);
});

test("a zone of another type has the members that it needs, and no others", () => {
  const slow = zones.setZoneType(drawn, 0, "speed");
  assert.equal(slow.zones[0].linear_speed, 0.5);
  const oneWay = zones.setZoneType(slow, 0, "one_way");
  assert.deepEqual(
    [oneWay.zones[0].heading, oneWay.zones[0].half_angle, "linear_speed" in oneWay.zones[0]],
    [0, 1.5708, false],
  );
  assert.deepEqual(zones.setZoneType(oneWay, 0, "blocked"), drawn);
  const turning = zones.setZone(slow, 0, { linear_speed: undefined, angular_speed: 1 });
  assert.deepEqual(zones.setZoneType(turning, 0, "speed"), turning, "a limit that is there stays alone");
});

test("corners are moved, added and removed, and the zone is moved", () => {
  const corners = (request) => request.zones[0].polygon;
  assert.deepEqual(corners(zones.moveCorner(drawn, 0, 2, at(4, 3)))[2], at(4, 3));
  assert.deepEqual(corners(zones.insertCorner(drawn, 0, 3, at(0, 1.5))), [...corners(drawn), at(0, 1.5)]);
  const triangle = zones.removeCorner(drawn, 0, 0);
  assert.deepEqual(corners(triangle), corners(drawn).slice(1));
  assert.deepEqual(corners(zones.removeCorner(triangle, 0, 0)), corners(triangle), "three are the least");
  assert.deepEqual(corners(zones.moveZone(drawn, 0, at(0.1, -0.2)))[0], at(1.1, 0.8));
});

test("without its last zone, a request has none", () => {
  assert.deepEqual(zones.deleteZone(drawn, 0), EMPTY);
});
