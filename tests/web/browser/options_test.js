// The options' form, and errors at the places they mean.

import assert from "node:assert/strict";
import { test } from "node:test";

import { choose, pressPlan } from "../support/browser.js";
import { countColour, hook, pagesFor, paste, REFUSED, themeColour } from "../support/on_page.js";

const onPage = pagesFor();

const ROBOT = { id: "a", radius: 0.3, linear_speed: 1, angular_speed: 1, start: { x: 0.5, y: 0.5 } };
const REQUEST = {
  map: { rows: [".....", "....."] },
  robots: [ROBOT, { ...ROBOT, id: "b", start: { x: 2.5, y: 1.5 }, goal: { x: 4.5, y: 0.5 } }],
};

const requestIs = (page, expected) =>
  page.waitForFunction((text) => JSON.stringify(window.fleetplan.request) === text, JSON.stringify(expected));

test("options are set in the request, and defaults are omitted", async () => {
  await onPage(async (page) => {
    await paste(page, REQUEST);
    await page.click("#tab-options");
    await page.getByText("Expert", { exact: true }).click();
    await page.fill("#option-seed", "12");
    await page.selectOption("#option-mode", "anytime");
    await page.fill("#option-max_iterations", "20");
    await page.uncheck("#option-any_angle");
    await page.selectOption("#option-connectivity", "16");
    const options = { seed: 12, mode: "anytime", max_iterations: 20, any_angle: false, connectivity: 16 };
    await requestIs(page, { ...REQUEST, options });
    const answer = await pressPlan(page);
    assert.deepEqual([answer.status, answer.deterministic], ["solved", true]);
    await page.click(".option:has(#option-mode) .reset");
    await requestIs(page, {
      ...REQUEST,
      options: { seed: 12, max_iterations: 20, any_angle: false, connectivity: 16 },
    });
    assert.deepEqual(await hook(page, "outdated"), [], "all plans hold with other options");
    await page.click("#reset-options");
    await requestIs(page, REQUEST);
    assert.equal(await page.inputValue("#option-seed"), "0");
  });
});

test("the form has the options of the service's document, fetched when the tab is opened", async () => {
  await onPage(async (page, { requested }) => {
    const asked = () => requested.filter((address) => address.endsWith("/v1/openapi.json")).length;
    assert.equal(asked(), 0);
    await page.click("#tab-options");
    await page.waitForSelector("#option-inflation");
    const { components } = await page.evaluate(async () => (await fetch("v1/openapi.json")).json());
    const { properties } = components.schemas.PlanOptions;
    const shown = await page.evaluate(() =>
      [...document.querySelectorAll("#options [id^=option-]:is(input, select)")].map(({ id }) => id).sort(),
    );
    assert.deepEqual(
      shown,
      Object.keys(properties)
        .map((name) => `option-${name}`)
        .sort(),
    );
    assert.equal(await page.getAttribute("#option-inflation", "min"), String(properties.inflation.minimum));
    const modes = await page.evaluate(() =>
      [...document.getElementById("option-mode").options].map(({ value }) => value),
    );
    assert.deepEqual(modes, properties.mode.enum);
    await page.click("#tab-plan");
    await page.click("#tab-options");
    assert.equal(asked(), 2, "one by the form, one by this test");
  });
});

test("options that cannot be loaded are reported, and loaded when the tab is opened again", async () => {
  await onPage(
    async (page) => {
      const document = (address) => address.pathname.endsWith("/v1/openapi.json");
      await page.route(document, (route) => route.abort());
      await page.click("#tab-options");
      await page.getByText("The options could not be loaded").waitFor();
      await page.unroute(document);
      await page.click("#tab-plan");
      await page.click("#tab-options");
      await page.waitForSelector("#option-inflation");
    },
    { allowed: /ERR_FAILED/ },
  );
});

test("typing a value is one undo step", async () => {
  await onPage(async (page) => {
    await paste(page, REQUEST);
    await page.click("#tab-options");
    await page.getByText("Expert", { exact: true }).click();
    await page.locator("#option-seed").pressSequentially("345");
    await page.keyboard.press("Tab");
    await requestIs(page, { ...REQUEST, options: { seed: 345 } });
    await page.locator("#tab-options").focus();
    await page.keyboard.press("Control+z");
    await requestIs(page, REQUEST);
    await page.keyboard.press("Control+Shift+z");
    await requestIs(page, { ...REQUEST, options: { seed: 345 } });
  });
});

test("the form shows what a request sets", async () => {
  await onPage(async (page) => {
    const request = await choose(page, "warehouse");
    await page.click("#tab-options");
    assert.ok(request.options.time_budget_ms > 0);
    assert.equal(await page.inputValue("#option-time_budget_ms"), String(request.options.time_budget_ms));
  });
});

test("a fault of an edit is shown at its field until it is repaired", async () => {
  await onPage(
    async (page) => {
      await paste(page, REQUEST);
      await page.click("#tab-options");
      await page.fill("#option-inflation", "-1");
      await page.waitForSelector("#option-inflation[aria-invalid=true]");
      const message = await page.getAttribute("#option-inflation", "aria-describedby");
      assert.match(await page.innerText(`#${message}`), /inflation|0|negative/i);
      assert.equal(await page.isVisible("#problem"), false, "it is shown once");
      await page.click("#tab-plan");
      assert.match(await page.textContent("#problem"), /\/options\/inflation/);
      await page.click("#tab-options");
      await page.fill("#option-inflation", "0.1");
      await page.waitForSelector("#option-inflation:not([aria-invalid])");
      assert.equal(await page.isVisible("#problem"), false);
    },
    { allowed: REFUSED },
  );
});

test("a listed error leads to its field", async () => {
  await onPage(
    async (page) => {
      await paste(page, { ...REQUEST, options: { seed: -4 } });
      await page.click("#plan");
      await page.click('[data-error="/options/seed"]');
      await page.waitForFunction(() => document.activeElement.id === "option-seed"); // the form is loaded first
      assert.equal(await page.isVisible("#panel-options"), true);
    },
    { allowed: REFUSED },
  );
});

test("an error of a robot is marked where the robot is, and one of a row at the row", async () => {
  await onPage(
    async (page) => {
      const danger = async (request, point) => {
        await paste(page, request);
        await page.click("#plan");
        await page.waitForSelector("#problem:not([hidden])");
        const place = await page.evaluate((world) => window.fleetplan.pointOf(world), point);
        return countColour(page, await themeColour(page, "--scene-danger"), place, 220);
      };
      const near = { x: 1.5, y: 0.5 };
      assert.ok((await danger({ ...REQUEST, robots: [{ ...ROBOT, start: near, radius: 0.9 }] }, near)) > 20);
      assert.ok((await danger({ ...REQUEST, map: { rows: [".....", "..x.."] } }, { x: 0, y: 1 })) > 20);
    },
    { allowed: REFUSED },
  );
});

test("arrow keys move between tabs", async () => {
  await onPage(async (page) => {
    await page.focus("#tab-plan");
    await page.keyboard.press("ArrowLeft");
    assert.equal(await page.evaluate(() => document.activeElement.id), "tab-analyse");
    assert.equal(await page.isVisible("#panel-analyse"), true);
    assert.equal(await page.isVisible("#panel-plan"), false);
    await page.keyboard.press("Home");
    assert.equal(await page.isVisible("#panel-plan"), true);
  });
});
