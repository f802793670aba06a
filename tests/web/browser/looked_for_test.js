// What visitors look for: links, examples, options in groups, moments of a plan, and the page in a frame of another one.

import assert from "node:assert/strict";
import { createServer } from "node:http";
import { once } from "node:events";
import { test } from "node:test";

import { openPage, planned } from "../support/browser.js";
import { hook, pagesFor, paste, twoFrames } from "../support/on_page.js";
import { drag, press } from "../support/scene_pointer.js";
import { startService } from "../support/service.js";
import { sharedBrowser } from "../support/shared.js";

const onPage = pagesFor();

const HALL = {
  map: { rows: Array(20).fill(".".repeat(30)) },
  robot_defaults: { radius: 0.3, linear_speed: 1, angular_speed: 1 },
  robots: [],
};

test("the page has its version, and links to the API that answer", async () => {
  await onPage(async (page) => {
    await page.waitForFunction(() =>
      /^Fleetplan \d+\.\d+\.\d+$/.test(document.getElementById("version").textContent),
    );
    const links = await page.$$eval(".about a", (found) => found.map(({ href }) => href));
    assert.ok(links.length >= 2);
    for (const link of links) assert.equal((await page.request.get(link)).status(), 200, link);
  });
});

test("options are grouped, each with what it costs", async () => {
  await onPage(async (page) => {
    await page.click("#tab-options");
    await page.waitForSelector("#option-inflation");
    const titles = await page.$$eval(".option-group h2", (found) =>
      found.map(({ textContent }) => textContent),
    );
    assert.deepEqual(titles, ["Safety", "Time", "Quality", "Expert"]);
    const costs = await page.$$eval(".option-group:not(:last-of-type) .option", (found) =>
      found
        .filter((each) => each.querySelector(".option-cost") === null)
        .map(({ textContent }) => textContent),
    );
    assert.deepEqual(costs, []);
  });
});

test("a start and its heading are one press and drag, a goal likewise, and Plan tells the result there", async () => {
  await onPage(async (page) => {
    await paste(page, HALL);
    await page.waitForSelector("#placing:not([hidden])");
    await drag(page, [
      { x: 5.5, y: 5.5 },
      { x: 5.5, y: 9.5 },
    ]);
    await drag(page, [
      { x: 15.5, y: 5.5 },
      { x: 11.5, y: 5.5 },
    ]);
    const [robot] = (await hook(page, "request")).robots;
    assert.deepEqual([robot.start.x, robot.start.y, robot.goal.x, robot.goal.y], [5.5, 5.5, 15.5, 5.5]);
    assert.ok(Math.abs(robot.start.theta - Math.PI / 2) < 1e-3, `${robot.start.theta}`);
    assert.ok(Math.abs(Math.abs(robot.goal.theta) - Math.PI) < 1e-3, `${robot.goal.theta}`);
    await press(page, { x: 5.5, y: 12.5 });
    await press(page, { x: 15.5, y: 12.5 });
    await page.click("#placing-plan");
    await page.waitForSelector("#placing-result:not([hidden])");
    const result = await page.innerText("#placing-result");
    assert.match(
      result,
      /^Solved, verified\. Smallest gap .+\. Margins: 0 mm around each robot, 0\.00 s early or late\.$/,
    );
  });
});

test("pairs lead to their moment and select both", async () => {
  await onPage(async (page) => {
    await planned(page, "crossing");
    await page.click(".least");
    const { t, ids } = await hook(page, "least");
    assert.ok(Math.abs((await hook(page, "time")) - t) < 1e-6);
    assert.deepEqual([...(await hook(page, "chosen"))].sort(), [...ids].sort());
    await page.keyboard.press("Escape");
    await page.click("#choose-listed");
    await page.getByRole("button", { name: /^Nearest: / }).click();
    assert.equal((await hook(page, "chosen")).length, 2);
  });
});

test("a link to a moment opens the request planned, at that moment", async () => {
  await onPage(async (page, { url }) => {
    await page.context().grantPermissions(["clipboard-read", "clipboard-write"]);
    await planned(page, "crossing");
    await page.evaluate(() => {
      const scrubber = /** @type {HTMLInputElement} */ (document.getElementById("scrubber"));
      scrubber.value = "7.25";
      scrubber.dispatchEvent(new Event("input", { bubbles: true }));
    });
    await page.click("#save-menu summary");
    await page.click("#copy-moment");
    await page.waitForFunction(() => document.getElementById("copy-moment").textContent === "Copied");
    const link = await page.evaluate(() => navigator.clipboard.readText());
    assert.equal(link, `${url}#crossing@7.25`);
    const other = await openPage(await sharedBrowser(), link);
    try {
      await other.page.waitForFunction(() => window.fleetplan.time === 7.25);
      assert.equal((await hook(other.page, "answer")).verified, true);
      assert.equal(await hook(other.page, "playing"), false);
      assert.equal(new URL(other.page.url()).hash, "#crossing");
    } finally {
      await other.close();
    }
  });
});

test("continuous operation has a clock of the whole time", async () => {
  await onPage(async (page) => {
    await planned(page, "crossing");
    await page.click("#tab-analyse");
    await page.getByText("Continuous operation", { exact: true }).click();
    await page.getByRole("button", { name: "Run", exact: true }).click();
    await page.waitForFunction(() =>
      /In operation for 0:0[3-9]/.test(document.querySelector(".fleet-clock").textContent),
    );
    await page.getByRole("button", { name: "Stop", exact: true }).click();
  });
});

/** Shows the page in a frame of a page of another origin; returns what that frame shows. */
async function inFrame(flags, steps) {
  const outer = createServer((_, response) => {
    response.setHeader("Content-Type", "text/html");
    response.end(`<iframe width="900" height="560" src="${inner}?embed#crossing@4"></iframe>`);
  });
  outer.listen(0, "127.0.0.1");
  await once(outer, "listening");
  const { port } = /** @type {import("node:net").AddressInfo} */ (outer.address());
  const origin = `http://127.0.0.1:${port}`;
  const service = await startService(flags(origin));
  const inner = service.url;
  const context = await (await sharedBrowser()).newContext();
  try {
    const page = await context.newPage();
    const complaints = [];
    page.on("console", (message) => message.type() === "error" && complaints.push(message.text()));
    await page.goto(origin);
    await steps(page.frames()[1], complaints, page);
  } finally {
    await context.close();
    await service.stop();
    outer.close();
  }
}

test("a listed page shows the scene and the player in a frame, at a moment of the plan", async () => {
  await inFrame(
    (origin) => ["--frame-ancestors", origin],
    async (frame, complaints, page) => {
      await frame.waitForFunction(() => window.fleetplan?.time === 4);
      assert.equal(await frame.isVisible(".setup"), false);
      assert.equal(await frame.isVisible(".side"), false);
      assert.equal(await frame.isVisible("#play"), true);
      await twoFrames(page);
      const { height } = await frame.locator("#scene").boundingBox();
      assert.ok(height > 0.45 * 560, `the scene has ${height} pixels`);
      assert.match(await frame.getAttribute("#open-whole", "href"), /^\/#crossing$/);
      assert.deepEqual(complaints, []);
    },
  );
});

test("no other page shows the page in a frame", async () => {
  await inFrame(
    () => [],
    async (frame, complaints, page) => {
      await page.waitForLoadState("load");
      assert.equal(await frame.locator("#scene").count(), 0);
      assert.match(complaints.join(), /frame-ancestors 'none'/);
    },
  );
});
