// The speeds of the selected robot over time, on its card.

import assert from "node:assert/strict";
import { test } from "node:test";

import { assertAccessible } from "../support/axe.js";
import { planAndPause, seek } from "../support/browser.js";
import { pagesFor, paste } from "../support/on_page.js";

const onPage = pagesFor();

// It drives 9 m ahead, at 2 m/s after 2 s, and loses this speed in 1 s. Then it turns left by 2 rad in 4 s.
const ONE = {
  map: { rows: Array(3).fill(".".repeat(12)) },
  robots: [
    {
      id: "heavy",
      radius: 0.4,
      linear_speed: 2,
      angular_speed: 0.5,
      linear_acceleration: 1,
      linear_deceleration: 2,
      start: { x: 1.5, y: 1.5, theta: 0 },
      goal: { x: 10.5, y: 1.5, theta: 2 },
    },
  ],
};
const DURATION = 10; // seconds: 2 m in 2 s, 6 m in 3 s, 1 m in 1 s, and the turn

test("the card of a robot shows its speeds over time, the present ones, and both in words", async () => {
  await onPage(async (page) => {
    await paste(page, ONE);
    await page.waitForFunction(() => window.fleetplan.request.robots[0].id === "heavy");
    const { makespan } = await planAndPause(page);
    assert.ok(Math.abs(makespan - DURATION) < 1e-6, `${makespan} s`);
    await page.locator('.robot[data-robot="heavy"]').click();
    const [driving, turning] = [0, 1].map((at) => page.locator("#inspector .speeds figure").nth(at));
    await driving.waitFor();
    const words = (figure) => figure.getByRole("img").getAttribute("aria-label");
    assert.equal(await words(driving), "Speed in 10.0 s: at most 2 m/s ahead");
    assert.equal(await words(turning), "Turning in 10.0 s: at most 0.5 rad/s left");
    const width = Number((await driving.locator("svg").getAttribute("viewBox")).split(" ")[2]);
    for (const [t, speed, turn] of [
      [1, "1 m/s", "0 rad/s"],
      [4, "2 m/s", "0 rad/s"],
      [5.5, "1 m/s", "0 rad/s"],
      [8, "0 m/s", "0.5 rad/s left"],
    ]) {
      await seek(page, t);
      assert.equal(await driving.locator("b").innerText(), speed);
      assert.equal(await turning.locator("b").innerText(), turn);
      const x = Number(await driving.locator(".speed-now").getAttribute("x1"));
      assert.ok(Math.abs(x - (width * t) / DURATION) < 0.1, `${x} of ${width} at ${t} s`);
    }
    await assertAccessible(page, "a card with speeds");
  });
});
