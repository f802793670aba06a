// What the page tells when something is not as expected: once, in words, and without moving what somebody looks at.

import assert from "node:assert/strict";
import { test } from "node:test";

import { choose, planned, pressPlan } from "../support/browser.js";
import { drop, pgm } from "../support/map_files.js";
import { countColour, hook, pagesFor, paste, pasteText, REFUSED, themeColour } from "../support/on_page.js";
import { press } from "../support/scene_pointer.js";

const onPage = pagesFor();

const EMPTY_HALL = {
  map: { rows: Array(20).fill(".".repeat(30)) },
  robot_defaults: { radius: 0.3, linear_speed: 1, angular_speed: 1 },
  robots: [],
};
const two = (more) => ({
  ...EMPTY_HALL,
  robots: [
    { id: "Heavy-east", start: { x: 2, y: 2 }, goal: { x: 20, y: 2 }, ...more },
    { id: "b", start: { x: 2, y: 10 }, goal: { x: 20, y: 10 } },
  ],
});

test("a fault that comes while somebody types is told at the field, once, and the field stays where it is", async () => {
  await onPage(
    async (page) => {
      await paste(page, two());
      await page.click("#tab-edit");
      await page.selectOption("#edited-robot", "0");
      const field = page.locator("#robot-start-numbers input").first();
      await field.click();
      const before = (await field.boundingBox()).y;
      await field.fill("0.1");
      await page.waitForSelector("#robot-start .field-error");
      assert.equal((await field.boundingBox()).y, before);
      const words = "Heavy-east does not fit at its start: it needs 0.2 m more than is free.";
      assert.equal(await page.getByText(words).count(), 1);
      assert.equal(await page.isVisible("#problem"), false);
      await page.click("#tab-plan");
      await page.waitForSelector("#problem:not([hidden])");
      const shown = await page.innerText("#problem");
      assert.ok(shown.includes(words), shown);
      assert.equal(shown.includes("/robots/0"), false, "pointers are in the details");
      await page.click("#problem details summary");
      assert.match(await page.innerText("#problem"), /\/robots\/0\/start/);
    },
    { allowed: REFUSED },
  );
});

test("a fault of something else does not move the field that is typed in out of sight", async () => {
  await onPage(
    async (page) => {
      await paste(page, two());
      await page.click("#tab-edit");
      await page.selectOption("#edited-robot", "1");
      const field = page.locator("#robot-goal-numbers input").first();
      await field.click();
      await page.route("**/v1/validate", (route) =>
        route.fulfill({
          status: 422,
          contentType: "application/problem+json",
          body: JSON.stringify({
            title: "Invalid Request",
            status: 422,
            errors: [{ pointer: "/robots/0/start", code: "x", detail: "Too near to the wall." }],
          }),
        }),
      );
      await field.fill("19");
      await page.waitForSelector("#problem:not([hidden])");
      const { y, height } = await field.boundingBox();
      assert.ok(y >= 0 && y + height <= 900, `the field is at ${y}`);
      const isSeen = await field.evaluate((input) => {
        const box = input.getBoundingClientRect();
        return document.elementFromPoint(box.left + 5, box.top + box.height / 2) === input;
      });
      assert.equal(isSeen, true, "nothing covers it");
    },
    { allowed: REFUSED },
  );
});

test("tools end with Plan and with opening something", async () => {
  await onPage(async (page) => {
    await choose(page, "crossing");
    await page.keyboard.press("w");
    assert.equal(await page.isChecked("#tool-wall"), true);
    await pressPlan(page);
    assert.equal(await page.isChecked("#tool-select"), true);
    await page.keyboard.press("z");
    await page.click("#ruler");
    await choose(page, "corridor-swap");
    assert.equal(await page.isChecked("#tool-select"), true);
    assert.equal(await page.getAttribute("#ruler", "aria-pressed"), "false");
    await page.click("#ruler");
    await pressPlan(page);
    assert.equal(await page.getAttribute("#ruler", "aria-pressed"), "false");
  });
});

test("a click for a goal outside the map says so, and the next one inside places it", async () => {
  await onPage(async (page) => {
    await paste(page, EMPTY_HALL);
    await page.waitForSelector("#placing:not([hidden])");
    await press(page, { x: 5.5, y: 5.5 });
    await page.waitForFunction(() => window.fleetplan.request.robots.length === 1);
    await press(page, { x: 5.5, y: 21 });
    assert.equal(await page.innerText("#placing-fit"), "The goal would be outside the map.");
    assert.equal((await hook(page, "request")).robots[0].goal, undefined);
    await press(page, { x: 9.5, y: 5.5 });
    await page.waitForFunction(() => window.fleetplan.request.robots[0].goal?.x === 9.5);
    assert.doesNotMatch(await page.innerText("#placing-fit"), /outside/);
  });
});

test("the card of a robot that is held says so", async () => {
  await onPage(async (page) => {
    await planned(page, "crossing");
    await page.locator('.robot[data-robot="heavy-east"]').click();
    await page.click("#tab-analyse");
    await page.getByText("Continuous operation", { exact: true }).click();
    await page.getByRole("button", { name: "Run", exact: true }).click();
    await page.getByRole("button", { name: "Hold heavy-east" }).click();
    await page.waitForFunction(
      () => document.querySelector("#inspector .robot-state")?.textContent === "held",
    );
    await page.getByRole("button", { name: "Stop", exact: true }).click();
    await page.waitForFunction(
      () => document.querySelector("#inspector .robot-state")?.textContent !== "held",
    );
  });
});

test("two plans beside each other are not covered by the card of a robot", async () => {
  await onPage(async (page) => {
    await planned(page, "crossing");
    await pressPlan(page);
    await page.click("#tab-analyse");
    await page.getByText("Compare plans", { exact: true }).click();
    await page.getByLabel("Compare the plan with").selectOption("before 0");
    await page.waitForSelector("#other-scene");
    await page.evaluate(() =>
      /** @type {HTMLElement} */ (document.querySelector(".robot[data-robot]")).click(),
    );
    await page.waitForSelector("#inspector:not([hidden])");
    const scene = await page.locator("#scene-frame").boundingBox();
    const card = await page.locator("#inspector").boundingBox();
    assert.ok(card.y >= scene.y + scene.height - 1, `the card begins at ${card.y}`);
  });
});

test("many selected robots have rings, and no names that would cover the map", async () => {
  await onPage(async (page) => {
    const robots = Array.from({ length: 300 }, (_, at) => {
      const place = { x: 0.5 + (at % 30), y: 0.5 + Math.floor(at / 30) * 2 };
      return { id: `robot-with-a-long-name-${at}`, radius: 0.2, start: place };
    });
    await paste(page, { ...EMPTY_HALL, robots });
    const ink = await themeColour(page, "--scene-ink");
    const middle = await page.evaluate(() => window.fleetplan.pointOf({ x: 15, y: 10 }));
    await page.click("#choose-listed");
    const many = await countColour(page, ink, middle, Infinity);
    await page.evaluate(() => /** @type {HTMLElement} */ (document.activeElement).blur());
    await page.keyboard.press("Escape");
    await page.locator(".robot").first().click();
    await page.mouse.move(5, 5);
    const one = await countColour(page, ink, middle, Infinity);
    assert.ok(one > 500, "a name has a ground of ink");
    assert.ok(many < 300 * one * 0.3, `${many} pixels for 300 robots, ${one} for one`);
  });
});

test("a service that does not answer is called late, until it answers", async () => {
  await onPage(async (page) => {
    await choose(page, "crossing");
    await pressPlan(page);
    let answer = () => {};
    const asked = new Promise((done) => (answer = /** @type {any} */ (done)));
    await page.route("**/v1/validate", async (route) => {
      await asked;
      await route.continue();
    });
    await page.clock.install();
    await page.click("#check-plan");
    await page.clock.runFor(9_000);
    assert.equal(await page.innerText("#late"), "");
    await page.clock.runFor(2_000);
    assert.match(await page.innerText("#late"), /has not answered for 10 s/);
    answer();
    await page.waitForFunction(() => window.fleetplan.check?.valid);
    assert.equal(await page.innerText("#late"), "");
  });
});

test("planning whose time budget is long over is called late", async () => {
  await onPage(async (page) => {
    await choose(page, "crossing");
    await page.clock.install();
    await page.route("**/v1/plan", () => {});
    await page.click("#plan");
    await page.clock.runFor(30_000);
    assert.match(await page.innerText("#so-far"), /The service is late/);
    await page.click("#cancel");
  });
});

for (const member of ["warnings", "unplanned", "plans"]) {
  test(`an answer without "${member}" is told to be of another version`, async () => {
    await onPage(async (page) => {
      await choose(page, "corridor-swap");
      await page.route("**/v1/plan", async (route) => {
        const headers = { ...route.request().headers(), accept: "application/json" };
        const response = await route.fetch({ headers });
        const { [member]: _, ...rest } = await response.json();
        await route.fulfill({ json: rest });
      });
      await page.click("#plan");
      await page.waitForSelector("#problem:not([hidden])");
      assert.match(await page.innerText("#problem"), new RegExp(`another version.*“${member}”`, "s"));
      await page.unroute("**/v1/plan");
      assert.equal((await pressPlan(page)).status, "solved");
    });
  });
}

test("deep and huge JSON is refused in words, within a second", async () => {
  await onPage(async (page) => {
    const before = await hook(page, "request");
    const refused = async (text, words) => {
      const began = await page.evaluate(() => performance.now());
      await pasteText(page, text);
      await page.waitForFunction(
        (expected) => new RegExp(expected).test(document.getElementById("problem").innerText),
        words,
      );
      return (await page.evaluate(() => performance.now())) - began;
    };
    await refused(`{"map": ${"[".repeat(2_000_000)}`, "nested more than 32 deep, the service's limit");
    await page.evaluate(() => {
      const text = /** @type {HTMLTextAreaElement} */ (document.getElementById("paste-text"));
      text.value = " ".repeat(40e6);
      text.form.requestSubmit();
    });
    await page.waitForFunction(() => /has 40 MB/.test(document.getElementById("problem").innerText));
    assert.deepEqual(await hook(page, "request"), before);
  });
});

test("a ROS map that is turned by no quarter is refused with the remedy", async () => {
  await onPage(async (page) => {
    const yaml = "image: lab.pgm\nresolution: 0.1\norigin: [0, 0, 0.3]\n";
    await drop(page, { "lab.yaml": yaml, "lab.pgm": pgm([[254, 254]]) });
    await page.waitForSelector("#problem:not([hidden])");
    assert.match(await page.innerText("#problem"), /turned by 0\.3 rad.*set the yaw to 0/s);
  });
});
