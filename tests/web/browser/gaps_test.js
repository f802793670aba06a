// The gaps between robots over time, in headless Chromium: without pairs at rest, below a threshold, and close up.

import assert from "node:assert/strict";
import { test } from "node:test";

import { pressPlan } from "../support/browser.js";
import { hasTime, hook, pagesFor, paste } from "../support/on_page.js";

const onPage = pagesFor();

const robot = (id, start, goal) => ({ id, start, ...(goal ? { goal } : {}) });
const LONG = "a-robot-with-a-rather-long-name";

/** Two robots that touch and stay, far from two that pass each other with 200 mm between. */
const HALL = {
  map: { rows: Array(20).fill(".".repeat(40)) },
  robot_defaults: { radius: 0.4, linear_speed: 1, angular_speed: 1 },
  robots: [
    robot("parked-1", { x: 35, y: 15 }),
    robot("parked-2", { x: 35.8, y: 15 }),
    robot(`${LONG}-1`, { x: 2, y: 5 }, { x: 10, y: 5 }),
    robot(`${LONG}-2`, { x: 10, y: 6 }, { x: 2, y: 6 }),
  ],
};

async function planned(page) {
  await paste(page, HALL);
  await page.waitForFunction(() => window.fleetplan.request.robots.length === 4);
  await pressPlan(page);
  await page.waitForFunction(() => window.fleetplan.least);
}

/** Where two robots are on the canvas, and whether both are on it. */
const pairOn = (page) =>
  page.evaluate((long) => {
    const { clientWidth, clientHeight } = document.getElementById("scene");
    const places = [1, 2].map((at) => window.fleetplan.screenOf(`${long}-${at}`));
    const seen = places.every(({ x, y }) => x > 0 && x < clientWidth && y > 0 && y < clientHeight);
    return { seen, radius: places[0].radius };
  }, LONG);

for (const [kind, options] of [
  ["desktop", {}],
  ["phone", { viewport: { width: 390, height: 844 }, isMobile: true, hasTouch: true }],
]) {
  test(`neighbours at rest do not count, and the nearest pair is shown close up, ${kind}`, async () => {
    await onPage(
      async (page) => {
        await planned(page);
        const { gap, ids, t } = await hook(page, "least");
        assert.deepEqual(ids, [`${LONG}-1`, `${LONG}-2`]);
        assert.ok(Math.abs(gap - 0.2) < 1e-3, `${gap} m`);
        const before = await pairOn(page);
        await page.click("#timeline-least");
        await hasTime(page, t);
        const { seen, radius } = await pairOn(page);
        assert.equal(seen, true);
        assert.ok(radius > 2 * before.radius && radius > 12, `${before.radius} to ${radius} pixels`);
        assert.match(await page.getAttribute("#timeline-closest", "title"), /^Closest now: /);
      },
      { options },
    );
  });
}

test("times with gaps below a threshold are counted, and gone through by keys", async () => {
  await onPage(async (page) => {
    await planned(page);
    await page.focus("#gap-threshold");
    await page.keyboard.type("100");
    assert.equal(await page.innerText("#gap-next"), "never");
    await page.keyboard.press("ControlOrMeta+a");
    await page.keyboard.type("300");
    assert.equal(await page.innerText("#gap-next"), "1 time");
    await page.keyboard.press("Tab");
    await page.keyboard.press("Enter");
    await hasTime(page, (await hook(page, "least")).t);
    assert.match(await page.innerText("#announcer"), /-1 and .*-2 at/);
  });
});

test("a violation shows its robots close up", async () => {
  const [one, other] = [5, 5.5].map((y) => [2, 10].map((x) => ({ x, y, theta: 0 })));
  const drive = ([from, to]) => [{ type: "translate", t_start: 0, t_end: 8, from, to }];
  await onPage(async (page) => {
    const robots = HALL.robots
      .slice(2)
      .map(({ id }, at) => robot(id, [one, other][at][0], [one, other][at][1]));
    const plans = robots.map(({ id }, at) => ({ robot: id, actions: drive([one, other][at]) }));
    await paste(page, { ...HALL, robots, plans });
    await page.waitForSelector(".violation");
    const before = await pairOn(page);
    await page.click(".violation");
    const { seen, radius } = await pairOn(page);
    assert.equal(seen, true);
    assert.ok(radius > 2 * before.radius, `${before.radius} to ${radius} pixels`);
  });
});

test("gaps may be measured beyond vicinities, if robots have one", async () => {
  await onPage(async (page) => {
    await planned(page);
    assert.equal(await page.isVisible("#gap-vicinity"), false);
    const robots = HALL.robots.map((each, at) => (at === 3 ? { ...each, vicinity: 0.15 } : each));
    await paste(page, { ...HALL, robots });
    await page.waitForFunction(() => window.fleetplan.request.robots[3].vicinity === 0.15);
    await pressPlan(page);
    await page.waitForFunction(() => window.fleetplan.least);
    assert.ok(Math.abs((await hook(page, "least")).gap - 0.2) < 1e-3);
    assert.match(await page.innerText("#timeline-least"), /^Smallest gap 200 mm$/);
    await page.fill("#gap-threshold", "100");
    assert.equal(await page.innerText("#gap-next"), "never");

    await page.check("#gap-vicinity");
    await page.waitForFunction(() => window.fleetplan.least?.gap < 0.1);
    assert.ok(Math.abs((await hook(page, "least")).gap - 0.05) < 1e-3);
    assert.match(await page.innerText("#timeline-least"), /^Smallest gap 50 mm$/);
    assert.equal(await page.innerText("#gap-next"), "1 time");
  });
});
