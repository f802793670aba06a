// From files of a map to a plan on it, as somebody who sees the page for the first time, in headless Chromium.

import assert from "node:assert/strict";
import { test } from "node:test";

import { drop, pgm } from "../support/map_files.js";
import { coloursAt, hook, pagesFor, themeColour } from "../support/on_page.js";
import { press, windowPoint } from "../support/scene_pointer.js";

const onPage = pagesFor();
const PHONE = { viewport: { width: 390, height: 844 }, isMobile: true, hasTouch: true };

/** Two rooms of 3 m by 4 m with a door, in pixels of 0.05 m. */
const FREE = (column, row) =>
  column > 2 && column < 121 && row > 2 && row < 78 && (Math.abs(column - 62) > 2 || Math.abs(row - 40) < 12);
const ROOMS = {
  "rooms.yaml": "image: rooms.pgm\nresolution: 0.05\norigin: [-1, 2, 0]\nnegate: 0\n",
  "rooms.pgm": pgm(
    Array.from({ length: 81 }, (_, row) =>
      Array.from({ length: 124 }, (__, column) => (FREE(column, row) ? 254 : 0)),
    ),
  ),
};

async function importRooms(page) {
  await drop(page, ROOMS);
  await page.click("dialog[open] .primary");
  await page.waitForFunction(() => window.fleetplan.request.robots.length === 0);
}

const says = (page, words) =>
  page.waitForFunction((text) => document.getElementById("placing").innerText.includes(text), words);

for (const [size, options] of [
  ["desktop", {}],
  ["phone", PHONE],
]) {
  test(`a dropped map is planned on after two clicks for each robot, ${size}`, async () => {
    await onPage(
      async (page) => {
        await page.waitForSelector("#welcome:not([hidden])");
        await importRooms(page);
        const click = async (point) => {
          const { x, y } = await windowPoint(page, point);
          await (size === "phone" ? page.touchscreen.tap(x, y) : page.mouse.click(x, y));
        };
        await says(page, "Click where a robot starts.");
        await click({ x: 0, y: 3 });
        await says(page, "Click where robot-1 goes.");
        await click({ x: 4, y: 5 });
        await says(page, "Click where the next robot starts.");
        await click({ x: 4, y: 3 });
        await click({ x: 0, y: 5 });
        await says(page, "2 robots: all fit.");
        const plan = await page.locator("#placing-plan").boundingBox();
        const tools = await page.locator(".tool-bar").boundingBox();
        assert.ok(plan.y + plan.height <= (size === "phone" ? tools.y : 900), "the button is in sight");
        await page.click("#placing-plan");
        await page.waitForFunction(() => window.fleetplan.time > 0);
        const { status, verified, plans } = await hook(page, "answer");
        assert.deepEqual([status, verified, plans.length], ["solved", true, 2]);
        const { robots } = await hook(page, "request");
        const near = (pose, x, y) => Math.hypot(pose.x - x, pose.y - y) < 0.06;
        assert.ok(near(robots[0].start, 0, 3) && near(robots[0].goal, 4, 5), JSON.stringify(robots[0]));
        assert.ok(near(robots[1].start, 4, 3) && near(robots[1].goal, 0, 5), JSON.stringify(robots[1]));
      },
      { options: { ...options, isNew: true } },
    );
  });
}

test("a robot is shown to scale before it is placed, beside the wall that it would touch", async () => {
  await onPage(async (page) => {
    await importRooms(page);
    const rim = async (point) => {
      const { x, y } = await windowPoint(page, point);
      await page.mouse.move(x, y);
      const box = await page.locator("#scene").boundingBox();
      const scale = await page.evaluate(
        () => window.fleetplan.pointOf({ x: 1, y: 0 }).x - window.fleetplan.pointOf({ x: 0, y: 0 }).x,
      );
      return { centre: { x: x - box.x, y: y - box.y }, radius: 0.2 * scale };
    };
    const { centre, radius } = await rim({ x: 0.025, y: 3.975 });
    const [inside, outside] = await coloursAt(page, [
      { x: centre.x + radius - 3, y: centre.y },
      { x: centre.x + radius + 3, y: centre.y },
    ]);
    const floor = await themeColour(page, "--scene-floor");
    assert.notEqual(inside, floor);
    assert.equal(outside, floor);

    await press(page, { x: -0.8, y: 4 }); // 0.05 m from the wall
    const { robots } = await hook(page, "request");
    assert.ok(robots[0].start.x > -0.68 && robots[0].start.x < -0.6, `${robots[0].start.x}`);
    await page.keyboard.press("Escape");
    await press(page, { x: 2.1, y: 3 }); // in the wall between the rooms
    assert.equal((await hook(page, "request")).robots.length, 1);
    assert.match(await page.innerText("#announcer"), /radius of 200 mm does not fit here/);
  });
});

test("robots that do not fit with another radius are told", async () => {
  await onPage(async (page) => {
    await importRooms(page);
    for (const point of [
      { x: -0.6, y: 4 },
      { x: 4, y: 4 },
    ])
      await press(page, point);
    await says(page, "1 robot: fits.");
    await page.fill("#placing-radius input", "0.5");
    await says(page, "robot-1 does not fit: too near to a wall or another robot at its start.");
    assert.equal((await hook(page, "request")).robot_defaults.radius, 0.5);
    await page.fill("#placing-radius input", "0.15");
    await says(page, "1 robot: fits.");
  });
});

test("start and goal are placed by keys alone", async () => {
  await onPage(async (page) => {
    await importRooms(page);
    for (let step = 0; step < 20; step += 1) await page.keyboard.press("ArrowLeft");
    await page.keyboard.press("Enter");
    for (let step = 0; step < 40; step += 1) await page.keyboard.press("ArrowRight");
    await page.keyboard.press("Enter");
    const [{ start, goal }] = (await hook(page, "request")).robots;
    assert.ok(goal.x - start.x > 1.5, JSON.stringify({ start, goal }));
    assert.match(await page.innerText("#announcer"), /^robot-1 starts at .* m, with its goal at/);
  });
});

test("on a new map, walls are drawn first, and a button leads to robots", async () => {
  await onPage(async (page) => {
    await page.click("#tab-edit");
    await page.evaluate(() => document.getElementById("new-map").requestSubmit());
    await says(page, "Drag to draw walls.");
    await page.click("#placing-robots");
    await says(page, "Click where a robot starts.");
    assert.equal(await page.isChecked("#tool-robot"), true);
  });
});
