// Better plans while planning goes on: the scene shows and plays them as they come.

import assert from "node:assert/strict";
import { test } from "node:test";

import { choose, pressPlan } from "../support/browser.js";
import { hook, pagesFor, paste, streamPlan } from "../support/on_page.js";

const onPage = pagesFor();

/** An answer in which a robot waits at its goal, and so is later. */
function slower(answer, wait) {
  const [first, ...others] = answer.plans;
  const cost = first.cost + wait;
  return { ...answer, flowtime: answer.flowtime + wait, plans: [{ ...first, cost }, ...others] };
}

/** Presses P with the focus on the page itself. */
async function pressP(page) {
  await page.evaluate(() => document.activeElement.blur());
  await page.keyboard.press("p");
}

test("the first plan is played while better ones come, and so is the last", async () => {
  await onPage(async (page) => {
    await choose(page, "warehouse");
    const best = await pressPlan(page);
    await choose(page, "warehouse");
    assert.equal(await hook(page, "answer"), null);
    const stream = await streamPlan(page, []);
    await pressP(page);
    await page.waitForSelector("#cancel");
    const reached = [];
    for (const plan of [slower(best, 9), slower(best, 4), best]) {
      await stream.send([["incumbent", plan]]);
      const before = reached.at(-1) ?? 0;
      await page.waitForFunction(
        ({ flowtime, time }) =>
          window.fleetplan.answer?.flowtime === flowtime &&
          window.fleetplan.playing &&
          window.fleetplan.time > time,
        { flowtime: plan.flowtime, time: before },
      );
      assert.equal(await page.isVisible("#cancel"), true, "planning goes on");
      reached.push(await hook(page, "time"));
    }
    await stream.send([["plan", best]]);
    await stream.end();
    await page.waitForSelector("#cancel", { state: "hidden" });
    assert.deepEqual(await hook(page, "answer"), best);
    await page.waitForFunction(
      (time) => window.fleetplan.playing && window.fleetplan.time > time,
      reached.at(-1),
    );
  });
});

test("the service's first plan is played while it looks for better ones", async () => {
  await onPage(async (page) => {
    const request = await choose(page, "warehouse");
    await paste(page, { ...request, options: { mode: "anytime", time_budget_ms: 60_000 } });
    await pressP(page);
    await page.waitForFunction(
      () => window.fleetplan.time > 0.3 && !document.getElementById("cancel").hidden,
    );
    const first = await hook(page, "answer");
    assert.equal(first.verified, true);
    await page.evaluate(() => document.getElementById("cancel").click()); // at once, within the minute
    await page.waitForSelector("#cancel", { state: "hidden" });
    const last = await hook(page, "answer");
    assert.ok(last.verified && last.flowtime <= first.flowtime, `${last.flowtime} after ${first.flowtime}`);
  });
});
