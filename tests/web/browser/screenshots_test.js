// Pictures of the page for the README, written to build/screenshots; a picture of nothing fails.

import assert from "node:assert/strict";
import { mkdir } from "node:fs/promises";
import { after, before, test } from "node:test";
import { fileURLToPath } from "node:url";

import { choose, openPage, pressPlan, seek, startBrowser } from "../support/browser.js";
import { startService } from "../support/service.js";

const FOLDER = fileURLToPath(new URL("../../../build/screenshots/", import.meta.url));
const DESKTOP = { viewport: { width: 1440, height: 900 } };
const PHONE = { viewport: { width: 390, height: 844 }, isMobile: true, hasTouch: true, deviceScaleFactor: 2 };

let service;
let browser;

before(async () => {
  await mkdir(FOLDER, { recursive: true });
  service = await startService();
  browser = await startBrowser();
});

after(async () => {
  await browser?.close();
  await service?.stop();
});

for (const [size, options] of [
  ["desktop", DESKTOP],
  ["phone", PHONE],
]) {
  for (const colorScheme of ["light", "dark"]) {
    test(`the page has its picture taken: ${size}, ${colorScheme}`, async () => {
      const { page, complaints, close } = await openPage(browser, service.url, { ...options, colorScheme });
      await choose(page, "warehouse");
      const answer = await pressPlan(page);
      await page.keyboard.press("Space");
      await seek(page, answer.makespan * 0.3);
      const [longest] = [...answer.plans].sort((a, b) => b.cost - a.cost);
      await page.locator(`.robot[data-robot="${longest.robot}"]`).click();
      await page.mouse.move(5, 5);
      await page.evaluate(() => {
        scrollTo(0, 0);
        document.querySelector(".side-body").scrollTop = 0;
        document.activeElement.blur();
        return new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
      });
      await page.screenshot({ path: `${FOLDER}${size}-${colorScheme}.png` });
      assert.ok((await coloursIn(page)) > 50, "the scene is painted");
      assert.deepEqual(complaints, []);
      await close();
    });
  }
}

/** How many different colours the canvas shows. */
function coloursIn(page) {
  return page.evaluate(() => {
    const canvas = document.getElementById("scene");
    const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    return new Set(new Uint32Array(data.buffer)).size;
  });
}
