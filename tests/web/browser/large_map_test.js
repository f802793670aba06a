// A large map of ROS, as robots save it: map.yaml and its PGM of 2000 x 2000 cells. The page imports it as an image,
// draws, edits and plans on it.

import assert from "node:assert/strict";
import { test } from "node:test";

import { pressPlan } from "../support/browser.js";
import { WAYS } from "../support/map_files.js";
import { coloursAt, hook, pagesFor, themeColour } from "../support/on_page.js";

const SIDE = 2000; // cells
const RESOLUTION = 0.05; // metres
const ORIGIN = { x: -12.5, y: 7 };
const ROOM = 250; // cells from wall to wall
const WALL = 4;
const DOOR = { from: 100, to: 130 }; // cells of each wall of a room
const YAML = `image: building.pgm
resolution: ${RESOLUTION}
origin: [${ORIGIN.x}, ${ORIGIN.y}, 0.0]
negate: 0
occupied_thresh: 0.65
free_thresh: 0.196
`;
const [WALL_GRAY, FREE_GRAY] = [0, 254];

const onPage = pagesFor(["--default-budget-ms", "30000"]);

/** A building of rooms with a door in the middle of each wall. */
function building() {
  const isWall = (x, y) => {
    const inDoor = (along) => along % ROOM >= DOOR.from && along % ROOM < DOOR.to;
    const outside = (along) => along < WALL || along >= SIDE - WALL;
    if (outside(x) || outside(y)) return true;
    return (x % ROOM < WALL && !inDoor(y)) || (y % ROOM < WALL && !inDoor(x));
  };
  const pixels = Buffer.alloc(SIDE * SIDE);
  for (let y = 0; y < SIDE; y += 1) {
    for (let x = 0; x < SIDE; x += 1) pixels[y * SIDE + x] = isWall(x, y) ? WALL_GRAY : FREE_GRAY;
  }
  return Buffer.concat([Buffer.from(`P5\n${SIDE} ${SIDE}\n255\n`), pixels]);
}

/** The centre of a cell of the image, row 0 at the top, metres. */
const centreOf = (column, row) => ({
  x: ORIGIN.x + (column + 0.5) * RESOLUTION,
  y: ORIGIN.y + (SIDE - row - 0.5) * RESOLUTION,
});

test("a map of ROS of four million cells is imported as an image, drawn and planned on", async () => {
  await onPage(async (page) => {
    await WAYS["through the file dialog"](page, { "building.yaml": YAML, "building.pgm": building() });
    await page.waitForSelector("dialog.form-dialog[open]");
    assert.match(await page.innerText("dialog.form-dialog"), /2000 × 2000 pixels of 50 mm/);
    await page.click("dialog.form-dialog .primary");
    await page.waitForFunction(() => window.fleetplan.request?.map.image);
    const { image } = (await hook(page, "request")).map;
    assert.ok(image.png.length < 300_000, "a compressed image, not millions of letters");
    assert.deepEqual([image.resolution, image.origin], [RESOLUTION, [ORIGIN.x, ORIGIN.y, 0]]);
    const places = [centreOf(375, 375), centreOf(-40, 375)];
    const shown = await page.evaluate((all) => all.map((at) => window.fleetplan.pointOf(at)), places);
    const [floor, outside] = await coloursAt(page, shown);
    assert.deepEqual(
      [floor, outside],
      [await themeColour(page, "--scene-floor"), await themeColour(page, "--scene-void")],
    );

    await page.click("#tab-edit");
    await page.click('label[for="tool-robot"]');
    const scene = await page.locator("#scene").boundingBox();
    const onScene = async (point) => {
      const { x, y } = await page.evaluate((at) => window.fleetplan.pointOf(at), point);
      return [scene.x + x, scene.y + y];
    };
    await page.mouse.click(...(await onScene(centreOf(375, 375))));
    await page.mouse.click(...(await onScene(centreOf(625, 375))));
    const request = await hook(page, "request");
    assert.ok(request.map.image, "robots do not change the map");
    const [{ start, goal }] = request.robots;
    assert.ok(goal.x - start.x > 10);

    const answer = await pressPlan(page);
    assert.deepEqual([answer.status, answer.verified], ["solved", true]);
    const last = answer.plans[0].actions.at(-1).to;
    assert.ok(Math.hypot(last.x - goal.x, last.y - goal.y) < 1e-6);
    // It went through the door between the two rooms: the wall is crossed only there.
    const wall = centreOf(500 + WALL / 2, 0).x;
    const crossing = answer.plans[0].actions.find(({ from, to }) => from.x < wall && to.x >= wall);
    const share = (wall - crossing.from.x) / (crossing.to.x - crossing.from.x);
    const y = crossing.from.y + share * (crossing.to.y - crossing.from.y);
    const [top, bottom] = [centreOf(0, 250 + DOOR.from).y, centreOf(0, 250 + DOOR.to).y];
    assert.ok(y < top && y > bottom, `${y} is within ${bottom} and ${top}`);
  });
});
