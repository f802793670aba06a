// Zooming over many robots, in headless Chromium.

import assert from "node:assert/strict";
import { test } from "node:test";

import { hallWith } from "../support/hall.js";
import { hook, pagesFor, paste } from "../support/on_page.js";

const onPage = pagesFor();
const ROBOTS = 300;

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
    await paste(page, HALL);
    await page.waitForFunction((robots) => window.fleetplan.request.robots.length === robots, ROBOTS);
    await countRings(page);
    const rings = await page.evaluate(async () => {
      const canvas = document.getElementById("scene");
      const frame = () => new Promise((done) => requestAnimationFrame(done));
      let frames = 0;
      for (const begin = performance.now(); performance.now() - begin < 300; frames += 1) {
        canvas.dispatchEvent(
          new WheelEvent("wheel", {
            deltaY: -5,
            clientX: 700,
            clientY: 300,
            bubbles: true,
            cancelable: true,
          }),
        );
        await frame();
      }
      return { frames, whileZooming: window.rings };
    });
    assert.ok(rings.frames >= 3, "it was zoomed");
    assert.ok(rings.whileZooming <= 2 * ROBOTS, `${rings.whileZooming} rings in ${rings.frames} frames`);
    await page.waitForFunction((before) => window.rings > before, rings.whileZooming); // the exact picture
    assert.equal((await hook(page, "request")).robots.length, ROBOTS);
  });
});
