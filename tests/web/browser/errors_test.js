// What goes wrong, as people meet it: services that go away or are busy, files that are too large or of another kind,
// names with markup. Also unusual windows, zoom and keyboards. In headless Chromium.

import assert from "node:assert/strict";
import { test } from "node:test";

import { choose, pause, pressPlan } from "../support/browser.js";
import { drop } from "../support/map_files.js";
import { hook, NO_ANSWER, pagesFor, paste, REFUSED, twoFrames } from "../support/on_page.js";

const onPage = pagesFor();

const problem = async (page) => {
  await page.waitForSelector("#problem:not([hidden])");
  return page.innerText("#problem");
};

/** Opens a tab of the panels by keys. */
async function openTab(page, name) {
  await page.focus(`#tab-${name}`);
  await page.keyboard.press("Enter");
}

for (const [what, [answer, words]] of Object.entries(NO_ANSWER)) {
  test(`a service that ${what} in the middle is told wherever it is asked, and asked again by the same button`, async () => {
    await onPage(
      async (page) => {
        await choose(page, "hospital-ward");
        await pressPlan(page);
        await pause(page);
        const named = (name) => page.getByRole("button", { name, exact: true });
        const asked = [
          ["plan", null, page.locator("#check-plan"), () => window.fleetplan.check?.valid],
          ["analyse", null, named("Simulate"), () => document.querySelector(".share-words")],
          [
            "analyse",
            "Dependencies",
            named("Show dependencies"),
            () => /dependencies in the plan/.test(document.body.innerText),
          ],
          [
            "analyse",
            "Continuous operation",
            named("Run"),
            () => /[1-9]\d* round/.test(document.body.innerText),
          ],
        ];
        for (const [tab, section, button, isDone] of asked) {
          await openTab(page, tab);
          if (section) await page.getByText(section, { exact: true }).click();
          await page.route(/v1\/(validate|simulate|dependencies|advance)/, answer);
          await button.click();
          assert.match(await problem(page), words, `${section ?? tab}`);
          await page.unroute(/v1\/(validate|simulate|dependencies|advance)/);
          await page.evaluate(() => (document.getElementById("problem").hidden = true));
          await button.click();
          await page.waitForFunction(isDone);
        }
      },
      { allowed: /ERR_FAILED|status of 503/ },
    );
  });
}

test("a file of 50 MB, and one of another kind, are refused at once, and the page goes on", async () => {
  await onPage(async (page) => {
    const before = await hook(page, "request");
    const dropLarge = (name) =>
      page.evaluate((fileName) => {
        const dataTransfer = new DataTransfer();
        dataTransfer.items.add(new File([new Uint8Array(50e6).fill(0x20)], fileName));
        document.body.dispatchEvent(new DragEvent("drop", { dataTransfer, bubbles: true, cancelable: true }));
      }, name);
    await dropLarge("fleet.json");
    assert.match(await problem(page), /fleet\.json has 50 MB, and the service accepts at most 33\.6 MB\./);
    await dropLarge("film.mp4");
    await page.waitForFunction(() => /film\.mp4 is not a supported/.test(document.body.innerText));
    assert.deepEqual(await hook(page, "request"), before);
    assert.equal((await pressPlan(page)).verified, true);
  });
});

const MARKUP = `"><img src=x onerror="window.injected = 1"><b>'\`\${1}&amp;`;

test("names with markup are texts everywhere", async () => {
  await onPage(
    async (page) => {
      const lane = (id, y, more = {}) => ({ id, start: { x: 0.5, y }, goal: { x: 7.5, y }, ...more });
      const request = {
        map: { rows: Array(5).fill("........") },
        robot_defaults: { radius: 0.3, linear_speed: 1, angular_speed: 1 },
        robots: [lane(MARKUP, 0.5), lane("b", 2.5), lane("c", 4.5)],
        zones: [
          {
            id: MARKUP,
            type: "blocked",
            polygon: [
              { x: 3, y: 1.5 },
              { x: 4, y: 1.5 },
              { x: 4, y: 2 },
            ],
          },
        ],
        obstacles: [{ id: `${MARKUP}!`, radius: 0.2, motion: [{ t: 0, x: 6, y: 3.5 }] }],
      };
      const isText = async (where) => {
        assert.equal(await page.evaluate(() => window.injected), undefined, where);
        assert.equal(await page.locator('img[src="x"]').count(), 0, where);
      };
      await drop(page, { [`${MARKUP.replaceAll("/", "")}.json`]: JSON.stringify(request) });
      await page.waitForFunction(() => window.fleetplan.request.robots.length === 3);
      assert.ok((await page.innerText("#request-name")).includes(MARKUP));
      await pressPlan(page);
      await pause(page);
      await page.locator("#robots .robot").first().click();
      assert.ok((await page.innerText("#inspector")).includes(MARKUP));
      await page.click("#choose-listed");
      await page.evaluate(() => document.activeElement.blur());
      await pressPlan(page);
      for (const tab of ["edit", "options", "analyse"]) {
        await openTab(page, tab);
        await isText(tab);
      }
      await page.getByText("Compare plans", { exact: true }).click();
      await page.getByLabel("Compare the plan with").selectOption("before 0");
      await page.waitForSelector(".differences");
      await isText("a comparison");
      await paste(page, { ...request, robots: [{ ...request.robots[0], radius: MARKUP }] });
      assert.ok((await problem(page)).includes(MARKUP));
      await isText("a fault");
    },
    { allowed: REFUSED },
  );
});

test("at 200 % zoom, and in a window of 320 pixels, nothing is cut off", async () => {
  await onPage(
    async (page) => {
      await choose(page, "partly-solvable");
      await pressPlan(page);
      for (const [width, height] of [
        [720, 450], // 1440 by 900 at 200 %
        [320, 568],
      ]) {
        await page.setViewportSize({ width, height });
        for (const tab of ["plan", "edit", "options", "analyse"]) {
          await openTab(page, tab);
          await twoFrames(page); // until then, what was hidden may have the layout of the former width
          if (tab === "options") await page.waitForSelector("#option-inflation");
          const cut = await page.evaluate(() =>
            [...document.querySelectorAll("button, select, input, summary, p, h2")]
              .filter(
                (part) =>
                  part.checkVisibility() && !part.closest(".examples, .visually-hidden, .figures-table"),
              )
              .filter((part) => !part.matches(".visually-hidden"))
              .filter((part) => {
                const { left, right } = part.getBoundingClientRect();
                return left < -1 || right > innerWidth + 1;
              })
              .map((part) => part.id || part.textContent),
          );
          assert.deepEqual(cut, [], `${tab} at ${width} pixels`);
          assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), tab);
        }
      }
    },
    { options: { deviceScaleFactor: 2 } },
  );
});

/** Presses a key until an element that matches has the focus. */
async function pressUntil(page, key, selector) {
  for (let presses = 0; presses < 60; presses += 1) {
    await page.keyboard.press(key);
    if (await page.evaluate((wanted) => document.activeElement.matches(wanted), selector)) return;
  }
  assert.fail(`${key} does not lead to ${selector}`);
}

test("by keys alone an example is chosen and planned, the plan paused, and a robot of it inspected", async () => {
  await onPage(async (page) => {
    const first = await hook(page, "request");
    await pressUntil(page, "Tab", "#open-gallery");
    await page.keyboard.press("Enter");
    await pressUntil(page, "Tab", ".example:not([aria-current])");
    await page.keyboard.press("Enter");
    await page.waitForFunction(
      (text) => JSON.stringify(window.fleetplan.request) !== text,
      JSON.stringify(first),
    );
    await pressUntil(page, "Tab", "#plan");
    await page.keyboard.press("Enter");
    await page.waitForFunction(() => window.fleetplan.time > 0);
    await page.waitForFunction(() => document.activeElement.id === "play");
    if (await hook(page, "playing")) await page.keyboard.press("Enter");
    assert.equal(await hook(page, "playing"), false);
    await pressUntil(page, "Tab", ".robot");
    await page.keyboard.press("Enter");
    const [{ id }] = (await hook(page, "request")).robots;
    assert.equal(await hook(page, "selected"), id);
    assert.ok((await page.innerText("#inspector")).includes(id));
    await page.keyboard.press("Escape");
    assert.equal(await hook(page, "selected"), null);
  });
});
