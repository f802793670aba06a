// The plan survives a reload, in headless Chromium.

import assert from "node:assert/strict";
import { test } from "node:test";
import { inflateSync } from "node:zlib";

import { choose, pressPlan } from "../support/browser.js";
import { hallWith } from "../support/hall.js";
import { hook, pagesFor, paste } from "../support/on_page.js";
import { drag } from "../support/scene_pointer.js";

const onPage = pagesFor();

const isKept = (page) => page.waitForFunction(() => history.state?.plan);
const actionsOf = ({ plans }) => plans.map(({ robot, actions }) => ({ robot, actions }));

/** Reloads and waits until a plan is shown again. */
async function reloaded(page) {
  await page.reload();
  await page.waitForFunction(() => window.fleetplan?.answer);
}

for (const [what, open] of [
  ["an example", (page) => choose(page, "crossing")],
  ["a request in the address", (page) => paste(page, hallWith(3))],
  ["a request too large for the address", (page) => paste(page, hallWith(1000))],
]) {
  test(`the plan of ${what} is there again after a reload, and checked`, async () => {
    await onPage(async (page) => {
      const before = await page.evaluateHandle(() => window.fleetplan.request);
      await open(page);
      await page.waitForFunction((old) => window.fleetplan.request !== old, before);
      const request = await hook(page, "request");
      const answer = await pressPlan(page);
      await isKept(page);
      await page.waitForFunction(() => location.hash !== ""); // so is the request
      await reloaded(page);
      assert.deepEqual(await hook(page, "request"), request);
      assert.deepEqual(actionsOf(await hook(page, "answer")), actionsOf(answer));
      await page.waitForFunction(() => window.fleetplan.check?.valid);
      assert.equal(await hook(page, "outdated"), null);
      assert.match(await page.innerText("#summary"), /Verified/);
    });
  });
}

/** Waits until the page's address holds the request that is open. */
async function isInAddress(page) {
  const another = (before) => location.hash !== before && location.hash;
  let fragment = "";
  do {
    fragment = await (await page.waitForFunction(another, fragment)).jsonValue();
  } while (heldBy(fragment) !== JSON.stringify(await hook(page, "request")));
}

/** The text of the request that a fragment holds, or null. */
function heldBy(fragment) {
  const [, deflated] = /^#r=(.+)$/.exec(fragment) ?? [];
  return deflated === undefined ? null : inflateSync(Buffer.from(deflated, "base64url")).toString();
}

/** Plans a hall, moves the start of its second robot, and waits until all is kept: {hall, edited, plans}. */
async function keptEdit(page) {
  const hall = hallWith(3);
  await paste(page, hall);
  await page.waitForFunction(() => window.fleetplan.request.robots.length === 3);
  const { plans } = await pressPlan(page);
  await isKept(page);
  await page.click("#tab-edit");
  const { start } = hall.robots[1];
  await drag(page, [start, { ...start, y: start.y + 4 }]);
  await page.waitForFunction(() => window.fleetplan.outdated?.length === 1);
  await isInAddress(page);
  return { hall, edited: await hook(page, "request"), plans };
}

test("a plan whose request was edited is there again after a reload, with the robots that it no longer holds for", async () => {
  await onPage(async (page) => {
    const { edited, plans } = await keptEdit(page);
    await reloaded(page);
    await page.waitForFunction(() => window.fleetplan.outdated);
    assert.deepEqual(await hook(page, "outdated"), ["robot-1"]);
    assert.deepEqual(await hook(page, "request"), edited);
    assert.deepEqual(actionsOf(await hook(page, "answer")), actionsOf({ plans }));
    assert.match(await page.innerText("#summary"), /Outdated.*2 of 3 plans still hold/s);
  });
});

test("what is edited while the page is being reloaded is there again, with the plan", async () => {
  await onPage(async (page) => {
    const { hall, plans } = await keptEdit(page);
    const told = page.waitForRequest(/v1\/limits/);
    await page.route(
      ({ pathname }) => pathname === "/",
      async (load) => {
        await told; // that the address of the page before has followed
        await load.continue();
      },
    );
    await page.evaluate(() => {
      addEventListener("beforeunload", () => {
        const before = location.hash;
        document.getElementById("undo").click();
        const follows = setInterval(() => {
          if (location.hash === before) return;
          clearInterval(follows);
          fetch("v1/limits");
        }, 20);
      });
    });
    await reloaded(page);
    assert.deepEqual(await hook(page, "request"), hall);
    assert.deepEqual(actionsOf(await hook(page, "answer")), actionsOf({ plans }));
    assert.equal(await hook(page, "outdated"), null);
  });
});

test("another request that is opened after the plan has none after a reload", async () => {
  await onPage(async (page) => {
    await choose(page, "crossing");
    await pressPlan(page);
    await isKept(page);
    await choose(page, "warehouse");
    assert.equal(await page.evaluate(() => history.state?.plan), undefined);
    await page.reload();
    await page.waitForFunction(() => window.fleetplan?.request);
    assert.equal(await hook(page, "answer"), null);
  });
});

test("a link to a planned request shows the request alone elsewhere", async () => {
  await onPage(async (page) => {
    await choose(page, "crossing");
    await pressPlan(page);
    await isKept(page);
    const other = await page.context().newPage();
    await other.goto(page.url());
    await other.waitForFunction(() => window.fleetplan?.request);
    await other.waitForFunction(() => !document.getElementById("plan").disabled);
    assert.equal(await hook(other, "answer"), null);
    await other.close();
  });
});
