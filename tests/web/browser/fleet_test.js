// A fleet that keeps running in the page: rounds, charts, and a robot that is held.

import assert from "node:assert/strict";
import { test } from "node:test";

import { choose, pressPlan } from "../support/browser.js";
import { hook, pagesFor } from "../support/on_page.js";

const onPage = pagesFor();
const PHONE = { viewport: { width: 390, height: 844 }, isMobile: true, hasTouch: true };

async function openFleet(page, example) {
  await choose(page, example);
  await pressPlan(page);
  await page.selectOption("#speed", "4");
  await page.focus("#tab-plan");
  await page.keyboard.press("End");
  await page.getByText("Continuous operation", { exact: true }).click();
}

const rounds = (page, least) =>
  page.waitForFunction(
    (count) => parseInt(/(\d+) round/.exec(document.body.innerText)?.[1] ?? "0", 10) >= count,
    least,
  );

for (const [size, options] of [
  ["desktop", {}],
  ["phone", PHONE],
]) {
  test(`a fleet keeps running, and its figures are drawn, ${size}`, async () => {
    await onPage(
      async (page) => {
        await openFleet(page, "hospital-ward");
        const before = await hook(page, "request");
        await page.getByRole("button", { name: "Run", exact: true }).focus();
        await page.keyboard.press("Enter");
        await rounds(page, 4);
        const request = await hook(page, "request");
        assert.equal(request.robots.length, before.robots.length);
        assert.ok(request.robots.some(({ previous }) => previous?.length > 0));
        await page.waitForFunction(() => window.fleetplan.playing); // not while a round is late
        assert.match(
          await page.getAttribute('svg[aria-label^="Planning time"]', "aria-label"),
          /ms now|s now/,
        );
        await page.getByRole("button", { name: "Stop", exact: true }).focus();
        await page.keyboard.press("Enter");
        assert.equal(await hook(page, "playing"), false);
      },
      { options },
    );
  });
}

test("a robot that is held by a click stands still at once, and the others go on", async () => {
  await onPage(async (page) => {
    await openFleet(page, "hospital-ward");
    await page.getByLabel("Hold for").fill("600");
    await page.getByLabel("Hold robots by clicking them").check();
    await page.getByRole("button", { name: "Run", exact: true }).click();
    await rounds(page, 1);
    await page.waitForFunction(() => {
      if (!window.fleetplan.playing || window.fleetplan.time > 1) return false; // the next round may be late
      document.getElementById("play").click(); // paused, it is clicked where it is
      return true;
    });
    const { robots } = await hook(page, "request");
    const busy = robots.filter(({ previous }) => (previous?.at(-1)?.t_end ?? 0) > 8);
    const [{ id }] = busy;
    await page.evaluate(() => document.activeElement.blur());
    const { x, y } = await page.evaluate((robot) => window.fleetplan.screenOf(robot), id);
    const clicked = await page.evaluate((robot) => window.fleetplan.poseOf(robot), id);
    const scene = await page.locator("#scene").boundingBox();
    await page.mouse.click(scene.x + x, scene.y + y);
    assert.equal(await hook(page, "selected"), id);
    await page.keyboard.press("Space");
    await page
      .getByText(/held, /)
      .first()
      .waitFor();
    const { length } = robots;
    await page.waitForFunction((robot) => {
      const found = window.fleetplan.request.robots.find((each) => each.id === robot);
      return found.committed?.[0]?.type === "wait" && found.committed[0].t_end > 10;
    }, id);
    const poses = () =>
      page.evaluate(
        (ids) => ids.map((each) => window.fleetplan.poseOf(each)),
        robots.map((robot) => robot.id),
      );
    const first = await poses();
    const stands = first[robots.findIndex((robot) => robot.id === id)];
    assert.ok(Math.hypot(stands.x - clicked.x, stands.y - clicked.y) < 1e-6, "where it was");
    const count = await page.evaluate(() => parseInt(/(\d+) round/.exec(document.body.innerText)[1], 10));
    await rounds(page, count + 2);
    const then = await poses();
    const moved = robots.filter(
      (_, at) => Math.hypot(first[at].x - then[at].x, first[at].y - then[at].y) > 0.1,
    );
    assert.ok(moved.length > 0, "others go on");
    assert.ok(!moved.some((robot) => robot.id === id), "it stands");
    assert.equal((await hook(page, "answer")).plans.length, length);
  });
});
