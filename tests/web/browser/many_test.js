// Many robots: heat maps, the minimap, the overview of the timeline and thin rows.

import assert from "node:assert/strict";
import { test } from "node:test";

import { choose, planned, seek } from "../support/browser.js";
import { coloursAt, hasTime, hook, pagesFor } from "../support/on_page.js";

const onPage = pagesFor();
const PHONE = { viewport: { width: 390, height: 844 }, isMobile: true, hasTouch: true };

test("heat maps colour the places where robots wait, and where they pass", async () => {
  await onPage(async (page) => {
    const answer = await planned(page, "crossing");
    const isLong = ({ type, t_start, t_end }) => type === "wait" && t_end - t_start > 1;
    const { robot, actions } = answer.plans.find((plan) => plan.actions.some(isLong));
    const { from } = actions.find(isLong);
    await seek(page, answer.makespan);
    await hasTime(page, answer.makespan);
    const off = { x: from.x + 0.05, y: from.y + 0.12 };
    const places = await page.evaluate(
      (points) => points.map((at) => window.fleetplan.pointOf(at)),
      [from, off],
    );
    await page.click("#view-menu summary");
    await page.check("input[name=paths][value=none]");
    const [, plain] = await coloursAt(page, places);
    const seen = {};
    for (const heat of ["waiting", "passage"]) {
      await page.focus(`input[name=heat][value=${heat}]`);
      await page.keyboard.press("Space");
      [, seen[heat]] = await coloursAt(page, places);
    }
    assert.notEqual(seen.waiting, plain, `${robot} waits there`);
    assert.notEqual(seen.passage, plain);
    assert.notEqual(seen.passage, seen.waiting);
  });
});

for (const [size, options] of [
  ["desktop", {}],
  ["phone", PHONE],
]) {
  test(`the minimap appears when the scene is zoomed in, and moves it, ${size}`, async () => {
    await onPage(
      async (page) => {
        await choose(page, "warehouse");
        assert.equal(await page.isVisible("#minimap"), false);
        await page.focus("#scene");
        for (let times = 0; times < 4; times += 1) await page.keyboard.press("+");
        await page.waitForSelector("#minimap", { state: "visible" });
        const { bounds } = await page.evaluate(() => {
          const { rows, resolution } = window.fleetplan.request.map;
          return { bounds: { x: rows[0].length * resolution, y: rows.length * resolution } };
        });
        const box = await page.locator("#minimap").boundingBox();
        await page.mouse.click(box.x + box.width * 0.25, box.y + box.height * 0.75);
        const middle = await page.evaluate(
          (point) => {
            const { x, y } = window.fleetplan.pointOf(point);
            const { clientWidth, clientHeight } = document.getElementById("scene");
            return { across: x - clientWidth / 2, down: y - clientHeight / 2 };
          },
          { x: bounds.x * 0.25, y: bounds.y * 0.25 },
        );
        assert.ok(Math.abs(middle.across) < 30 && Math.abs(middle.down) < 30, JSON.stringify(middle));
        await page.keyboard.press("f");
        await page.waitForSelector("#minimap", { state: "hidden" });
      },
      { options },
    );
  });
}

test("the overview moves the part of the plan that the timeline shows; thin rows show more robots", async () => {
  await onPage(async (page) => {
    const { makespan } = await planned(page, "warehouse");
    const height = () => page.evaluate(() => document.getElementById("timeline-rows").offsetHeight);
    const before = await height();
    await page.focus("#timeline-compact");
    await page.keyboard.press("Enter");
    assert.ok((await height()) < before / 2);
    assert.equal(await page.getAttribute("#timeline-compact", "aria-pressed"), "true");

    await page.focus("#timeline-scroll");
    for (let times = 0; times < 4; times += 1) await page.keyboard.press("+");
    const overview = await page.locator("#timeline-overview").boundingBox();
    const chart = await page.locator("#timeline-scroll").boundingBox();
    const right = overview.x + 132 + (overview.width - 142) * 0.8;
    await page.mouse.click(right, overview.y + 13);
    await page.mouse.click(chart.x + 132 + (chart.width - 142) / 2, chart.y + 100);
    const time = await hook(page, "time");
    assert.ok(Math.abs(time - makespan * 0.8) < makespan * 0.02, `${time} of ${makespan}`);
  });
});

test("the lattice is shown on demand: a point in the middle of a cell", async () => {
  await onPage(async (page) => {
    const { map } = await choose(page, "crossing");
    const cell = map.resolution ?? 1;
    const column = map.rows[0].indexOf(".");
    const origin = map.origin ?? { x: 0, y: 0 };
    const top = origin.y + (map.rows.length - 0.5) * cell;
    const place = await page.evaluate((point) => window.fleetplan.pointOf(point), {
      x: origin.x + (column + 0.5) * cell,
      y: top,
    });
    const [plain] = await coloursAt(page, [place]);
    await page.focus("#view-menu summary");
    await page.keyboard.press("Enter");
    await page.focus("input[name=lattice]");
    await page.keyboard.press("Space");
    const [shown] = await coloursAt(page, [place]);
    assert.notEqual(shown, plain);
  });
});
