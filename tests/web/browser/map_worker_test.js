// Maps are read in a worker, so that the page goes on meanwhile. In headless Chromium.

import assert from "node:assert/strict";
import { test } from "node:test";

import { choose } from "../support/browser.js";
import { drop, pgm } from "../support/map_files.js";
import { hook, pagesFor, paste } from "../support/on_page.js";

const onPage = pagesFor();
const GRAYS = [
  [254, 254, 254, 254],
  [254, 0, 0, 254],
  [254, 254, 254, 254],
];
const ROS_MAP = {
  "room.yaml": "image: room.pgm\nresolution: 1\norigin: [0, 0, 0]\nnegate: 0\n",
  "room.pgm": pgm(GRAYS),
};
const REQUEST = {
  map: { image: { pgm: pgm(GRAYS).toString("base64"), resolution: 1 } },
  robot_defaults: { radius: 0.4, linear_speed: 1, angular_speed: 1 },
  robots: [{ id: "one", start: { x: 0.5, y: 0.5 }, goal: { x: 3.5, y: 2.5 } }],
};

for (const [what, open] of [
  ["the image of a request's map", (page) => paste(page, REQUEST)],
  ["a map of ROS", (page) => drop(page, ROS_MAP)],
]) {
  test(`${what} is read in a worker`, async () => {
    await onPage(async (page) => {
      const started = page.waitForEvent("worker", (worker) => /map_worker/.test(worker.url()));
      await open(page);
      await started;
    });
  });
}

test("a map that no worker can read is not opened, and the page says why", async () => {
  await onPage(
    async (page) => {
      await page.route(/map_worker/, (route) => route.abort());
      const before = await hook(page, "request");
      await drop(page, ROS_MAP);
      await page.waitForSelector("#problem:not([hidden])");
      assert.match(await page.innerText("#problem"), /room\.pgm.*cannot read maps.*Reload the page/s);
      assert.deepEqual(await hook(page, "request"), before);

      await page.unroute(/map_worker/);
      await drop(page, ROS_MAP);
      await page.click("dialog[open] .primary");
      await page.waitForFunction(() => window.fleetplan.request.robots.length === 0);
    },
    { allowed: /ERR_FAILED|Failed to fetch|map_worker/ },
  );
});

test("a map that is still being read shows no dialog when something else was opened", async () => {
  await onPage(async (page) => {
    let release;
    const held = new Promise((resolve) => (release = resolve));
    await page.route(/map_worker/, async (route) => {
      await held;
      await route.continue();
    });
    const asked = page.waitForRequest(/map_worker/);
    await drop(page, ROS_MAP);
    await asked;
    await choose(page, "crossing");
    const answered = page.evaluate(
      () =>
        new Promise((resolve) => {
          const { showModal } = HTMLDialogElement.prototype;
          HTMLDialogElement.prototype.showModal = function () {
            resolve("a dialog");
            return showModal.call(this);
          };
          document.addEventListener("read", () => resolve("none"));
        }),
    );
    release();
    await paste(page, REQUEST); // is read after the map
    await page.waitForFunction(() => window.fleetplan.request.map.image);
    await page.evaluate(() => document.dispatchEvent(new Event("read")));
    assert.equal(await answered, "none");
  });
});
