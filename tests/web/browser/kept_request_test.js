// Requests that are too large for a link survive a reload, in headless Chromium.

import assert from "node:assert/strict";
import { test } from "node:test";

import { pickExample } from "../support/browser.js";
import { hook, pagesFor, paste } from "../support/on_page.js";

const onPage = pagesFor();
const ROBOTS = 400;

/** A request whose link would be too long: robots at places that do not compress well. */
function largeRequest() {
  const robots = Array.from({ length: ROBOTS }, (_, at) => {
    const place = (row) => ({
      x: 1 + 2 * (at % 200) + Math.sin(at) / 3,
      y: row + 4 * Math.floor(at / 200) + Math.cos(at) / 3,
    });
    return { id: `robot-${at}`, start: place(1), goal: place(3) };
  });
  const robot_defaults = { radius: 0.3, linear_speed: 1, angular_speed: 1 };
  return { map: { rows: Array(8).fill(".".repeat(402)) }, robot_defaults, robots };
}

const isKept = (page) => page.waitForFunction(() => location.hash.startsWith("#kept="));
const hasRobots = (page, count) =>
  page.waitForFunction((robots) => window.fleetplan?.request?.robots.length === robots, count);

/** On the page: whether leaving it asks first is as expected. */
function leavingAsks(expected) {
  const event = new Event("beforeunload", { cancelable: true });
  window.dispatchEvent(event);
  return event.defaultPrevented === expected;
}

test("a request too large for a link is there again after a reload, with its edits", async () => {
  await onPage(async (page) => {
    const request = largeRequest();
    await paste(page, request);
    await isKept(page);
    await page.reload();
    await hasRobots(page, ROBOTS);
    assert.deepEqual(await hook(page, "request"), request);
    await page.click("#tab-edit");
    await page.selectOption("#edited-robot", "0");
    const before = await page.evaluate(() => location.hash);
    await page.click("#delete-robot");
    await page.waitForFunction(() => window.fleetplan.request.robots.length === 399);
    await page.waitForFunction(leavingAsks, false); // until the edit is kept
    assert.equal(await page.evaluate(() => location.hash), before);
    await page.reload();
    await hasRobots(page, ROBOTS - 1);
  });
});

test("an address of a request that is not kept says so, and an example is opened", async () => {
  await onPage(
    async (page) => {
      assert.match(await page.innerText("#problem"), /too large for a link.*Open its file/);
      assert.ok((await hook(page, "request")).robots.length > 0);
    },
    { hash: "#kept=elsewhere" },
  );
});

test("leaving asks if the browser does not keep the request", async () => {
  await onPage(async (page) => {
    await page.evaluate(() => {
      IDBFactory.prototype.open = () => {
        throw new DOMException("not here", "SecurityError");
      };
    });
    await paste(page, largeRequest());
    await hasRobots(page, ROBOTS);
    await page.waitForFunction(leavingAsks, true);
    await pickExample(page, "crossing");
    await page.waitForFunction(() => location.hash === "#crossing");
    assert.ok(await page.evaluate(leavingAsks, false), "an example is not lost");
  });
});
