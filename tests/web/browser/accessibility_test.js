// The states of the page without a violation of axe-core's rules, on desktops and phones, light and dark.

import { test } from "node:test";

import { assertAccessible, COLOUR_RULES } from "../support/axe.js";
import { choose, pressPlan, seek } from "../support/browser.js";
import { drop, pgm } from "../support/map_files.js";
import { pagesFor, paste, REFUSED } from "../support/on_page.js";

const SIZES = {
  desktop: {},
  phone: { viewport: { width: 390, height: 844 }, isMobile: true, hasTouch: true },
};
const onPage = pagesFor();

/** Plans an example and shows its third second; nothing plays, as motion is reduced. */
async function planned(page, example) {
  await choose(page, example);
  await pressPlan(page);
  await seek(page, 3);
}

const openSections = (page, panel) =>
  page.evaluate((id) => {
    /** @type {HTMLDetailsElement} */ for (const section of document.querySelectorAll(`#${id} details`))
      section.open = true;
  }, panel);

/** Shows a tab with all of its sections. */
async function openTab(page, name) {
  await page.click(`#tab-${name}`);
  await openSections(page, `panel-${name}`);
}

const STATES = {
  "a new map without robots": async (page) => {
    await openTab(page, "edit");
    await page.click("#new-map button");
  },
  "robots to place": async (page) => {
    await page.click("#placing-robots");
    await page.keyboard.press("Enter");
    await page.fill("#placing-radius input", "40");
    await page.waitForSelector("#placing-fit.wrong");
  },
  "the gallery of examples": async (page) => {
    await page.click("#open-gallery");
  },
  "a form to paste into": async (page) => {
    await page.keyboard.press("Escape");
    await page.click("#paste");
  },
  "a request with faults": async (page) => {
    await page.click("#paste");
    await paste(page, {
      map: { rows: ["..x"] },
      robots: [{ id: "a", radius: -1, start: { x: 0.5, y: 0.5 } }],
    });
    await page.waitForSelector("#problem .errors");
  },
  "a plan": async (page) => {
    await planned(page, "warehouse");
    await openTab(page, "plan");
  },
  "the robots of one state": async (page) => {
    await page.selectOption("#robot-filter", "delayed");
    await page.selectOption("#robot-filter", "all");
  },
  "a selected robot": (page) => page.locator(".robot").first().click(),
  "several chosen robots": (page) => page.click("#choose-listed"),
  "the menu of the view": (page) => page.click("#view-menu summary"),
  "the menu to save": async (page) => {
    await page.click("#view-menu summary");
    await page.click("#save-menu summary");
  },
  "the form of several robots": async (page) => {
    await page.click("#save-menu summary");
    await openTab(page, "edit");
  },
  "the form of a robot": (page) => page.selectOption("#edited-robot", "0"),
  "the edit of a plan": async (page) => {
    const box = await page.locator("#scene").boundingBox();
    await page.click("label[for=tool-wall]");
    await page.mouse.click(box.x + box.width / 2, box.y + box.height / 2);
  },
  "the options": async (page) => {
    await openTab(page, "options");
    await page.waitForSelector('#options [data-pointer="/options/inflation"]');
    await openSections(page, "panel-options");
  },
  "a partial plan": async (page) => {
    await planned(page, "partly-solvable");
    await openTab(page, "plan");
    await page.locator("#unplanned button").first().click();
  },
  "a checked plan": async (page) => {
    await page.click("#check-plan");
    await page.waitForSelector("#check:not([hidden])");
  },
  "the analyses": async (page) => {
    await planned(page, "hospital-ward");
    await openTab(page, "analyse");
    await page.waitForSelector(".simulation");
    await openSections(page, "panel-analyse");
    await page.getByRole("button", { name: "Simulate" }).click();
    await page.waitForSelector(".share-words");
  },
  "two plans that are compared": async (page) => {
    await page.evaluate(() => /** @type {HTMLElement} */ (document.activeElement)?.blur());
    await pressPlan(page);
    await page.getByLabel("Compare the plan with").selectOption("before 0");
  },
  "zones and moving obstacles": async (page) => {
    await choose(page, "crossing-people");
    await openTab(page, "edit");
    await page.selectOption("#edited-obstacle", "0");
  },
  "the dialog of a ROS map": async (page) => {
    const yaml =
      "image: lab.pgm\nresolution: 0.1\norigin: [0, 0, 0]\noccupied_thresh: 0.65\nfree_thresh: 0.2\n";
    await drop(page, {
      "lab.yaml": yaml,
      "lab.pgm": pgm([
        [0, 254, 254],
        [254, 205, 0],
      ]),
    });
    await page.waitForSelector("dialog[open]");
  },
};

/** All rules in the light colours, and the rules that depend on colours in the dark ones. */
async function assertAccessibleInBoth(page, state) {
  await assertAccessible(page, `${state}, light`);
  await page.emulateMedia({ colorScheme: "dark" });
  await assertAccessible(page, `${state}, dark`, COLOUR_RULES);
  await page.emulateMedia({ colorScheme: "light" });
}

for (const [size, options] of Object.entries(SIZES)) {
  test(`no state of the page violates a rule of axe-core, ${size}, light and dark`, async () => {
    await onPage(
      async (page) => {
        await page.waitForSelector("#welcome:not([hidden])");
        await assertAccessibleInBoth(page, "a first visit");
        await choose(page, "crossing");
        await assertAccessibleInBoth(page, "an example");
        for (const [state, reach] of Object.entries(STATES)) {
          await reach(page);
          await assertAccessibleInBoth(page, state);
        }
      },
      {
        options: { ...options, isNew: true, colorScheme: "light", reducedMotion: "reduce" },
        allowed: REFUSED,
      },
    );
  });
}
