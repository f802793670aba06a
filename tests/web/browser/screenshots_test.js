// Pictures of the page's main states for the README, written to build/screenshots; a picture of nothing fails.

import assert from "node:assert/strict";
import { mkdir } from "node:fs/promises";
import { test } from "node:test";
import { fileURLToPath } from "node:url";

import { choose, planAndPause, pressPlan, seek } from "../support/browser.js";
import { hook, pagesFor } from "../support/on_page.js";

const FOLDER = fileURLToPath(new URL("../../../build/screenshots/", import.meta.url));
const SIZES = {
  desktop: { viewport: { width: 1440, height: 900 } },
  phone: { viewport: { width: 390, height: 844 }, isMobile: true, hasTouch: true, deviceScaleFactor: 2 },
};
const onPage = pagesFor();

await mkdir(FOLDER, { recursive: true });

/** An example's plan, at rest a third on, with a robot selected. */
async function planned(page, example, robot) {
  await choose(page, example);
  const answer = await planAndPause(page);
  await seek(page, answer.makespan * 0.3);
  await page.locator(`.robot[data-robot="${robot}"]`).click();
}

const STATES = {
  plan: (page) => planned(page, "warehouse", "tote-21"),
  "plan-of-some": (page) => planned(page, "partly-solvable", "late-comer"),
  edit: async (page) => {
    await planned(page, "crossing", "heavy-east");
    await page.keyboard.press("r");
    await page.click("#tab-edit");
  },
  check: async (page) => {
    await choose(page, "corridor-swap");
    const answer = await pressPlan(page);
    const request = await hook(page, "request");
    const [east, west] = answer.plans;
    const crash = {
      plans: [east, { ...west, actions: west.actions.slice(0, 1), cost: west.actions[0].t_end }],
    };
    const buffer = Buffer.from(JSON.stringify({ ...request, ...answer, ...crash }));
    await page.setInputFiles("#file", { name: "crash.plan.json", mimeType: "application/json", buffer });
    await page.locator(".violation[data-kind=robot_collision]").click();
  },
};

for (const [state, reach] of Object.entries(STATES)) {
  for (const [size, options] of Object.entries(SIZES)) {
    test(`the page has its picture taken: ${state}, ${size}, light and dark`, async () => {
      await onPage(
        async (page) => {
          await reach(page);
          await page.mouse.move(5, 5);
          for (const colorScheme of /** @type {const} */ (["light", "dark"])) {
            await page.emulateMedia({ colorScheme });
            await page.evaluate(() => {
              scrollTo(0, 0);
              document.querySelector(".side-body").scrollTop = 0;
              document.activeElement.blur();
              return new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
            });
            await page.screenshot({ path: `${FOLDER}${state}-${size}-${colorScheme}.png` });
            assert.ok((await coloursIn(page)) > 20, "the scene is painted");
          }
        },
        { options },
      );
    });
  }
}

/** How many different colours the canvas shows. */
function coloursIn(page) {
  return page.evaluate(() => {
    const canvas = /** @type {HTMLCanvasElement} */ (document.getElementById("scene"));
    const { width, height } = canvas;
    const copy = new OffscreenCanvas(width, height).getContext("2d", { willReadFrequently: true });
    copy.drawImage(canvas, 0, 0);
    const { data } = copy.getImageData(0, 0, width, height);
    return new Set(new Uint32Array(data.buffer)).size;
  });
}
