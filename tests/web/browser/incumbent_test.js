// Better plans while planning goes on: the scene shows and plays them as they come.

import assert from "node:assert/strict";
import { test } from "node:test";

import { choose } from "../support/browser.js";
import { hook, pagesFor, paste } from "../support/on_page.js";

const onPage = pagesFor();

test("the first plan is played while better ones come, and so is the last", async () => {
  await onPage(async (page) => {
    const request = await choose(page, "warehouse");
    await paste(page, { ...request, options: { mode: "anytime", time_budget_ms: 6000 } });
    await page.evaluate(() => document.activeElement.blur());
    await page.keyboard.press("p");
    await page.waitForFunction(
      () =>
        window.fleetplan.playing && window.fleetplan.time > 0.3 && !document.getElementById("cancel").hidden,
    );
    const first = await hook(page, "answer");
    assert.equal(first.verified, true);
    await page.waitForFunction(
      (flowtime) => window.fleetplan.answer.flowtime < flowtime && !document.getElementById("cancel").hidden,
      first.flowtime,
    );
    await page.waitForFunction(() => document.getElementById("cancel").hidden, null, { timeout: 20_000 });
    assert.ok((await hook(page, "answer")).flowtime <= first.flowtime);
    await page.waitForFunction(() => window.fleetplan.playing);
  });
});
