// Maps that are images and zones, drawn and edited, in headless Chromium.

import assert from "node:assert/strict";
import { test } from "node:test";

import { png } from "../support/map_files.js";
import { coloursAt, countColour, hook, pagesFor, paste, themeColour } from "../support/on_page.js";

const onPage = pagesFor();
const REFUSALS = /status of 422/; // of services that do not know these members

const IMAGE = {
  png: png(0, [
    [254, 254, 254, 0],
    [254, 254, 205, 254],
  ]).toString("base64"),
  resolution: 2,
  origin: [10, -4, 0],
  negate: 0,
  occupied_thresh: 0.65,
  free_thresh: 0.196,
  mode: "trinary",
};
const SITE = {
  map: { image: IMAGE },
  robots: [
    {
      id: "solo",
      radius: 0.3,
      linear_speed: 0.5,
      angular_speed: 1,
      start: { x: 11, y: -1 },
      goal: { x: 13, y: -1 },
      metadata: { owner: "lab" },
    },
  ],
  zones: [
    {
      id: "lab",
      type: "blocked",
      polygon: [
        { x: 10.2, y: -3.8 },
        { x: 13.8, y: -3.8 },
        { x: 13.8, y: -2.2 },
        { x: 10.2, y: -2.2 },
      ],
    },
  ],
  metadata: { site: 7 },
};

const openSite = async (page, request) => {
  await paste(page, request);
  await page.waitForFunction(() => window.fleetplan.request.robots[0].id === "solo");
};
const pointsOf = (page, points) =>
  page.evaluate((all) => all.map((point) => window.fleetplan.pointOf(point)), points);

test("a map that is an image is drawn, with unknown cells as walls", async () => {
  await onPage(
    async (page) => {
      await openSite(page, { ...SITE, zones: [] });
      assert.match(await page.innerText("#facts"), /4 × 2 cells/);
      const [wall, floor] = [
        await themeColour(page, "--scene-wall"),
        await themeColour(page, "--scene-floor"),
      ];
      const places = [17, 15, 17, 13].map((x, at) => ({ x, y: [-1, -3, -3, -3][at] }));
      assert.deepEqual(await coloursAt(page, await pointsOf(page, places)), [wall, wall, floor, floor]);
    },
    { allowed: REFUSALS },
  );
});

test("zones are drawn with their names", async () => {
  await onPage(
    async (page) => {
      await openSite(page, SITE);
      const floor = await themeColour(page, "--scene-floor");
      const [inside, outside] = await pointsOf(page, [
        { x: 10.6, y: -2.6 },
        { x: 17, y: -3 },
      ]);
      const colours = await coloursAt(page, [inside, outside]);
      assert.notEqual(colours[0], floor);
      assert.equal(colours[1], floor);
      const [middle] = await pointsOf(page, [{ x: 12, y: -3 }]);
      assert.ok(
        (await countColour(page, await themeColour(page, "--scene-ink"), middle, 60)) > 20,
        "the label",
      );
    },
    { allowed: REFUSALS },
  );
});

test("an edited image becomes rows, and members that the page does not know are kept", async () => {
  await onPage(
    async (page) => {
      await openSite(page, SITE);
      await page.click("#tab-edit");
      await page.click("label[for=tool-wall]");
      const [place] = await pointsOf(page, [{ x: 17, y: -3 }]);
      const box = await page.locator("#scene").boundingBox();
      await page.mouse.click(box.x + place.x, box.y + place.y);
      await page.waitForFunction(() => window.fleetplan.request.map.rows);
      const edited = await hook(page, "request");
      assert.deepEqual(edited, {
        ...SITE,
        map: { rows: ["...#", "..##"], resolution: 2, origin: { x: 10, y: -4 } },
      });
      await page.click("#undo");
      assert.deepEqual((await hook(page, "request")).map, SITE.map);
      assert.match(await page.innerText("#facts"), /4 × 2 cells/);
    },
    { allowed: REFUSALS },
  );
});

test("a robot that reverses keeps its heading", async () => {
  const [from, to] = [11, 13].map((x) => ({ x, y: -1, theta: Math.PI }));
  const actions = [{ type: "translate", t_start: 0, t_end: 4, from, to, reverse: true }];
  await onPage(
    async (page) => {
      const plans = [{ robot: "solo", cost: 4, actions }];
      await openSite(page, { ...SITE, plans, status: "solved", lattice_spacing: 0.4 });
      await page.evaluate(() => {
        const scrubber = document.getElementById("scrubber");
        scrubber.value = "1";
        scrubber.dispatchEvent(new Event("input", { bubbles: true }));
      });
      const pose = await page.evaluate(() => window.fleetplan.poseOf("solo"));
      assert.deepEqual(pose, { x: 11.5, y: -1, theta: Math.PI });
      assert.equal("lattice_spacing" in (await hook(page, "request")), false, "it is of the answer");
      assert.equal((await hook(page, "answer")).lattice_spacing, 0.4);
    },
    { allowed: REFUSALS },
  );
});
