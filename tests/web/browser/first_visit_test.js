// The first visit to the page, and what later ones find, in headless Chromium.

import assert from "node:assert/strict";
import { execFile } from "node:child_process";
import { test } from "node:test";
import { fileURLToPath } from "node:url";
import { promisify } from "node:util";

import { chosenExample, planned } from "../support/browser.js";
import { hallWith } from "../support/hall.js";
import { hook, pagesFor, paste } from "../support/on_page.js";

const CLIENT = fileURLToPath(new URL("../../../clients/python", import.meta.url));
const onPage = pagesFor();
const onFirstVisit = (steps, { options = {}, ...rest } = {}) =>
  onPage(steps, { options: { isNew: true, ...options }, ...rest });

const welcomed = (page) => page.waitForSelector("#welcome:not([hidden])");

/** Opens the page's address once more, as a later visit does. */
async function visitAgain(page, url) {
  await page.goto("about:blank");
  await page.goto(url);
  await page.waitForFunction(() => window.fleetplan?.request);
}

test("a first visit shows a warehouse whose plan plays, and says what is seen", async () => {
  await onFirstVisit(async (page) => {
    await welcomed(page);
    assert.equal(await chosenExample(page), "warehouse");
    await page.waitForFunction(() => window.fleetplan.time > 0);
    const { plans } = await hook(page, "answer");
    const robots = new RegExp(`^${plans.length} robots cross a warehouse, .* planned in [0-9.]+ m?s`);
    assert.match(await page.innerText("#welcome-text"), robots);
    await page.click("#welcome-close");
    assert.equal(await page.isVisible("#welcome"), false);
    assert.notEqual(await hook(page, "answer"), null);
  });
});

test("with reduced motion, a first visit shows the plan at rest", async () => {
  await onFirstVisit(
    async (page) => {
      await welcomed(page);
      assert.equal(await hook(page, "playing"), false);
      assert.equal(await hook(page, "time"), 0);
    },
    { options: { reducedMotion: "reduce" } },
  );
});

for (const [kind, viewport] of [
  ["desktop", { width: 1440, height: 900 }],
  ["phone", { width: 390, height: 844 }],
]) {
  test(`little moves while the page opens, ${kind}`, async () => {
    await onFirstVisit(
      async (page) => {
        const shifts = await page.evaluate(async () => {
          const entries = [];
          const observer = new PerformanceObserver((list) => entries.push(...list.getEntries()));
          observer.observe({ type: "layout-shift", buffered: true });
          for (let frame = 0; frame < 10; frame += 1) await new Promise(requestAnimationFrame);
          observer.disconnect();
          return entries.map(({ value, sources }) => [value, sources.map(({ node }) => node?.outerHTML)]);
        });
        const sum = shifts.reduce((total, [value]) => total + value, 0);
        assert.ok(sum < 0.1, `${sum}: ${JSON.stringify(shifts).slice(0, 1000)}`); // "good" of Web Vitals
      },
      { hash: "#crossing", options: { viewport } },
    );
  });
}

test("an address says what a first visit shows", async () => {
  await onFirstVisit(
    async (page) => {
      assert.equal(await chosenExample(page), "crossing");
      await page.evaluate(() => new Promise((resolve) => setTimeout(resolve, 0)));
      assert.equal(await hook(page, "answer"), null);
      assert.equal(await page.isVisible("#welcome"), false);
    },
    { hash: "#crossing" },
  );
});

test("from the first visit, one click leads to a map of one's own", async () => {
  await onFirstVisit(async (page) => {
    await welcomed(page);
    await page.click("#welcome-draw");
    await page.waitForFunction(() => window.fleetplan.request.robots.length === 0);
    assert.equal(await page.isVisible("#panel-edit"), true);
    assert.equal(await page.isVisible("#welcome"), false);
  });
});

test("from the first visit, one click leads to the files of a map", async () => {
  await onFirstVisit(async (page) => {
    await welcomed(page);
    const [chooser] = await Promise.all([page.waitForEvent("filechooser"), page.click("#welcome-open")]);
    assert.equal(chooser.isMultiple(), true);
  });
});

test("the copied program plans the same request", async () => {
  await onFirstVisit(async (page, { url }) => {
    await welcomed(page);
    await page
      .context()
      .grantPermissions(["clipboard-read", "clipboard-write"], { origin: new URL(url).origin });
    await page.click("#welcome-python");
    await page.waitForFunction(() => document.getElementById("welcome-python").textContent === "Copied");
    const program = await page.evaluate(() => navigator.clipboard.readText());
    const run = promisify(execFile);
    const { stdout } = await run("python3", ["-c", program], {
      env: { ...process.env, PYTHONPATH: CLIENT },
    });
    const { robots } = await hook(page, "request");
    assert.equal(stdout.trim().split("\n").length, robots.length);
    for (const { id } of robots) assert.ok(stdout.includes(id), id);
  });
});

for (const [what, open] of [
  ["an example", (page) => planned(page, "crossing")],
  ["a request of one's own", (page) => paste(page, hallWith(3))],
]) {
  test(`a later visit shows ${what} that was open`, async () => {
    await onFirstVisit(async (page, { url }) => {
      await welcomed(page);
      const before = await page.evaluateHandle(() => window.fleetplan.request);
      await open(page);
      await page.waitForFunction((old) => window.fleetplan.request !== old, before);
      const request = await hook(page, "request");
      if ((await hook(page, "answer")) !== null) await page.waitForFunction(() => history.state?.plan);
      await page.waitForFunction(() => location.hash !== "" && location.hash !== "#warehouse");
      const had = await hook(page, "answer");
      await visitAgain(page, url);
      assert.deepEqual(await hook(page, "request"), request);
      if (had !== null) await page.waitForFunction(() => window.fleetplan.answer !== null);
      assert.equal(await page.isVisible("#welcome"), false);
    });
  });
}

test("a page whose browser keeps nothing begins as on a first visit, each time", async () => {
  await onPage(async (page, { url }) => {
    await page.addInitScript(() => {
      Object.defineProperty(window, "localStorage", {
        get() {
          throw new DOMException("denied", "SecurityError");
        },
      });
    });
    await visitAgain(page, url);
    await welcomed(page);
  });
});
