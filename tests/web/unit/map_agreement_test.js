// The page reads maps in the same way as the service, cell by cell. A robot that is smaller than a cell stands in each
// cell, and the service reports robots that stand in an obstacle.

import assert from "node:assert/strict";
import { after, test } from "node:test";

import { readImage } from "../../../web/files/map_image.js";
import { readMovingAiMap } from "../../../web/files/movingai.js";
import { readRequestMap } from "../../../web/files/request_map.js";
import { classifyPixels, mapOfGrid, readRosYaml } from "../../../web/files/ros_map.js";
import { pgm, png } from "../support/map_files.js";
import { startService } from "../support/service.js";

const service = await startService();
after(() => service.stop());

const ORIGIN = { x: -3, y: 2 };
const SIZE = 0.5; // of a cell
const COLUMNS = 12;
const ROWS = 9;

let seed = 20261;
const random = (below) => (seed = (seed * 48271) % 2147483647) % below;
const oneOf = (list) => list[random(list.length)];
const rowsOf = (channels, most) =>
  Array.from({ length: ROWS }, () => Array.from({ length: COLUMNS * channels }, () => random(most + 1)));

/** The rows that the service has of the map: "." free, "#" blocked. */
async function rowsOfService(map) {
  const robots = Array.from({ length: ROWS * COLUMNS }, (_, at) => ({
    id: `${at}`,
    start: {
      x: ORIGIN.x + ((at % COLUMNS) + 0.5) * SIZE,
      y: ORIGIN.y + (ROWS - Math.floor(at / COLUMNS) - 0.5) * SIZE,
    },
  }));
  const robot_defaults = { radius: 0.1 * SIZE, linear_speed: 1, angular_speed: 1 };
  const body = JSON.stringify({ map, robot_defaults, robots, options: { invalid_robots: "report" } });
  const headers = { "Content-Type": "application/json" };
  const answer = await fetch(new URL("v1/plan", service.url), { method: "POST", headers, body });
  const { plans, unplanned, detail } = await answer.json();
  assert.equal(answer.status, 200, detail);
  const letters = Array(robots.length);
  for (const { robot } of plans) letters[robot] = ".";
  for (const { robot, reason } of unplanned) letters[robot] = reason === "invalid" ? "#" : reason;
  return Array.from({ length: ROWS }, (_, row) => letters.slice(row * COLUMNS, (row + 1) * COLUMNS).join(""));
}

/** The rows that the page draws of the map of a request. */
async function rowsOfPage(map) {
  const read = await readRequestMap(map);
  return read?.rows.map((row) => row.replaceAll(/[@OTW]/g, "#").replaceAll("G", "."));
}

async function assertAgree(map) {
  const drawn = await rowsOfPage(map);
  assert.deepEqual(drawn, await rowsOfService(map), JSON.stringify(map));
  return drawn;
}

/** Members of a map.yaml at random. */
function description() {
  const [low, high] = [random(101) / 100, random(101) / 100].sort((a, b) => a - b);
  const thresholds = oneOf([
    { occupied_thresh: 0.65, free_thresh: 0.196 },
    { occupied_thresh: 0.65, free_thresh: 0.25 },
    { occupied_thresh: high, free_thresh: low },
    {},
  ]);
  return {
    resolution: SIZE,
    origin: [ORIGIN.x, ORIGIN.y, 0],
    negate: oneOf([0, 1, false, true]),
    mode: oneOf(["trinary", "scale", "raw"]),
    ...oneOf([{}, { release: "jazzy" }, { release: "humble" }]),
    ...thresholds,
  };
}

const imageMap = (file) => ({ image: { ...file, ...description() }, unknown: oneOf(["blocked", "free"]) });

function plainPgm(rows, largest) {
  const lines = rows.map((row) => row.join(oneOf([" ", "\n", "  # gray\n"])));
  return `P2 # a comment\n${COLUMNS} ${ROWS}\n${largest}\n${lines.join("\n")}\n`;
}

function rawPgm(rows, largest) {
  const bytes = largest > 255 ? rows.flat().flatMap((gray) => [gray >> 8, gray & 255]) : rows.flat();
  return Buffer.concat([Buffer.from(`P5\n${COLUMNS} ${ROWS} ${largest}\n`), Buffer.from(bytes)]);
}

test("graymaps have the same cells on the page and in the service", async () => {
  for (let round = 0; round < 60; round += 1) {
    const largest = oneOf([1, 3, 100, 254, 255, 255, 256, 1000, 65535]);
    const write = oneOf([plainPgm, rawPgm]);
    await assertAgree(imageMap({ pgm: Buffer.from(write(rowsOf(1, largest), largest)).toString("base64") }));
  }
});

test("PNGs of every form have the same cells on the page and in the service", async () => {
  const forms = [0, 2, 4, 6].flatMap((type) =>
    (type === 0 ? [1, 2, 4, 8, 16] : [8, 16]).map((depth) => ({ type, depth })),
  );
  for (const { type, depth } of forms) {
    const channels = { 0: 1, 2: 3, 4: 2, 6: 4 }[type];
    for (let round = 0; round < 6; round += 1) {
      const rows = rowsOf(channels, 2 ** depth - 1);
      if (channels % 2 === 0 && round < 3) makeOpaque(rows, channels, 2 ** depth - 1);
      const clear = rows[0].slice(0, channels).flatMap((value) => [value >> 8, value & 255]);
      const chunks = type <= 2 && round > 3 ? { tRNS: clear } : {};
      const file = png(type, rows, { depth, interlaced: round % 2 === 1, chunks });
      await assertAgree(imageMap({ png: file.toString("base64") }));
    }
  }
});

test("PNGs with palettes have the same cells on the page and in the service", async () => {
  for (const depth of [1, 2, 4, 8]) {
    const PLTE = Array.from({ length: 3 * 2 ** depth }, () => random(256));
    for (const chunks of [{ PLTE }, { PLTE, tRNS: [0, 128] }]) {
      const file = png(3, rowsOf(1, 2 ** depth - 1), { depth, chunks });
      await assertAgree(imageMap({ png: file.toString("base64") }));
    }
  }
});

function makeOpaque(rows, channels, opaque) {
  for (const row of rows)
    for (let at = channels - 1; at < row.length; at += channels) if (random(4) > 0) row[at] = opaque;
}

/** An origin with which a turned map of the same size lies where ORIGIN has it: only halves of a turn keep its size. */
const halfTurned = (yaw) => [ORIGIN.x + COLUMNS * SIZE, ORIGIN.y + ROWS * SIZE, yaw];

test("maps that are turned have the same cells on the page and in the service", async () => {
  for (const yaw of [Math.PI, -3.1416, 3 * Math.PI]) {
    const map = imageMap({ pgm: Buffer.from(rawPgm(rowsOf(1, 255), 255)).toString("base64") });
    map.image.origin = halfTurned(yaw);
    await assertAgree(map);
    const [x, y] = halfTurned(yaw);
    const orientation = { x: 0, y: 0, z: Math.sin(yaw / 2), w: Math.cos(yaw / 2) };
    const info = {
      resolution: SIZE,
      width: COLUMNS,
      height: ROWS,
      origin: { position: { x, y, z: 0 }, orientation },
    };
    const data = Array.from({ length: COLUMNS * ROWS }, () => random(102) - 1);
    await assertAgree({ occupancy_grid: { info, data } });
  }
});

test("occupancy grids and MovingAI maps have the same cells on the page and in the service", async () => {
  for (let round = 0; round < 10; round += 1) {
    const origin = { position: { ...ORIGIN, z: 0 }, orientation: { x: 0, y: 0, z: 0, w: 1 } };
    const info = { resolution: SIZE, width: COLUMNS, height: ROWS, origin };
    const data = Array.from({ length: COLUMNS * ROWS }, () => random(102) - 1);
    await assertAgree({ occupancy_grid: { info, data }, unknown: oneOf(["blocked", "free"]) });
    const lines = Array.from({ length: ROWS }, () =>
      Array.from({ length: COLUMNS }, () => oneOf([...".GS@OTW#"])).join(""),
    );
    const movingai = `type octile\nheight ${ROWS}\nwidth ${COLUMNS}\nmap\n${lines.join(oneOf(["\n", "\r\n"]))}\n`;
    await assertAgree({ movingai, resolution: SIZE, origin: ORIGIN });
  }
});

test("files that are imported have the cells of the same files in a request", async () => {
  const grays = rowsOf(1, 255);
  const yaml = `image: a.pgm\nresolution: ${SIZE}\norigin: [${ORIGIN.x}, ${ORIGIN.y}, 0.0]\nnegate: 0
occupied_thresh: 0.65\nfree_thresh: 0.196\n`;
  const grid = classifyPixels(readRosYaml(yaml), await readImage(new Uint8Array(pgm(grays))));
  const image = {
    pgm: pgm(grays).toString("base64"),
    resolution: SIZE,
    origin: [ORIGIN.x, ORIGIN.y, 0],
    ...{ negate: 0, occupied_thresh: 0.65, free_thresh: 0.196 },
  };
  const expected = await rowsOfService({ image });
  assert.deepEqual(mapOfGrid(grid, false).rows, expected);
  assert.ok(expected.join("").includes("#") && expected.join("").includes("."));
  const lines = expected.map((row) => row.replaceAll("#", "@"));
  const movingai = `type octile\nheight ${ROWS}\nwidth ${COLUMNS}\nmap\n${lines.join("\n")}`;
  assert.deepEqual(readMovingAiMap(movingai).rows, lines);
  assert.deepEqual(await rowsOfService({ movingai, resolution: SIZE, origin: ORIGIN }), expected);
});
