// The page as users get it, a bundle in a few files, and the same page from its sources.

import assert from "node:assert/strict";
import { test } from "node:test";
import { fileURLToPath } from "node:url";

import { pressPlan } from "../support/browser.js";
import { pagesFor } from "../support/on_page.js";

const SOURCES = fileURLToPath(new URL("../../../web", import.meta.url));
const HASHED = /-[A-Z2-7]{8}\.\w+$/;

const onBundle = pagesFor();
const onSources = pagesFor(["--web-root", SOURCES]);

/** Plans and waits for the clearance of the plan, which a worker computes. */
async function planAndClear(page) {
  await pressPlan(page);
  await page.waitForFunction(() => window.fleetplan.least);
}

/** The files of the page among the addresses asked for, without the service's answers. */
const filesIn = (requested) =>
  [...new Set(requested)].filter((address) => !/^\/(v1\/|healthz$)/.test(new URL(address).pathname));

test("the bundle is a page, four scripts, a style sheet, an icon and a worker, immutable but for the page", async () => {
  await onBundle(async (page, { requested, url }) => {
    await planAndClear(page);
    assert.equal(
      requested.some((address) => /analysis_panel|animation|html_page|viewer/.test(address)),
      false,
    );
    const files = filesIn(requested);
    assert.ok(files.includes(url));
    const kinds = files.filter((address) => address !== url).map((address) => /\w+$/.exec(address)[0]);
    assert.deepEqual(kinds.sort(), ["css", "js", "js", "js", "js", "js", "svg"]);
    for (const address of files) {
      const { headers } = await fetch(address);
      const expected = address === url ? "no-cache" : "public, max-age=31536000, immutable";
      assert.equal(headers.get("Cache-Control"), expected, address);
      assert.equal(HASHED.test(address), address !== url, address);
    }
  });
});

test("the page works from its sources", async () => {
  await onSources(async (page, { requested }) => {
    await planAndClear(page);
    const files = filesIn(requested);
    assert.ok(files.some((address) => address.endsWith("/main.js")));
    assert.ok(files.some((address) => address.endsWith("_worker.js")));
    for (const address of files) assert.doesNotMatch(address, HASHED);
  });
});
