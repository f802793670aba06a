import assert from "node:assert/strict";
import { test } from "node:test";

import { rememberMask } from "../../../web/model/drawn_map.js";
import { readGrid } from "../../../web/model/scene.js";
import { TravelField } from "../../../web/model/travel_field.js";
import { roomOf } from "../../../web/model/travel_room.js";

const ROWS = ["......", ".##...", "......"];
const corners = (left, bottom, right, top) => [
  { x: left, y: bottom },
  { x: right, y: bottom },
  { x: right, y: top },
  { x: left, y: top },
];

/** A picture of the cells: "o" where the robot has a place, "." where not. */
async function placesOf(request, radius) {
  const grid = readGrid(request.map, null);
  const room = await roomOf(request, grid, { id: "a", radius });
  const field = new TravelField(grid);
  const cells = Array(grid.columns * grid.rows).fill(".");
  for await (const { at } of room.placesIn(field)) cells[at] = "o";
  assert.equal(field.known, cells.filter((cell) => cell === ".").length);
  return grid.lines.map((_, row) => cells.slice(row * grid.columns, (row + 1) * grid.columns).join(""));
}

test("a robot has a place where its disk touches no wall and does not leave the map", async () => {
  assert.deepEqual(await placesOf({ map: { rows: ROWS } }, 0.5), ["oooooo", "o..ooo", "oooooo"]);
  assert.deepEqual(await placesOf({ map: { rows: ROWS } }, 0.6), ["......", "....o.", "......"]);
});

test("zones that are blocked for the robot are walls", async () => {
  const zone = { id: "z", type: "blocked", polygon: corners(4, 0, 5, 2) };
  const withZone = (more) => ({ map: { rows: ROWS }, zones: [{ ...zone, ...more }] });
  const open = ["oooooo", "o..ooo", "oooooo"];
  assert.deepEqual(await placesOf(withZone({}), 0.5), ["oooooo", "o..o.o", "oooo.o"]);
  assert.deepEqual(await placesOf(withZone({ robots: ["b"] }), 0.5), open);
  assert.deepEqual(await placesOf(withZone({ enter: false }), 0.5), open);
  assert.deepEqual(await placesOf(withZone({ type: "speed", linear_speed: 1 }), 0.5), open);
});

test("a mask blocks the cells that are occupied on it", async () => {
  const mask = {};
  const percents = Uint8Array.from({ length: 18 }, (_, at) => (at % 6 === 5 ? 100 : at % 6 === 4 ? 20 : 0));
  rememberMask(mask, { columns: 6, rows: 3, percents, isFramed: false });
  const request = { map: { rows: ROWS }, zones: [{ id: "z", type: "blocked", mask }] };
  assert.deepEqual(await placesOf(request, 0.5), ["ooooo.", "o..oo.", "ooooo."]);
});

test("in a square of several cells, the place nearest to its middle is taken", async () => {
  const rows = Array.from({ length: 200 }, (_, row) => (row % 2 === 0 ? "#" : ".").repeat(200));
  const grid = readGrid({ rows }, null);
  const field = new TravelField(grid);
  assert.equal(field.cells, 2);
  const room = await roomOf({ map: { rows } }, grid, { id: "a", radius: 0.5 });
  let count = 0;
  for await (const { at, place } of room.placesIn(field)) {
    const middle = field.middleOf(at);
    assert.ok(Math.hypot(place.x - middle.x, place.y - middle.y) <= field.size / 2);
    count += 1;
  }
  assert.equal(count, field.count);
});
