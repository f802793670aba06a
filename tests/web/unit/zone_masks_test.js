import assert from "node:assert/strict";
import { test } from "node:test";

import { MAP_WORK } from "../../../web/files/map_work.js";
import { prepareRequest } from "../../../web/files/prepare.js";
import { maskOf } from "../../../web/model/drawn_map.js";
import { readScene } from "../../../web/model/scene.js";
import { opacityOf } from "../../../web/scene/mask_raster.js";
import { pgm, png } from "../support/map_files.js";

const prepareMasks = (request) => prepareRequest(request, MAP_WORK, async () => {});
const base64 = (bytes) => bytes.toString("base64");
const maskZone = (type, mask) => ({ id: "lab", type, mask });

test("the percentages of a mask are those that the service reads", async () => {
  const trinary = { pgm: base64(pgm([[0, 254, 205]])) };
  const raw = { png: base64(png(0, [[30, 100, 255]])), mode: "raw" };
  await prepareMasks({ zones: [maskZone("blocked", trinary), maskZone("speed", raw)] });
  assert.deepEqual([...maskOf(trinary).percents], [100, 0, 0]);
  assert.deepEqual([...maskOf(raw).percents], [30, 100, 0]);
});

test("a mask lies on the cells of the map, with its name in the middle of what it marks", async () => {
  const mask = {
    pgm: base64(
      pgm([
        [254, 0, 0],
        [254, 254, 254],
      ]),
    ),
  };
  const request = { map: { rows: ["...", "..."], resolution: 2 }, zones: [maskZone("blocked", mask)] };
  assert.deepEqual(readScene(request).zones, [], "before it is read");
  await prepareMasks(request);
  const [zone] = readScene(request).zones;
  assert.deepEqual([zone.middle, zone.label], [{ x: 4, y: 3 }, "lab: blocked"]);
  assert.deepEqual(zone.bounds, { left: 0, bottom: 0, right: 6, top: 4 });
});

test("a mask in a frame of its own lies there, turned and of its own size", async () => {
  const mask = { pgm: base64(pgm([[0, 254, 254]])), resolution: 0.5, origin: [3, 1, Math.PI / 2] };
  const request = { map: { rows: ["....", "...."] }, zones: [maskZone("blocked", mask)] };
  await prepareMasks(request);
  assert.deepEqual([...maskOf(mask).percents], [0, 0, 100], "from the top");
  const [zone] = readScene(request).zones;
  assert.deepEqual(zone.bounds, { left: 2.5, bottom: 1, right: 3, top: 2.5 });
  assert.deepEqual(zone.middle, { x: 2.75, y: 1.25 });
});

test("a mask of speeds limits to base and multiplier", async () => {
  const limitsOf = async (given) => {
    const mask = { pgm: base64(pgm([[191]])), mode: "scale", occupied_thresh: 1, free_thresh: 0, ...given };
    await prepareMasks({ map: { rows: ["."] }, zones: [maskZone("speed", mask)] });
    const { percents, limits } = maskOf(mask);
    return limits[percents[0]];
  };
  assert.equal(await limitsOf({}), 75);
  assert.equal(await limitsOf({ base: 0, multiplier: 1 }), 25);
  assert.equal(await limitsOf({ base: 200 }), 0);
});

test("masks of another size, and those that cannot be read, are not drawn", async () => {
  const small = { pgm: base64(pgm([[0]])) };
  const broken = { pgm: "not base64!" };
  const request = {
    map: { rows: [".."] },
    zones: [maskZone("blocked", small), maskZone("blocked", broken), null],
  };
  await prepareMasks(request);
  assert.deepEqual(readScene(request).zones, []);
});

test("blocked cells are marked fully, slow ones the more the slower", () => {
  assert.deepEqual([opacityOf("blocked", 64), opacityOf("blocked", 65) > 0], [0, true]);
  assert.equal(opacityOf("speed", 0), 0);
  assert.ok(opacityOf("speed", 10) > opacityOf("speed", 90));
  assert.ok(opacityOf("speed", 100) > 0);
});
