// Pages that do not load completely, in headless Chromium.

import assert from "node:assert/strict";
import { test } from "node:test";
import { fileURLToPath } from "node:url";

import { chosenExample, newContext, pickExample, pressPlan } from "../support/browser.js";
import { sharedBrowser, sharedService } from "../support/shared.js";

const SOURCES = fileURLToPath(new URL("../../../web", import.meta.url));
const REQUEST = "#partly-solvable";

/** Runs steps(page, url) on a page of a new context, which is to visit the url. */
async function onNewPage(steps, options = {}) {
  const { url } = await sharedService(["--web-root", SOURCES]);
  const context = await newContext(await sharedBrowser(), {
    viewport: { width: 390, height: 844 },
    ...options,
  });
  try {
    await steps(await context.newPage(), url);
  } finally {
    await context.close();
  }
}

/** Lets requests for an address (a pattern) fail from now on; returns what ends that. */
async function losing(page, address) {
  await page.route(address, (route) => route.abort());
  return () => page.unroute(address);
}

const begun = (page) => page.waitForFunction(() => window.fleetplan?.request);

for (const part of ["**/model/scene.js", "**/main.js", "**/styles/main.css"]) {
  test(`a page whose ${part} does not load says so, and loads again with its request`, async () => {
    await onNewPage(async (page, url) => {
      const found = await losing(page, part);
      await page.goto(url + REQUEST);
      await page.waitForSelector("#not-loaded.certain");
      assert.match(await page.innerText("#not-loaded"), /has not loaded completely/);
      await found();
      await page.click("#not-loaded a");
      await begun(page);
      assert.equal(await chosenExample(page), "partly-solvable");
      assert.equal(await page.locator("#not-loaded").count(), 0);
    });
  });
}

/**
 * Waits for the styles, by which the notice shows itself after a while, and puts this time at the page's command.
 * Returns how long it is, seconds, and a function that shows the notice at a time within it.
 */
async function stopNotice(page) {
  const after = await page.waitForFunction(() => {
    const notice = document.getElementById("not-loaded");
    const [late] = notice?.getAnimations() ?? [];
    if (late === undefined) return null;
    late.pause();
    return late.effect.getTiming().delay / 1000;
  });
  const at = (seconds) =>
    page.evaluate((time) => {
      const [late] = document.getElementById("not-loaded").getAnimations();
      late.currentTime = time * 1000;
    }, seconds);
  return { after: await after.jsonValue(), at };
}

test("a page that loads shows no such notice meanwhile", async () => {
  await onNewPage(async (page, url) => {
    let release;
    const held = new Promise((resolve) => (release = resolve));
    await page.route("**/main.js", async (route) => {
      await held;
      await route.continue();
    });
    await page.goto(url, { waitUntil: "commit" });
    await page.waitForSelector("#open-gallery");
    const { after, at } = await stopNotice(page);
    await at(after - 0.1);
    assert.equal(await page.isVisible("#not-loaded"), false);
    release();
    await begun(page);
  });
});

test("a page of which nothing arrives says so after a while", async () => {
  await onNewPage(async (page, url) => {
    await page.route(/(start|main)\.js/, () => {}); // they are never answered
    await page.goto(url, { waitUntil: "commit" });
    const { after, at } = await stopNotice(page);
    assert.equal(after, 10);
    await at(after - 0.1);
    assert.equal(await page.isVisible("#not-loaded"), false);
    await at(after + 0.1);
    assert.equal(await page.isVisible("#not-loaded"), true);
  });
});

test("without JavaScript the page says that it needs it", async () => {
  await onNewPage(
    async (page, url) => {
      await page.goto(url);
      assert.match(await page.innerText("noscript"), /requires JavaScript/);
      assert.equal(await page.isVisible("#not-loaded"), false);
    },
    { javaScriptEnabled: false },
  );
});

test("a request that is lost once is sent again", async () => {
  await onNewPage(async (page, url) => {
    const lost = new Set();
    await page.route("**/v1/**", (route) => {
      const address = route.request().url();
      if (lost.has(address)) return route.continue();
      lost.add(address);
      return route.abort();
    });
    await page.goto(url);
    await begun(page);
    assert.ok(lost.size >= 3, [...lost].join());
    assert.equal(await page.isVisible("#problem"), false);
  });
});

test("examples and limits that do not load are loaded again on demand", async () => {
  for (const part of ["**/v1/examples", "**/v1/limits"]) {
    await onNewPage(async (page, url) => {
      const found = await losing(page, part);
      await page.goto(url);
      await page.waitForSelector("#problem .again");
      assert.match(await page.innerText("#problem"), /No response from the service/);
      await found();
      await page.click("#problem .again");
      await begun(page);
      await page.waitForSelector("#problem", { state: "hidden" });
      assert.ok((await page.locator(".example").count()) > 3);
    });
  }
});

test("an example that does not load is loaded again on demand", async () => {
  await onNewPage(async (page, url) => {
    await page.goto(url);
    await begun(page);
    const found = await losing(page, "**/v1/examples/crossing");
    await pickExample(page, "crossing");
    await page.waitForSelector("#problem .again");
    await found();
    await page.click("#problem .again");
    await page.waitForFunction(() => location.hash === "#crossing");
    assert.equal(await page.isVisible("#problem"), false);
  });
});

test("gaps that cannot be computed, as a part is lost, are computed on demand", async () => {
  await onNewPage(async (page, url) => {
    const found = await losing(page, "**/clearance_worker.js");
    await page.goto(url);
    await begun(page);
    await pressPlan(page);
    await page.waitForSelector("#problem .again");
    await found();
    await page.click("#problem .again");
    await page.waitForFunction(() => window.fleetplan.least);
  });
});
