// The list of a thousand robots, of which only the part in sight is in the document. In headless Chromium.

import assert from "node:assert/strict";
import { test } from "node:test";

import { hallWith } from "../support/hall.js";
import { hook, pagesFor, paste } from "../support/on_page.js";

const onPage = pagesFor();
const ROBOTS = 1000;

const HALL = hallWith(ROBOTS);

async function opened(page) {
  await paste(page, HALL);
  await page.waitForFunction((count) => window.fleetplan.request.robots.length === count, ROBOTS);
  await page.waitForSelector("#robots .robot");
}

const rowsOf = (page) =>
  page.evaluate(() => [...document.querySelectorAll("#robots .robot")].map((row) => row.dataset.robot));

for (const [kind, options] of [
  ["desktop", {}],
  ["phone", { viewport: { width: 390, height: 844 }, isMobile: true, hasTouch: true }],
]) {
  test(`a thousand robots need few rows, and any of them is scrolled to, ${kind}`, async () => {
    await onPage(
      async (page) => {
        await opened(page);
        assert.ok((await rowsOf(page)).length <= 200, `${(await rowsOf(page)).length} rows`);
        const height = await page.evaluate(() => document.getElementById("robots").offsetHeight);
        const row = await page.evaluate(() => document.querySelector("#robots .robot").offsetHeight);
        assert.equal(height, ROBOTS * row, "the scroll bar is that of all rows");
        await page.evaluate(() => document.querySelector("#robots .chunk:last-child").scrollIntoView(false));
        await page.waitForSelector('.robot[data-robot="robot-999"]');
        await page.waitForFunction(() => document.querySelectorAll("#robots .robot").length <= 200);
        const last = page.locator('[role="listitem"]:has([data-robot="robot-999"])');
        assert.equal(await last.getAttribute("aria-posinset"), "1000");
        assert.equal(await last.getAttribute("aria-setsize"), "1000");
        await page.click('.robot[data-robot="robot-999"]');
        assert.equal(await hook(page, "selected"), "robot-999");
      },
      { options },
    );
  });
}

test("a robot that is found elsewhere is shown in the list", async () => {
  await onPage(async (page) => {
    await opened(page);
    const box = await page.locator("#scene").boundingBox();
    const { x, y } = await page.evaluate(() => window.fleetplan.screenOf("robot-700"));
    await page.mouse.click(box.x + x, box.y + y);
    await page.waitForSelector('.robot[data-robot="robot-700"][aria-pressed="true"]');
    assert.ok(await page.isVisible('.robot[data-robot="robot-700"]'));
  });
});

test("the arrow keys lead from row to row beyond those that are there", async () => {
  await onPage(async (page) => {
    await opened(page);
    await page.focus('.robot[data-robot="robot-0"]');
    for (let row = 1; row <= 60; row += 1) await page.keyboard.press("ArrowDown");
    await page.waitForSelector('.robot[data-robot="robot-60"]:focus');
  });
});
