// The page for people who hear it, use keys, or need the colours of their system.

import assert from "node:assert/strict";
import { test } from "node:test";

import { choose, pause, planned, pressPlan, seek } from "../support/browser.js";
import { hallWith } from "../support/hall.js";
import { drop } from "../support/map_files.js";
import { hook, pagesFor, paste, streamPlan } from "../support/on_page.js";

const onPage = pagesFor();

/** Keeps all that is announced from now on; returns what reads it. */
async function listen(page) {
  await page.evaluate(() => {
    const told = /** @type {any} */ (window.told = []);
    const announcer = document.getElementById("announcer");
    new MutationObserver(() => told.push(announcer.textContent)).observe(announcer, { childList: true });
  });
  return {
    hears: (words) =>
      page.waitForFunction(
        (expected) => /** @type {any} */ (window).told.some((text) => new RegExp(expected).test(text)),
        words.source,
      ),
  };
}

test("the start of planning, an opened file, the closest pair and events are announced", async () => {
  await onPage(async (page) => {
    const { hears } = await listen(page);
    await drop(page, { "north.json": JSON.stringify(hallWith(3)) });
    await hears(/^north\.json is open: 3 robots\.$/);
    await choose(page, "crossing");
    await hears(/^crossing is open: 8 robots\.$/);
    const { end } = await streamPlan(page, [
      ["progress", { elapsed_ms: 1, attempt: 1, planned: 0, robots: 8, best: null }],
    ]);
    await page.click("#plan");
    await hears(/^Planning\.$/);
    await page.click("#cancel");
    await end();
  });
  await onPage(async (page) => {
    await planned(page, "crossing");
    const { hears } = await listen(page);
    await page.click("#show-closest");
    await hears(/^Closest now: .+ and .+, .+ mm\.$|^Closest now: .+ and .+, .+ m\.$/);
    await seek(page, 0);
    await page.click("#next-event");
    await hears(/^\d+\.\d\d s: [\w-]+ (moving|turning|waiting|arrived)/);
    await page.click("#timeline-least");
    await hears(/^[\w-]+ and [\w-]+ at \d+\.\d\d s\.$/);
  });
});

test("the Robot tool says where the arrow keys have led, and whether a robot fits there", async () => {
  await onPage(async (page) => {
    await paste(page, {
      map: { rows: ["....", ".@..", "....", "...."] },
      robot_defaults: { radius: 0.4, linear_speed: 1, angular_speed: 1 },
      robots: [],
    });
    await page.waitForSelector("#placing:not([hidden])");
    const { hears } = await listen(page);
    await page.focus("#scene");
    await page.keyboard.press("ArrowDown");
    await hears(/^Start at \(\d+(\.\d+)?, \d+(\.\d+)?\) m/);
    await page.keyboard.press("Enter");
    await page.waitForFunction(() => window.fleetplan.request.robots.length === 1);
    await page.keyboard.press("ArrowRight");
    await hears(/^Goal of robot-1 at \(/);
  });
});

test("Simulate keeps the focus", async () => {
  await onPage(async (page) => {
    await planned(page, "hospital-ward");
    await page.click("#tab-analyse");
    const simulate = page.getByRole("button", { name: "Simulate", exact: true });
    await simulate.focus();
    await page.keyboard.press("Enter");
    await page.waitForSelector(".share-words");
    await page.waitForFunction(() => !document.querySelector("[aria-disabled=true]"));
    assert.equal(await simulate.evaluate((button) => document.activeElement === button), true);
  });
});

test("the list of robots is one stop of the Tab key, with arrows, and a key leads to the card and back", async () => {
  await onPage(async (page) => {
    await planned(page, "crossing");
    assert.equal(await page.locator('#robots .robot[tabindex="0"]').count(), 1);
    assert.equal(await page.locator('#robots .robot[tabindex="-1"]').count(), 7);
    await page.focus('#robots .robot[tabindex="0"]');
    const focused = () => page.evaluate(() => /** @type {any} */ (document.activeElement).dataset.robot);
    const ids = (await hook(page, "request")).robots.map(({ id }) => id);
    assert.equal(await focused(), ids[0]);
    await page.keyboard.press("ArrowDown");
    await page.keyboard.press("ArrowDown");
    assert.equal(await focused(), ids[2]);
    await page.keyboard.press("End");
    assert.equal(await focused(), ids[7]);
    await page.keyboard.press("Home");
    await page.keyboard.press("ArrowDown");
    await page.keyboard.press("ArrowRight");
    assert.equal(await hook(page, "selected"), ids[1]);
    assert.equal(await page.evaluate(() => document.activeElement.id), "inspector");
    await page.keyboard.press("Escape");
    assert.equal(await page.isVisible("#inspector"), false);
    assert.equal(await focused(), ids[1]);
    await page.keyboard.press("Tab");
    assert.equal(await focused(), undefined, "one press leaves the list");
  });
});

test("the scrubber tells its time in words", async () => {
  await onPage(async (page) => {
    const words = () => page.getAttribute("#scrubber", "aria-valuetext");
    await choose(page, "crossing");
    assert.equal(await words(), "no plan yet");
    await pressPlan(page);
    await pause(page);
    await seek(page, 5.24);
    assert.match(await words(), /^5\.2 seconds of \d+\.\d seconds$/);
  });
});

test("in forced colours, what is chosen stands out, and the scrubber and the legend are seen", async () => {
  await onPage(
    async (page) => {
      await planned(page, "crossing");
      await page.locator(".robot").nth(1).click();
      await page.mouse.move(5, 5);
      const ground = (selector) => page.$eval(selector, (part) => getComputedStyle(part).backgroundColor);
      const differs = async (chosen, other) =>
        assert.notEqual(await ground(chosen), await ground(other), chosen);
      await differs('.robot[aria-pressed="true"]', '.robot[aria-pressed="false"]');
      await differs('[role="tab"][aria-selected="true"]', '[role="tab"][aria-selected="false"]');
      await page.click("#tab-edit");
      await differs(".tool :checked + label", ".tool :not(:checked) + label");
      await page.click("#open-gallery");
      await differs(".example[aria-current]", ".example:not([aria-current])");
      await page.keyboard.press("Escape");
      const colours = await page.evaluate(() => {
        const colour = (selector, pseudo, property) =>
          getComputedStyle(document.querySelector(selector), pseudo)[property];
        return {
          swatches: [...document.querySelectorAll("#state-legend .swatch")].map(
            (swatch) => getComputedStyle(swatch).backgroundColor,
          ),
          form: colour(".timeline-legend .form", "::before", "backgroundColor"),
          panel: colour(".timeline", null, "backgroundColor"),
        };
      });
      assert.ok(new Set(colours.swatches).size >= 5, "the legend has colours of its own");
      assert.notEqual(colours.form, colours.panel);
      const box = await page.locator("#scrubber").boundingBox();
      const picture = await page.screenshot({ clip: box });
      await seek(page, 12);
      assert.notDeepEqual(await page.screenshot({ clip: box }), picture, "the scrubber shows the time");
    },
    { options: { forcedColors: "active" } },
  );
});
