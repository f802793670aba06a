import assert from "node:assert/strict";
import { test } from "node:test";

import { diskOf, groupFaults, placeOfFault } from "../../../web/model/faults.js";
import { readScene } from "../../../web/model/scene.js";

const REQUEST = {
  map: { rows: ["....", "...."], resolution: 2 },
  robot_defaults: { radius: 0.4 },
  robots: [
    { id: "a", start: { x: 1, y: 1 }, goal: { x: 3, y: 1 } },
    { id: "b", start: { x: "u", y: 1 } },
  ],
  obstacles: [
    {
      id: "cart",
      radius: -1,
      motion: [
        { t: 0, x: 5, y: 1 },
        { t: 9, x: 7, y: 3 },
      ],
    },
  ],
  zones: [{ id: "lab", type: "blocked", polygon: [{ x: 2, y: 2 }, { x: 3 }] }],
};
const placeOf = (pointer) => placeOfFault(REQUEST, readScene(REQUEST), pointer);

test("faults with the same detail are one group, and each place is named once", () => {
  const missing = "linear_speed is missing.";
  const errors = [
    { pointer: "/robots/0/linear_speed", detail: missing },
    { pointer: "/robots/1/start/x", detail: "x must be a number." },
    { pointer: "/robots/1/linear_speed", detail: missing },
    { pointer: "/robots/1/linear_speed", detail: missing },
    { detail: "It is too large." },
  ];
  assert.deepEqual(groupFaults(errors), [
    { detail: missing, pointers: ["/robots/0/linear_speed", "/robots/1/linear_speed"] },
    { detail: "x must be a number.", pointers: ["/robots/1/start/x"] },
    { detail: "It is too large.", pointers: [""] },
  ]);
});

test("faults are at robots and their goals, at rows, obstacles and zones", () => {
  assert.deepEqual(placeOf("/robots/0/linear_speed"), { x: 1, y: 1, radius: 0.4 });
  assert.deepEqual(placeOf("/robots/0/goal"), { x: 3, y: 1, radius: 0.4 });
  assert.deepEqual(placeOf("/map/rows/1"), { x: 4, y: 1 });
  assert.deepEqual(placeOf("/obstacles/0/radius"), { t: 0, x: 5, y: 1 });
  assert.deepEqual(placeOf("/obstacles/0/motion/1/t"), { t: 9, x: 7, y: 3 });
  assert.deepEqual(placeOf("/zones/0/polygon/1/y"), { x: 2, y: 2 });
});

test("what has no place in the scene leads nowhere in it", () => {
  for (const pointer of [
    "",
    "/options/seed",
    "/robots",
    "/robots/1/start/x",
    "/robots/9",
    "/zones/4",
    "/extra",
  ]) {
    assert.equal(placeOf(pointer), null, pointer);
  }
  assert.equal(diskOf(null, readScene(null), "/robots/0"), null);
});
