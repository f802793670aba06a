import assert from "node:assert/strict";
import { test } from "node:test";

import { readZones } from "../../../web/model/zones.js";

const POLYGON = [
  { x: 0, y: 0 },
  { x: 4, y: 0 },
  { x: 4, y: 2 },
  { x: 0, y: 2 },
];

test("zones are drawn with their rules as labels", () => {
  const zones = readZones({
    zones: [
      { id: "lab", type: "blocked", polygon: POLYGON },
      { id: "ward", type: "speed", polygon: POLYGON, linear_speed: 0.5, angular_speed: 1 },
      { id: "east", type: "one_way", polygon: POLYGON, heading: 0, half_angle: 1 },
    ],
  });
  assert.deepEqual(
    zones.map(({ label }) => label),
    ["lab: blocked", "ward: at most 0.5 m/s, 1 rad/s", "east: one-way"],
  );
  assert.deepEqual(
    zones.map(({ heading }) => heading),
    [null, null, 0],
  );
  assert.deepEqual(zones[0].middle, { x: 2, y: 1 });
});

test("faulty zones are left out", () => {
  assert.deepEqual(readZones(null), []);
  assert.deepEqual(readZones({ zones: "lab" }), []);
  const faulty = [
    null,
    { id: "line", type: "blocked", polygon: POLYGON.slice(0, 2) },
    { id: "odd", type: "round", polygon: POLYGON },
    { id: "lost", type: "speed", polygon: [...POLYGON, { x: 1 }] },
  ];
  assert.deepEqual(readZones({ zones: faulty }), []);
});
