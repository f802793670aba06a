// Finding, centring and following robots, and filtering their list.

import assert from "node:assert/strict";
import { test } from "node:test";

import { planned, seek } from "../support/browser.js";
import { hasTime, hook, pagesFor } from "../support/on_page.js";

const onPage = pagesFor();
const PHONE = { viewport: { width: 390, height: 844 }, isMobile: true, hasTouch: true };

/** How far a robot is from the middle of the scene, pixels, and its radius there. */
const fromMiddle = (page, id) =>
  page.evaluate((robot) => {
    const { clientWidth, clientHeight } = document.getElementById("scene");
    const { x, y, radius } = window.fleetplan.screenOf(robot);
    return { apart: Math.hypot(x - clientWidth / 2, y - clientHeight / 2), radius };
  }, id);

for (const [size, options] of [
  ["desktop", {}],
  ["phone", PHONE],
]) {
  test(`keys alone find a robot by a part of its id, centre it and follow it, ${size}`, async () => {
    await onPage(
      async (page) => {
        await planned(page, "warehouse");
        await page.keyboard.press("/");
        await page.keyboard.type("TOTE-2");
        await page.waitForFunction(() => document.querySelectorAll("#robots .robot").length === 7);
        assert.equal(await page.innerText("#robots-title"), "7 of 40 robots");
        await page.keyboard.press("Enter");
        assert.equal(await hook(page, "selected"), "tote-21");
        await page.keyboard.press("Enter");
        assert.equal(await hook(page, "selected"), "tote-22");
        const found = await fromMiddle(page, "tote-22");
        assert.ok(found.apart < 2 && found.radius >= 9.9, JSON.stringify(found));
        await page.keyboard.press("Escape");
        await page.waitForFunction(() => document.querySelectorAll("#robots .robot").length === 40);
        assert.equal(await hook(page, "selected"), "tote-22", "the first Escape only empties the field");
        await page.focus("#scene");
        await page.keyboard.press("Shift+F");
        assert.equal(await page.getAttribute("#follow", "aria-pressed"), "true");
        await seek(page, 8);
        await hasTime(page, 8);
        assert.ok((await fromMiddle(page, "tote-22")).apart < 2);
        await page.keyboard.press("ArrowLeft");
        assert.equal(await page.getAttribute("#follow", "aria-pressed"), "false");
        await seek(page, 12);
        await hasTime(page, 12);
        assert.ok((await fromMiddle(page, "tote-22")).apart > 20, "the camera stays");
      },
      { options },
    );
  });
}

test("the list shows the robots of a state at the moment", async () => {
  await onPage(async (page) => {
    const answer = await planned(page, "warehouse");
    const doingAt = (t, type) =>
      answer.plans.filter(({ actions }) => {
        return actions.findLast(({ t_start }) => t_start <= t)?.type === type && t < actions.at(-1).t_end;
      });
    await page.selectOption("#robot-filter", "moving");
    for (const t of [0.01, 9.37, 20.53]) {
      await seek(page, t);
      const expected = doingAt(t, "translate").map(({ robot }) => robot);
      await page.waitForFunction(
        (ids) =>
          ids === [...document.querySelectorAll("#robots .robot")].map((row) => row.dataset.robot).join(),
        expected.join(),
      );
    }
  });
});

test("robots without a plan, and delayed ones, are listed alone", async () => {
  await onPage(async (page) => {
    const answer = await planned(page, "partly-solvable");
    const listed = () =>
      page.evaluate(() => [...document.querySelectorAll("#robots .robot")].map((row) => row.dataset.robot));
    await page.selectOption("#robot-filter", "unplanned");
    assert.deepEqual(
      await listed(),
      answer.unplanned.map(({ robot }) => robot),
    );
    await page.selectOption("#robot-filter", "delayed");
    const late = answer.plans.filter(({ cost, lower_bound }) => cost > lower_bound);
    assert.deepEqual(
      await listed(),
      late.map(({ robot }) => robot),
    );
    await page.fill("#robot-delay", "100000");
    assert.deepEqual(await listed(), []);
    assert.equal(await page.isVisible("#no-robot-found"), true);
  });
});
