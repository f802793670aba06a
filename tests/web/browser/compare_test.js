// Two plans of one request, compared robot by robot and played in lockstep.

import assert from "node:assert/strict";
import { test } from "node:test";

import { choose, pressPlan, seek } from "../support/browser.js";
import { drop } from "../support/map_files.js";
import { countColour, hasTime, hook, pagesFor, themeColour } from "../support/on_page.js";

const onPage = pagesFor();

const compareWith = (page) => page.getByLabel("Compare the plan with");

async function openCompare(page) {
  await page.focus("#tab-plan");
  await page.keyboard.press("End");
  await page.getByText("Compare plans", { exact: true }).click();
}

/** An answer in which a robot waits at its start, and so is later. */
function delayed(answer, at, by) {
  const plans = structuredClone(answer.plans);
  const [first] = plans[at].actions;
  const later = plans[at].actions.map((action) => ({
    ...action,
    t_start: action.t_start + by,
    t_end: action.t_end + by,
  }));
  const wait = { type: "wait", t_start: 0, t_end: by, from: first.from, to: first.from };
  plans[at] = { ...plans[at], cost: plans[at].cost + by, actions: [wait, ...later] };
  return { ...answer, plans, verified: undefined };
}

test("a plan dropped onto the first is compared with it, in lockstep, and the two are swapped", async () => {
  await onPage(async (page) => {
    await choose(page, "crossing");
    const answer = await pressPlan(page);
    await page.waitForFunction(() => window.fleetplan.playing);
    await page.keyboard.press("Space");
    const second = delayed(answer, 0, 30);
    await drop(page, { "second.json": JSON.stringify(second) });
    await page.waitForFunction(
      (cost) => window.fleetplan.answer.plans[0].cost === cost,
      second.plans[0].cost,
    );
    await openCompare(page);
    await compareWith(page).selectOption("before 0");
    const { length } = answer.plans;
    assert.match(
      await page.innerText(".differences"),
      new RegExp(`^1 of ${length} robots changed; flowtime \\+30`),
    );
    const first = page.locator('#panel-analyse tbody tr[data-change="times"]');
    assert.ok((await first.innerText()).includes(answer.plans[0].robot));
    assert.equal(await page.locator('#panel-analyse tbody tr[data-change="same"]').count(), length - 1);

    await seek(page, answer.plans[0].cost);
    await hasTime(page, answer.plans[0].cost);
    const goal = answer.plans[0].actions.at(-1).to;
    const place = await page.evaluate((point) => window.fleetplan.pointOf(point), goal);
    const ink = await themeColour(page, "--scene-ink");
    const ghost = await countColour(page, ink, place, 60);
    await page.getByRole("button", { name: "Swap" }).click();
    assert.deepEqual((await hook(page, "answer")).plans, answer.plans);
    assert.match(await page.innerText(".differences"), /flowtime −30/);
    assert.equal(await hook(page, "duration"), second.plans[0].cost, "both end");
    await compareWith(page).selectOption("");
    await seek(page, answer.plans[0].cost);
    await hasTime(page, answer.plans[0].cost);
    assert.ok(ghost > (await countColour(page, ink, place, 60)), "the ghost was at its goal");
  });
});

test("after a replan with other options, the plan before is compared by keys alone", async () => {
  await onPage(async (page) => {
    await choose(page, "crossing");
    const first = await pressPlan(page);
    await page.click("#tab-options");
    await page.waitForSelector('#options [data-pointer="/options/inflation"]');
    await page.fill('#options [data-pointer="/options/inflation"]', "0.05");
    await page.keyboard.press("Tab");
    await page.evaluate(() => document.activeElement.blur());
    await page.keyboard.press("p");
    await page.waitForFunction(
      (flowtime) =>
        document.getElementById("cancel").hidden &&
        (window.fleetplan.answer?.flowtime ?? flowtime) !== flowtime,
      first.flowtime,
    );
    await openCompare(page);
    await compareWith(page).focus();
    await page.keyboard.press("ArrowDown");
    await page.waitForSelector(".differences");
    assert.match(await page.innerText(".differences"), /of 8 robots changed; flowtime [+−]/);
  });
});

test("the previous plans of a request are compared with the new one", async () => {
  await onPage(async (page) => {
    const request = await choose(page, "late-pallet");
    const previous = request.robots.filter((robot) => robot.previous).length;
    assert.ok(previous > 0);
    await pressPlan(page);
    await openCompare(page);
    await compareWith(page).selectOption("previous");
    assert.match(await page.innerText(".differences"), /robots changed/);
  });
});

test("a file that is no plan of these robots is told", async () => {
  await onPage(async (page) => {
    await choose(page, "crossing");
    await pressPlan(page);
    await openCompare(page);
    const buffer = Buffer.from(JSON.stringify({ plans: [{ robot: "nobody", actions: [] }] }));
    await page.setInputFiles("#panel-analyse input[type=file]", {
      name: "x.json",
      mimeType: "application/json",
      buffer,
    });
    await page.waitForSelector("#problem:not([hidden])");
    assert.match(await page.innerText("#problem"), /x\.json: It is no plan of these robots/);
  });
});
