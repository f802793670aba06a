import assert from "node:assert/strict";
import { test } from "node:test";

import { MAP_WORK } from "../../../web/files/map_work.js";
import { prepareRequest } from "../../../web/files/prepare.js";
import { requestMapOf } from "../../../web/files/request_map.js";
import { mapOfGrid } from "../../../web/files/ros_map.js";
import { asRows } from "../../../web/model/drawn_map.js";
import { setCells, setOrigin } from "../../../web/model/edit_request.js";
import { readScene } from "../../../web/model/scene.js";
import { pgm } from "../support/map_files.js";

const GRAYS = [
  [0, 205, 254],
  [254, 254, 0],
];
const IMAGE = {
  pgm: pgm(GRAYS).toString("base64"),
  resolution: 0.5,
  origin: [1, -2, 0],
  negate: 0,
  occupied_thresh: 0.65,
  free_thresh: 0.196,
  mode: "trinary",
};
const GRID = {
  info: { resolution: 0.5, width: 3, height: 2, origin: { position: { x: 1, y: -2, z: 0 } } },
  data: [25, 0, 65, 100, -1, 0], // from the bottom
};

async function drawn(map) {
  await prepareRequest({ map }, MAP_WORK, async () => {});
  return asRows(map);
}

test("an image is drawn as map_server reads it", async () => {
  const rows = { resolution: 0.5, origin: { x: 1, y: -2 } };
  assert.deepEqual(await drawn({ image: IMAGE }), { ...rows, rows: ["##.", "..#"] });
  assert.deepEqual(await drawn({ image: IMAGE, unknown: "free" }), { ...rows, rows: ["#..", "..#"] });
  assert.deepEqual((await drawn({ image: { ...IMAGE, negate: 1 } })).rows, [".##", "##."]);
});

test("an occupancy grid is drawn from the bottom row up", async () => {
  const rows = { resolution: 0.5, origin: { x: 1, y: -2 } };
  assert.deepEqual(await drawn({ occupancy_grid: GRID }), { ...rows, rows: ["##.", "..#"] });
  assert.deepEqual((await drawn({ occupancy_grid: GRID, unknown: "free" })).rows, ["#..", "..#"]);
  assert.deepEqual((await drawn({ occupancy_grid: { ...GRID, data: [26, 64, -1, 0, 0, 0] } })).rows, [
    "...",
    "###",
  ]);
});

test("a text of MovingAI is drawn", async () => {
  const movingai = "type octile\nheight 2\nwidth 3\nmap\n@T.\n..S\n";
  assert.deepEqual(await drawn({ movingai, resolution: 2 }), {
    rows: ["@T.", "..."],
    resolution: 2,
    origin: { x: 0, y: 0 },
  });
});

test("a faulty map is not drawn", async () => {
  for (const map of [
    null,
    7,
    {},
    { rows: 7 },
    { image: { ...IMAGE, pgm: "%" } },
    { image: { ...IMAGE, pgm: "UDUK" } },
    { image: { ...IMAGE, resolution: 0 } },
    { occupancy_grid: { ...GRID, data: [0] } },
    { occupancy_grid: {} },
    { movingai: "map" },
  ]) {
    assert.equal(await drawn(map), null, JSON.stringify(map));
    assert.equal(readScene({ map }).grid, null);
  }
});

test("a map becomes rows when it is edited, and all else is kept", async () => {
  const request = { map: { image: IMAGE }, robots: [], zones: [{ id: "z" }], metadata: { site: 7 } };
  await drawn(request.map);
  const { grid } = readScene(request);
  assert.deepEqual([grid.columns, grid.rows, grid.resolution], [3, 2, 0.5]);
  assert.deepEqual(grid.bounds, { left: 1, bottom: -2, right: 2.5, top: -1 });
  const edited = setCells(request, [{ column: 1, row: 0 }], false, grid);
  assert.deepEqual(edited, {
    ...request,
    map: { rows: ["#..", "..#"], resolution: 0.5, origin: { x: 1, y: -2 } },
  });
  assert.deepEqual(setOrigin(request, "x", 4).map.origin, { x: 4, y: -2 });
  assert.deepEqual(request.map, { image: IMAGE });
});

test("a large imported map becomes an image, and a small one rows", async () => {
  const grid = { columns: 600, rows: 500, resolution: 0.05, origin: { x: 1, y: -2 } };
  const cells = Uint8Array.from({ length: 300_000 }, (_, at) => (at * 7) % 3); // free, occupied and unknown ones
  const { map, rows } = await requestMapOf({ ...grid, cells }, true);
  assert.deepEqual(map.image.origin, [1, -2, 0]);
  assert.equal(map.unknown, "free");
  assert.deepEqual(rows, mapOfGrid({ ...grid, cells }, true));
  assert.deepEqual(await drawn(map), rows, "as it is read again");
  assert.ok(map.image.png.length < 30_000);
  const small = { ...grid, columns: 3, rows: 1, cells: cells.subarray(0, 3) };
  assert.deepEqual((await requestMapOf(small, false)).map, mapOfGrid(small, false));
});
