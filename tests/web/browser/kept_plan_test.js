// A plan is kept while its request is edited, with what of it still holds. In headless Chromium.

import assert from "node:assert/strict";
import { test } from "node:test";

import { planAndPause, pressPlan, seek } from "../support/browser.js";
import { coloursAt, hook, pagesFor, paste, themeColour } from "../support/on_page.js";
import { drag, windowPoint } from "../support/scene_pointer.js";

const onPage = pagesFor();

const LANES = [0.5, 2.5, 4.5];
const REQUEST = {
  map: { rows: Array(6).fill(".".repeat(10)) },
  robot_defaults: { radius: 0.3, linear_speed: 1, angular_speed: 1 },
  robots: LANES.map((y, at) => ({ id: `robot-${at + 1}`, start: { x: 0.5, y }, goal: { x: 8.5, y } })),
};

/** A page with the plan of three robots, each on its lane, on the Edit tab. */
async function planned(page) {
  await paste(page, REQUEST);
  await page.waitForFunction(() => window.fleetplan.request.robots.length === 3);
  const answer = await planAndPause(page);
  await page.click("#tab-edit");
  return answer;
}

const areOutdated = (page, ids) =>
  page.waitForFunction((text) => JSON.stringify(window.fleetplan.outdated) === text, JSON.stringify(ids));

const statesOf = (page) =>
  page.evaluate(() => window.fleetplan.request.robots.map(({ id }) => window.fleetplan.stateOf(id)));

test("an edited robot stands at its start while the plans of others go on", async () => {
  await onPage(async (page) => {
    const answer = await planned(page);
    await seek(page, 3);
    const before = await page.evaluate(() => window.fleetplan.poseOf("robot-2"));
    await drag(page, [REQUEST.robots[0].start, { x: 1.5, y: 1.5 }]);
    await areOutdated(page, ["robot-1"]);
    assert.deepEqual(await statesOf(page), ["outdated", "moving", "moving"]);
    assert.deepEqual(await page.evaluate(() => window.fleetplan.poseOf("robot-2")), before);
    assert.deepEqual(await page.evaluate(() => window.fleetplan.poseOf("robot-1")), {
      x: 1.5,
      y: 1.5,
      theta: 0,
    });
    assert.deepEqual(await hook(page, "answer"), answer);
    await page.click("#tab-plan");
    assert.match(await page.innerText("#summary"), /Outdated\s+2 of 3 plans still hold/);
    assert.doesNotMatch(await page.innerText("#summary"), /Solved|Verified/);
    assert.equal(await page.isDisabled("#save-plan"), true);
    await page.click("#play");
    await page.waitForFunction(() => window.fleetplan.time > 3);
  });
});

test("a wall across a lane outdates the plans that it breaks, found by the service", async () => {
  await onPage(async (page) => {
    await planned(page);
    await page.click(".tool:has([value=wall])");
    const { x, y } = await windowPoint(page, { x: 4.5, y: LANES[1] });
    await page.mouse.click(x, y);
    await areOutdated(page, ["robot-2"]);
    await seek(page, 4);
    assert.deepEqual(await statesOf(page), ["moving", "outdated", "moving"]);
    const [place] = await page.evaluate(() => [window.fleetplan.screenOf("robot-2")]);
    const grey = await themeColour(page, "--state-outdated");
    const colours = await coloursAt(page, [{ x: place.x - place.radius * 0.8, y: place.y }]);
    assert.deepEqual(colours, [grey]);
  });
});

test("undo brings the whole plan back, redo what is left of it", async () => {
  await onPage(async (page) => {
    const answer = await planned(page);
    await drag(page, [REQUEST.robots[2].goal, { x: 7.5, y: 3.5 }]);
    await areOutdated(page, ["robot-3"]);
    await page.keyboard.press("Control+z");
    await areOutdated(page, null);
    assert.deepEqual(await hook(page, "answer"), answer);
    assert.deepEqual(await hook(page, "request"), REQUEST);
    await page.click("#tab-plan");
    assert.match(await page.innerText("#summary"), /Solved\s+Verified/);
    await page.waitForFunction(() => window.fleetplan.least, null);
    await page.keyboard.press("Control+Shift+z");
    await areOutdated(page, ["robot-3"]);
    const replanned = await pressPlan(page);
    await areOutdated(page, null);
    await page.keyboard.press("Control+z");
    assert.deepEqual(await hook(page, "answer"), answer);
    await page.keyboard.press("Control+Shift+z");
    assert.deepEqual(await hook(page, "answer"), replanned);
    await areOutdated(page, null);
  });
});

test("an outdated plan is not simulated", async () => {
  await onPage(async (page) => {
    await planned(page);
    await page.click("#tab-analyse");
    const run = page.getByRole("button", { name: "Simulate" });
    await run.waitFor();
    assert.equal(await run.isEnabled(), true);
    await page.click("#tab-edit");
    await drag(page, [REQUEST.robots[0].start, { x: 1.5, y: 1.5 }]);
    await areOutdated(page, ["robot-1"]);
    await page.click("#tab-analyse");
    assert.equal(await run.isEnabled(), false);
  });
});
