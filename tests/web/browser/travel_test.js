// The travel times of a robot to every place, as colours and in words, in headless Chromium against the real server.

import assert from "node:assert/strict";
import { test } from "node:test";

import { assertAccessible, COLOUR_RULES } from "../support/axe.js";
import { choose } from "../support/browser.js";
import { coloursAt, hook, NO_ANSWER, pagesFor, paste, themeColour } from "../support/on_page.js";

const onPage = pagesFor();
const BACK = 0.03; // how much, relatively, a way back may take longer or shorter than that there, as found
const PHONE = { viewport: { width: 390, height: 844 }, isMobile: true, hasTouch: true };

/** A hall with a pillar, a chamber that is closed, and a zone that is blocked for one of two robots. */
const HALL = {
  map: {
    rows: [
      "....................",
      "....................",
      "......##......####..",
      "......##......#..#..",
      "..............####..",
      "....................",
    ],
  },
  robot_defaults: { radius: 0.4, linear_speed: 1, angular_speed: 2 },
  robots: [
    { id: "amr-1", start: { x: 0.5, y: 0.5 } },
    { id: "amr-2", start: { x: 19.5, y: 5.5, theta: 2 } },
  ],
  zones: [
    {
      id: "wet",
      type: "blocked",
      robots: ["amr-1"],
      polygon: [
        { x: 9, y: 0 },
        { x: 11, y: 0 },
        { x: 11, y: 2 },
        { x: 9, y: 2 },
      ],
    },
  ],
};

/** Chooses travel times in the menu of the view by keys, or no longer. */
async function switchTimes(page) {
  await page.focus("#view-menu summary");
  await page.keyboard.press("Enter");
  await page.focus("input[name=travel]");
  await page.keyboard.press("Space");
  await page.keyboard.press("Escape");
}

async function selectRobot(page, id) {
  await page.focus(`.robot[data-robot="${id}"]`);
  await page.keyboard.press("Enter");
}

/** Waits until the card has these words. */
const cardSays = (page, words) =>
  page.waitForFunction(
    (pattern) => new RegExp(pattern).test(document.getElementById("travel").innerText),
    words.source,
  );

const isComplete = (page, id) => cardSays(page, new RegExp(`${id}, alone, from its start\\.`));

/** Where a point of the world is in the window. */
async function inWindow(page, point) {
  const scene = await page.locator("#scene").boundingBox();
  const { x, y } = await page.evaluate((at) => window.fleetplan.pointOf(at), point);
  return [scene.x + x, scene.y + y];
}

/** What the card says about a point after the mouse has moved there. */
async function readingAt(page, point) {
  await page.mouse.move(...(await inWindow(page, point)));
  return page.innerText("#travel-reading");
}

/** How long the service says that a robot takes, seconds. */
const secondsTo = (page, id, places) =>
  page.evaluate(
    async ({ id, places }) => {
      const { map, zones, robot_defaults, robots } = window.fleetplan.request;
      const { start } = robots.find((robot) => robot.id === id);
      const body = JSON.stringify({
        map,
        zones,
        robot: { id, ...robot_defaults },
        from: [start],
        to: places,
      });
      const headers = { "Content-Type": "application/json" };
      const { seconds } = await (await fetch("v1/matrix", { method: "POST", headers, body })).json();
      return seconds[0];
    },
    { id, places },
  );

test("travel times of the selected robot are colours with a legend, and words at the pointer", async () => {
  await onPage(async (page) => {
    await paste(page, HALL);
    assert.equal(await page.isVisible("#travel"), false);
    await switchTimes(page);
    await cardSays(page, /Select a robot/);
    await selectRobot(page, "amr-1");
    await isComplete(page, "amr-1");

    const places = [
      [2.5, 0.5],
      [19.5, 0.5],
      [8.5, 3.5],
      [14.5, 5.5],
    ].map(([x, y]) => ({ x, y }));
    const expected = await secondsTo(page, "amr-1", places);
    for (const [at, place] of places.entries()) {
      const words = await readingAt(page, place);
      const seconds = Number(/^(\d+\.\d) s to the pointer\.$/.exec(words)?.[1]);
      assert.ok(
        Math.abs(seconds - expected[at]) <= BACK * expected[at] + 0.05,
        `${words}, not ${expected[at]} s`,
      );
    }
    assert.equal(await readingAt(page, { x: 16, y: 2.5 }), "No way to the pointer.");
    assert.equal(await readingAt(page, { x: 7, y: 3 }), "No place for this robot at the pointer.");
    assert.equal(await readingAt(page, { x: 9.5, y: 0.5 }), "No place for this robot at the pointer.");

    const legend = await page.locator("#travel-legend li").allInnerTexts();
    assert.deepEqual([legend[0], legend.at(-1)], ["0 to 5 s", "no way"]);
    const shown = await page.evaluate(
      (points) => points.map((point) => window.fleetplan.pointOf(point)),
      [...places.slice(0, 2).map(({ x, y }) => ({ x: x + 0.2, y: y + 0.3 })), { x: 9.7, y: 0.8 }],
    );
    const names = ["--travel-0", "--travel-6", "--scene-floor"];
    const colours = await Promise.all(names.map((name) => themeColour(page, name)));
    assert.deepEqual((await coloursAt(page, shown)).slice(0, 2), colours.slice(0, 2));

    await selectRobot(page, "amr-2");
    await isComplete(page, "amr-2");
    assert.match(await readingAt(page, { x: 9.5, y: 0.5 }), /^1\d\.\d s to the pointer\.$/);
    await switchTimes(page);
    assert.equal(await page.isVisible("#travel"), false);
    assert.notDeepEqual((await coloursAt(page, shown)).slice(0, 2), colours.slice(0, 2));
  });
});

test("by keys, the time in the middle of the view is read and announced", async () => {
  await onPage(async (page) => {
    await paste(page, HALL);
    await selectRobot(page, "amr-2");
    await switchTimes(page);
    await isComplete(page, "amr-2");
    assert.equal(
      await page.evaluate(() => document.getElementById("announcer").textContent),
      "amr-2, alone, from its start.",
    );
    await page.focus("#scene");
    await cardSays(page, /s to the middle of the view\./);
    const before = await page.innerText("#travel-reading");
    await page.keyboard.press("ArrowRight");
    await page.waitForFunction(
      (words) => document.getElementById("travel-reading").innerText !== words,
      before,
    );
    assert.equal(
      await page.evaluate(() => document.getElementById("announcer").textContent),
      await page.innerText("#travel-reading"),
    );
  });
});

test("an edit of the map ends the request under way; other times are asked for", async () => {
  await onPage(
    async (page) => {
      await paste(page, HALL);
      await selectRobot(page, "amr-1");
      let isHeld = true;
      const held = new Promise((resolve) => {
        page.route("**/v1/matrix", (route) => (isHeld ? resolve(route) : route.continue()));
      });
      await switchTimes(page);
      await held;
      isHeld = false;
      const ended = page.waitForEvent("requestfailed", (request) => request.url().endsWith("v1/matrix"));
      await page.click("#tab-edit");
      await page.keyboard.press("b");
      const [left, top] = await inWindow(page, { x: 12.5, y: 5.5 });
      const [right, bottom] = await inWindow(page, { x: 12.5, y: 0.5 });
      await page.mouse.move(left, top);
      await page.mouse.down();
      await page.mouse.move(right, bottom, { steps: 3 });
      await page.mouse.up();
      await ended;
      await isComplete(page, "amr-1");
      assert.equal(await readingAt(page, { x: 19.5, y: 0.5 }), "No way to the pointer.");
      assert.equal(await page.isVisible("#problem"), false);
    },
    { allowed: /ERR_FAILED/ },
  );
});

for (const [what, [answer, words]] of Object.entries(NO_ANSWER)) {
  test(`a service that ${what} is told, and asked again by a button`, async () => {
    await onPage(
      async (page) => {
        await paste(page, HALL);
        await selectRobot(page, "amr-1");
        await page.route("**/v1/matrix", answer);
        await switchTimes(page);
        await page.waitForSelector("#problem:not([hidden])");
        assert.match(await page.innerText("#problem"), words);
        await cardSays(page, /could not be computed/);
        await page.unroute("**/v1/matrix");
        await page.focus("#problem .again");
        await page.keyboard.press("Enter");
        await isComplete(page, "amr-1");
        assert.equal(await page.isVisible("#problem"), false);
      },
      { allowed: /ERR_FAILED|status of 503/ },
    );
  });
}

for (const [size, options] of [
  ["desktop", {}],
  ["phone", PHONE],
]) {
  test(`travel times of a large fleet violate no rule of axe-core, ${size}, light and dark`, async () => {
    await onPage(
      async (page) => {
        await choose(page, "warehouse");
        await selectRobot(page, (await hook(page, "request")).robots[0].id);
        await switchTimes(page);
        await cardSays(page, /from its start\./);
        await assertAccessible(page, "light");
        await page.emulateMedia({ colorScheme: "dark" });
        await assertAccessible(page, "dark", COLOUR_RULES);
        if (!options.hasTouch) return;
        const box = await page.locator("#scene").boundingBox();
        await page.touchscreen.tap(box.x + box.width / 2, box.y + box.height / 2);
        await cardSays(page, /the pointer\./);
        assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth));
      },
      { options: { ...options, colorScheme: "light", reducedMotion: "reduce" } },
    );
  });
}
