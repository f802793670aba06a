// What the page keeps when it ends, and what the browser's button Back restores.

import assert from "node:assert/strict";
import { test } from "node:test";

import { choose, planned, pressPlan } from "../support/browser.js";
import { hallWith } from "../support/hall.js";
import { drop } from "../support/map_files.js";
import { hook, pagesFor, streamPlan } from "../support/on_page.js";

const onPage = pagesFor();

const isOpen = (page) => page.waitForFunction(() => window.fleetplan?.request);

/** Edits the request and has the page end in the same task, long before the address leads to the edit. */
const editAndLeave = (page, leave) =>
  page.evaluate((how) => {
    const radius = /** @type {HTMLInputElement} */ (document.querySelector("#default-numbers input"));
    radius.value = "0.321";
    radius.dispatchEvent(new Event("input", { bubbles: true }));
    if (how === "reload") location.reload();
    else location.href = "about:blank";
  }, leave);

for (const leave of ["reload", "close"]) {
  test(`an edit right before the page ends is kept: ${leave}`, async () => {
    await onPage(async (page, { url }) => {
      await choose(page, "crossing");
      const left = page.waitForEvent(leave === "close" ? "load" : "framenavigated");
      await editAndLeave(page, leave);
      await left;
      if (leave === "close") await page.goto(url);
      await isOpen(page);
      assert.equal((await hook(page, "request")).robot_defaults.radius, 0.321);
      await page.reload();
      await isOpen(page);
      assert.equal((await hook(page, "request")).robot_defaults.radius, 0.321, "and from then on");
    });
  });
}

test("a plan is there after a reload right after it came", async () => {
  await onPage(async (page) => {
    await choose(page, "crossing");
    const answer = await pressPlan(page);
    await page.reload();
    await page.waitForFunction(() => window.fleetplan?.answer);
    assert.deepEqual((await hook(page, "answer")).plans, answer.plans);
  });
});

test("the plan that is shown during planning survives a reload", async () => {
  await onPage(async (page) => {
    const answer = await planned(page, "crossing");
    await streamPlan(page, [["incumbent", answer]]);
    await page.click("#plan");
    await page.waitForFunction(() => window.fleetplan.answer !== null);
    assert.equal(await page.isVisible("#cancel"), true, "it is still planning");
    await page.reload();
    await page.waitForFunction(() => window.fleetplan?.answer);
    assert.deepEqual((await hook(page, "answer")).plans, answer.plans);
  });
});

test("names of files and of edited examples survive a reload", async () => {
  await onPage(async (page) => {
    await drop(page, { "north-hall.json": JSON.stringify(hallWith(3)) });
    await page.waitForFunction(
      () => document.getElementById("request-name").textContent === "north-hall.json",
    );
    await page.waitForFunction(() => location.hash.startsWith("#r="));
    await page.reload();
    await isOpen(page);
    assert.equal(await page.innerText("#request-name"), "north-hall.json");
    await choose(page, "crossing");
    await page.click("#tab-edit");
    await page.getByText("Robot defaults").click();
    await page.locator("#default-numbers input").first().fill("0.31");
    await page.reload();
    await isOpen(page);
    assert.match(await page.innerText("#request-name"), /^crossing/);
  });
});

test("Back undoes opening an example, also of an edited request with its plan", async () => {
  await onPage(async (page) => {
    await drop(page, { "north-hall.json": JSON.stringify(hallWith(3)) });
    await page.waitForFunction(() => window.fleetplan.request.robots.length === 3);
    const answer = await pressPlan(page);
    const request = await hook(page, "request");
    await choose(page, "crossing");
    await choose(page, "corridor-swap");
    await page.goBack();
    await page.waitForFunction(() => window.fleetplan.request.robots.length === 8);
    await page.goBack();
    await page.waitForFunction(() => window.fleetplan.request.robots.length === 3);
    assert.deepEqual(await hook(page, "request"), request);
    assert.deepEqual((await hook(page, "answer")).plans, answer.plans);
    assert.equal(await page.innerText("#request-name"), "north-hall.json");
    await page.goForward();
    await page.waitForFunction(() => window.fleetplan.request.robots.length === 8);
  });
});

test("an address that leads to nothing is told", async () => {
  await onPage(
    async (page) => {
      await page.waitForSelector("#problem:not([hidden])");
      assert.match(
        await page.innerText("#problem"),
        /“#no-such-example” is neither an example nor a request/,
      );
      await page.evaluate(() => (location.hash = "#nor-this"));
      await page.waitForFunction(() => /nor-this/.test(document.getElementById("problem").innerText));
    },
    { hash: "#no-such-example" },
  );
});
