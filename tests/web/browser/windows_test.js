// The page in windows of many sizes, with mouse and finger: how much room the scene has, and that nothing is cut off.

import assert from "node:assert/strict";
import { test } from "node:test";

import { choose, pause, planned, pressPlan } from "../support/browser.js";
import { hook, pagesFor, twoFrames } from "../support/on_page.js";
import { windowPoint } from "../support/scene_pointer.js";

const SIZES = [
  [320, 568],
  [360, 740],
  [390, 844],
  [844, 390],
  [915, 412],
  [932, 430],
  [768, 1024],
  [1024, 500],
  [1280, 600],
  [1366, 650],
  [1366, 768],
  [1920, 970],
];
const LEAST_SHARE = 0.45; // of the window's height
const PHONE = { viewport: { width: 390, height: 844 }, isMobile: true, hasTouch: true };
const onPage = pagesFor();

const boxOf = (page, selector) => page.locator(selector).boundingBox();

async function assertRoom(page, state) {
  await twoFrames(page);
  const cut = await page.$$eval(".tabs, .request-head, .player, .toolbar", (boxes) =>
    boxes.filter((box) => box.scrollWidth > box.clientWidth + 1).map((box) => box.className),
  );
  assert.deepEqual(cut, [], `${state}: cut off`);
  const { height: window } = page.viewportSize();
  const { height } = await boxOf(page, "#scene");
  assert.ok(height >= LEAST_SHARE * window - 1, `${state}: the scene has ${height} of ${window} pixels`);
  const over = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
  assert.ok(over <= 0, `${state}: the page is ${over} pixels too wide`);
}

/** Fails unless an element is wholly in the window, once the page is scrolled to it. */
async function assertInWindow(page, selector, state) {
  await page.locator(selector).scrollIntoViewIfNeeded();
  const { x, y, width, height } = await boxOf(page, selector);
  const window = page.viewportSize();
  const isInside = x >= 0 && y >= 0 && x + width <= window.width + 1 && y + height <= window.height + 1;
  assert.ok(
    isInside,
    `${state}: ${selector} is at ${[x, y, width, height]} of ${window.width} x ${window.height}`,
  );
}

for (const [width, height] of SIZES) {
  for (const hasTouch of [false, true]) {
    test(`the scene has room in ${width} x ${height}, ${hasTouch ? "touch" : "mouse"}`, async () => {
      const options = { isNew: true, reducedMotion: "reduce", viewport: { width, height }, hasTouch };
      await onPage(
        async (page) => {
          await page.waitForSelector("#welcome:not([hidden])");
          await assertRoom(page, "a first visit");
          await assertInWindow(page, "#welcome-draw", "a first visit");
          await page.click("#view-menu summary");
          const menu = await boxOf(page, "#view-menu .menu-body");
          assert.ok(menu.x >= 0 && menu.x + menu.width <= width, `the View menu is at ${menu.x}`);
          await page.keyboard.press("Escape");
          await page.click("#open-gallery");
          await assertInWindow(page, "#gallery", "the gallery");
          await page.keyboard.press("Escape");
          await choose(page, "crossing");
          await assertRoom(page, "an example");
          await pressPlan(page);
          await assertRoom(page, "a plan");
          if ((await page.getAttribute("#timeline-toggle", "aria-expanded")) === "false") {
            await page.click("#timeline-toggle");
          }
          await assertRoom(page, "a timeline");
          await page.keyboard.press("a");
          await assertRoom(page, "robots to place");
          await assertInWindow(page, "#placing-plan", "robots to place");
        },
        { options },
      );
    });
  }
}

test("in a low window, the page scrolls beside the scene, which stays", async () => {
  await onPage(
    async (page) => {
      await page.locator("#tab-analyse").scrollIntoViewIfNeeded();
      await page.evaluate(() => scrollTo(0, document.documentElement.scrollHeight));
      assert.ok((await page.evaluate(() => scrollY)) > 0);
      assert.equal((await boxOf(page, "#scene")).y, 0);
    },
    { options: { viewport: { width: 844, height: 390 }, hasTouch: true } },
  );
});

test("the timeline is folded before the first plan, and as high as its robots", async () => {
  await onPage(async (page) => {
    await choose(page, "corridor-swap");
    assert.equal(await page.isVisible("#timeline-body"), false);
    await pressPlan(page);
    await pause(page);
    assert.equal(await page.isVisible("#timeline-body"), true);
    const few = (await boxOf(page, "#timeline-body")).height;
    await planned(page, "warehouse");
    await twoFrames(page);
    const many = (await boxOf(page, "#timeline-body")).height;
    assert.ok(few < many, `${few} and ${many}`);
    const rows = await page.evaluate(() => {
      const box = document.getElementById("timeline-scroll");
      return [box.clientHeight, box.scrollHeight];
    });
    assert.ok(rows[0] < rows[1], "the rows of forty robots scroll");
  });
});

test("the fold of the timeline, the speed and the View menu are there at the next visit", async () => {
  await onPage(async (page) => {
    await planned(page, "crossing");
    await page.click("#timeline-toggle");
    await page.selectOption("#speed", "4");
    await page.click("#view-menu summary");
    await page.check("input[name=colours][value=state]");
    await page.check("input[name=lattice]");
    await page.reload();
    await page.waitForFunction(() => window.fleetplan?.answer);
    assert.equal(await page.isVisible("#timeline-body"), false);
    assert.equal(await page.inputValue("#speed"), "4");
    assert.equal(await page.isChecked("input[name=colours][value=state]"), true);
    assert.equal(await page.isChecked("input[name=lattice]"), true);
    await page.click("#timeline-toggle");
    await page.reload();
    await page.waitForFunction(() => window.fleetplan?.answer);
    await page.waitForSelector("#timeline-body", { state: "visible" });
  });
});

for (const [width, height] of [
  [320, 568],
  [390, 844],
  [844, 390],
]) {
  test(`the player has one height while it plays, ${width} x ${height}`, async () => {
    await onPage(
      async (page) => {
        const { makespan } = await planned(page, "crossing"); // whose times get a digit more on their way
        assert.ok(makespan > 10);
        const heights = await page.evaluate(async (end) => {
          const found = new Set();
          const scrubber = /** @type {HTMLInputElement} */ (document.getElementById("scrubber"));
          for (let share = 0; share <= 1; share += 0.05) {
            scrubber.value = String(share * end);
            scrubber.dispatchEvent(new Event("input", { bubbles: true }));
            await new Promise(requestAnimationFrame);
            const { width, height } = document.querySelector(".player").getBoundingClientRect();
            found.add(`${width} x ${height}, clock ${document.getElementById("clock").offsetWidth}`);
          }
          return [...found];
        }, makespan);
        assert.equal(heights.length, 1, heights.join("; "));
        assert.ok((await boxOf(page, ".player")).height < 110);
      },
      { options: { viewport: { width, height }, hasTouch: true } },
    );
  });
}

test("a finger finds a robot within 24 pixels, a mouse does not", async () => {
  await onPage(
    async (page) => {
      await planned(page, "warehouse");
      await page.locator("#scene").scrollIntoViewIfNeeded();
      const [id, radius] = await page.evaluate(() => {
        const ids = window.fleetplan.request.robots.map((robot) => robot.id);
        const at = new Map(ids.map((each) => [each, window.fleetplan.screenOf(each)]));
        const apart = (one, other) => Math.hypot(one.x - other.x, one.y - other.y);
        const isAlone = (each) =>
          ids.every((other) => other === each || apart(at.get(each), at.get(other)) > 50);
        const found = ids.find((each) => isAlone(each) && at.get(each).x > 40 && at.get(each).y > 80);
        return [found, at.get(found).radius];
      });
      assert.ok(radius < 10, "robots are small");
      const pose = await page.evaluate((each) => window.fleetplan.poseOf(each), id);
      const { x, y } = await windowPoint(page, pose);
      await page.mouse.click(x + 20, y);
      assert.equal(await hook(page, "selected"), null);
      await page.touchscreen.tap(x + 20, y);
      await page.waitForFunction((each) => window.fleetplan.selected === each, id);
      await page.waitForSelector("#inspector:not([hidden])");
      await twoFrames(page);
      const now = await windowPoint(page, pose); // the page scrolls to the card
      await page.touchscreen.tap(now.x, now.y - 22);
      await page.waitForFunction(() => window.fleetplan.selected === null);
    },
    { options: PHONE },
  );
});

test("on a phone, the card of a robot opens above the player", async () => {
  await onPage(
    async (page) => {
      await planned(page, "crossing");
      await page.locator("#scene").scrollIntoViewIfNeeded();
      const at = await page.evaluate(() => window.fleetplan.poseOf("heavy-east"));
      const { x, y } = await windowPoint(page, at);
      await page.touchscreen.tap(x, y);
      await page.waitForSelector("#inspector:not([hidden])");
      await twoFrames(page);
      const [card, player, scene] = await Promise.all(
        ["#inspector", ".player", "#scene"].map((each) => boxOf(page, each)),
      );
      assert.ok(card.y + card.height <= player.y + 1, "the card ends above the player");
      assert.ok(card.y >= scene.y + scene.height - 1, "and does not cover the scene");
      assert.ok(scene.y > -scene.height / 2, "which is still seen");
    },
    { options: PHONE },
  );
});

/** Swipes up on the scene with a finger; returns how far the page was scrolled. */
async function swipeUp(page) {
  const { x, y, width, height } = await boxOf(page, "#scene");
  const client = await page.context().newCDPSession(page);
  const before = await page.evaluate(() => scrollY);
  const at = (share) => [{ x: x + width / 2, y: y + height * share }];
  await client.send("Input.dispatchTouchEvent", { type: "touchStart", touchPoints: at(0.9) });
  for (let share = 0.85; share >= 0.3; share -= 0.05) {
    await client.send("Input.dispatchTouchEvent", { type: "touchMove", touchPoints: at(share) });
  }
  await client.send("Input.dispatchTouchEvent", { type: "touchEnd", touchPoints: [] });
  await twoFrames(page);
  return (await page.evaluate(() => scrollY)) - before;
}

test("swiping a map that is wholly in sight scrolls the page, swiping a part of it moves the map", async () => {
  await onPage(
    async (page) => {
      await choose(page, "warehouse");
      await page.evaluate(() => scrollTo(0, 0));
      await twoFrames(page);
      const corner = () => page.evaluate(() => window.fleetplan.pointOf({ x: 0, y: 0 }));
      const before = await corner();
      assert.ok((await swipeUp(page)) > 50, "the page is scrolled");
      assert.deepEqual(await corner(), before);
      await page.click("#zoom-in");
      await page.click("#zoom-in");
      await page.click("#zoom-in");
      await twoFrames(page);
      const zoomed = await corner();
      assert.equal(await swipeUp(page), 0);
      assert.notDeepEqual(await corner(), zoomed);
    },
    { options: PHONE },
  );
});

test("the browser's font size counts", async () => {
  await onPage(async (page) => {
    await planned(page, "crossing");
    const sizes = () =>
      page.evaluate(() => {
        const height = (selector) => document.querySelector(selector).getBoundingClientRect().height;
        return [height(".robot"), height("#plan"), height("#timeline-rows"), height(".figures dt")];
      });
    const before = await sizes();
    const client = await page.context().newCDPSession(page);
    await client.send("Page.setFontSizes", { fontSizes: { standard: 24, fixed: 20 } });
    await page.reload();
    await page.waitForFunction(() => window.fleetplan?.answer);
    await page.click("#timeline-toggle"); // folded, as the window has room for less text
    await twoFrames(page);
    const after = await sizes();
    after.forEach((size, at) => assert.ok(size > 1.35 * before[at], `${size} after ${before[at]}`));
    await assertRoom(page, "a large font");
  });
});
