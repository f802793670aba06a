// Typing a time, the ruler, the scale bar.

import assert from "node:assert/strict";
import { test } from "node:test";

import { choose, pressPlan } from "../support/browser.js";
import { hasTime, hook, pagesFor } from "../support/on_page.js";

const onPage = pagesFor();
const PHONE = { viewport: { width: 390, height: 844 }, isMobile: true, hasTouch: true };

test("a time is typed by keys alone", async () => {
  await onPage(async (page) => {
    await choose(page, "crossing");
    const { makespan } = await pressPlan(page);
    await page.waitForFunction(() => window.fleetplan.time > 0);
    await page.keyboard.press("j");
    assert.equal(await hook(page, "playing"), false);
    await page.keyboard.type("3,25");
    await page.keyboard.press("Enter");
    await hasTime(page, 3.25);
    await page.keyboard.press("Enter"); // on the clock, which has the focus
    await page.keyboard.type("50 %");
    await page.keyboard.press("Enter");
    await hasTime(page, makespan / 2);
    await page.keyboard.press("j");
    await page.keyboard.type("soon");
    await page.keyboard.press("Enter");
    assert.equal(await page.isVisible("#time-entry"), true);
    assert.match(await page.evaluate(() => document.activeElement.validationMessage), /Enter seconds/);
    await page.keyboard.press("Escape");
    assert.equal(await page.isVisible("#time-entry"), false);
    await hasTime(page, makespan / 2);
  });
});

/** What the page announces last. */
const announced = (page) => page.innerText("#announcer");

for (const [size, options] of [
  ["desktop", {}],
  ["phone", PHONE],
]) {
  test(`the ruler measures between robots, ${size}`, async () => {
    await onPage(
      async (page) => {
        const { robots } = await choose(page, "corridor-swap");
        await page.click("#ruler");
        const canvas = await page.locator("#scene").boundingBox();
        const places = await page.evaluate(
          (ids) => ids.map((id) => window.fleetplan.screenOf(id)),
          robots.map(({ id }) => id),
        );
        const [a, b] = places.map(({ x, y }) => ({ x: canvas.x + x + 1, y: canvas.y + y + 1 }));
        await page.mouse.move(a.x, a.y);
        await page.mouse.down();
        await page.mouse.move((a.x + b.x) / 2, (a.y + b.y) / 2, { steps: 4 });
        await page.mouse.move(b.x, b.y, { steps: 4 });
        await page.mouse.up();
        const [from, to] = robots.map(({ start }) => start);
        const distance = Math.hypot(to.x - from.x, to.y - from.y).toFixed(3);
        assert.ok((await announced(page)).startsWith(`${distance} m at `), await announced(page));
        assert.equal(await hook(page, "selected"), null);
        await page.click("#ruler");
        assert.equal(await page.getAttribute("#ruler", "aria-pressed"), "false");
      },
      { options },
    );
  });
}

test("the ruler measures by keys alone, from the selected robot", async () => {
  await onPage(async (page) => {
    const { map, robots } = await choose(page, "corridor-swap");
    await page.click(`.robot[data-robot="${robots[0].id}"]`);
    await page.keyboard.press("m");
    for (let step = 0; step < 3; step += 1) await page.keyboard.press("ArrowRight");
    await page.keyboard.press("ArrowUp");
    const cell = map.resolution ?? 1;
    assert.ok((await announced(page)).startsWith(`${(cell * Math.sqrt(10)).toFixed(3)} m at 18.4°`));
    await page.keyboard.press("Enter");
    await page.keyboard.press("ArrowLeft");
    assert.ok((await announced(page)).startsWith(`${cell.toFixed(3)} m at 180.0°`));
    await page.keyboard.press("Escape");
    assert.equal(await page.getAttribute("#ruler", "aria-pressed"), "false");
  });
});
