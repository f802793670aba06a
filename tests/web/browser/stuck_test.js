// Robots that are stuck within the planning horizon: their cards, and those in their way.

import assert from "node:assert/strict";
import { test } from "node:test";

import { pressPlan } from "../support/browser.js";
import { pagesFor, paste, themeColour, countColour } from "../support/on_page.js";

const onPage = pagesFor();

/** A corridor in which one robot parks in front of the goal of the other one. */
const CORRIDOR = {
  map: { rows: ["............"] },
  robot_defaults: { radius: 0.4, linear_speed: 1, angular_speed: 2 },
  robots: [
    { id: "late", start: { x: 2.5, y: 0.5 }, goal: { x: 11.5, y: 0.5 } },
    { id: "parked", start: { x: 3.5, y: 0.5 } },
  ],
  options: { horizon: 5, mode: "first" },
};

test("the card of a robot that is stuck says so, with those in its way, which lead to theirs", async () => {
  await onPage(async (page) => {
    await paste(page, CORRIDOR);
    const answer = await pressPlan(page);
    const plan = answer.plans.find(({ robot }) => robot === "late");
    assert.deepEqual([plan.stuck, plan.blocked_by], [true, ["parked"]]);
    assert.match(await page.innerText("#unplanned"), /Stuck within the horizon 1/);

    const late = page.locator('.robot[data-robot="late"]');
    await late.focus();
    await page.keyboard.press("Enter");
    const card = await page.innerText("#inspector");
    assert.match(card, /Stuck within the horizon\s+It comes no nearer to its goals/);
    assert.match(card, /Blocked by:\s*parked/);
    assert.doesNotMatch(card, /already at its goal|to the goal/);
    const danger = await themeColour(page, "--scene-danger");
    const ring = await page.evaluate(() => window.fleetplan.screenOf("parked"));
    assert.ok(
      (await countColour(page, danger, ring, ring.radius + 8)) > 0,
      "a ring around who is in the way",
    );

    await page.locator('#inspector [data-chip="parked"]').focus();
    await page.keyboard.press("Enter");
    assert.match(await page.innerText("#inspector h2"), /parked/);
  });
});
