// Zooming over many robots, in headless Chromium.

import assert from "node:assert/strict";
import { test } from "node:test";

import { hallWith } from "../support/hall.js";
import { hook, pagesFor, paste } from "../support/on_page.js";

const onPage = pagesFor();
const ROBOTS = 300;
const FRAMES = 20;
const FRAME_MS = 16;

const HALL = hallWith(ROBOTS);

/** Counts the rings of goals that are painted from now on, in `window.rings`. */
const countRings = (page) =>
  page.evaluate(() => {
    window.rings = 0;
    const { arc } = CanvasRenderingContext2D.prototype;
    CanvasRenderingContext2D.prototype.arc = function (...circle) {
      if (!this.canvas.isConnected) window.rings += 1; // on the backdrop
      return arc.apply(this, circle);
    };
  });

test("while zooming, goals and paths are painted now and then, and again at rest", async () => {
  await onPage(async (page) => {
    await page.clock.install(); // the pace of frames is not the machine's
    await page.reload();
    await page.waitForFunction(() => window.fleetplan?.request);
    await paste(page, HALL);
    await page.waitForFunction((robots) => window.fleetplan.request.robots.length === robots, ROBOTS);
    await countRings(page);
    await page.clock.pauseAt(await page.evaluate(() => Date.now() + 100_000)); // and what is due by then is done
    const before = await page.evaluate(() => window.rings);
    const radiusOf = () => page.evaluate(() => window.fleetplan.screenOf("robot-0").radius);
    const small = await radiusOf();
    const ringsSince = async () => (await page.evaluate(() => window.rings)) - before;
    for (let frame = 0; frame < FRAMES; frame += 1) {
      await page.evaluate(() =>
        document.getElementById("scene").dispatchEvent(
          new WheelEvent("wheel", {
            deltaY: -5,
            clientX: 700,
            clientY: 300,
            bubbles: true,
            cancelable: true,
          }),
        ),
      );
      await page.clock.runFor(FRAME_MS);
    }
    assert.ok((await radiusOf()) > small * 1.1, "it was zoomed");
    const whileZooming = await ringsSince();
    assert.ok(whileZooming <= ROBOTS, `${whileZooming} rings in ${FRAMES} frames`);
    await page.clock.runFor(500);
    assert.equal(await ringsSince(), whileZooming + ROBOTS, "the exact picture");
    assert.equal((await hook(page, "request")).robots.length, ROBOTS);
  });
});
