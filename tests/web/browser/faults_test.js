// Faults of a request, in headless Chromium: told at once, once, and each leads to its place.

import assert from "node:assert/strict";
import { test } from "node:test";

import { hook, pagesFor, paste, REFUSED } from "../support/on_page.js";

const onPage = pagesFor();
const ALLOWED = { allowed: REFUSED };

const robot = (id, y, more = {}) => ({ id, start: { x: 0.5, y }, goal: { x: 90.5, y }, ...more });
const FAULTY = {
  map: { rows: [".".repeat(100), `x${".".repeat(99)}`, ...Array(38).fill(".".repeat(100))] },
  robot_defaults: { radius: -1 },
  robots: [robot("a", 20.5), robot("b", 22.5), robot("c", 24.5, { goal: { x: 99, y: 20, theta: "north" } })],
  obstacles: [{ id: "cart", radius: -1, motion: [{ t: 0, x: 80.5, y: 2.5 }] }],
  zones: [{ id: "lab", type: "blocked", polygon: [{ x: 70, y: 3 }] }],
  options: { seed: -1 },
  colour: "red",
};

/** Zooms in at the left upper corner, so that little of the map is in sight. */
async function zoomIn(page) {
  await page.keyboard.press("f");
  const box = await page.locator("#scene").boundingBox();
  await page.mouse.move(box.x + 60, box.y + 80);
  for (let turn = 0; turn < 12; turn += 1) await page.mouse.wheel(0, -240);
}

/** Whether a world point is within the scene. */
const isInSight = (page, point) =>
  page.evaluate((world) => {
    const { x, y } = window.fleetplan.pointOf(world);
    const { clientWidth, clientHeight } = document.getElementById("scene");
    return x > 0 && x < clientWidth && y > 0 && y < clientHeight;
  }, point);

test("an opened request with faults says so at once, each fault once, and each leads to its place", async () => {
  await onPage(async (page) => {
    await paste(page, FAULTY);
    await page.waitForSelector("#problem .errors");
    assert.equal((await hook(page, "request")).colour, "red");
    const text = await page.innerText("#problem");
    assert.equal(text.match(/linear_speed is missing/g).length, 1);
    for (const id of ["a", "b", "c"]) assert.ok(text.includes(id), id);
    const places = {
      "/map/rows/1": { x: 50, y: 38.5 },
      "/robots/2/goal/theta": FAULTY.robots[2].goal,
      "/obstacles/0/radius": FAULTY.obstacles[0].motion[0],
      "/zones/0/polygon": FAULTY.zones[0].polygon[0],
    };
    for (const [pointer, point] of Object.entries(places)) {
      await zoomIn(page);
      assert.equal(await isInSight(page, point), false, pointer);
      await page.click(`[data-error="${pointer}"]`);
      assert.equal(await isInSight(page, point), true, pointer);
    }
    await page.click('[data-error="/robots/1/linear_speed"]');
    assert.equal(await hook(page, "selected"), null, "it is too faulty to be drawn");
    assert.equal(await page.inputValue("#robot-id"), "b");
    await page.click('[data-error="/robot_defaults/radius"]');
    assert.equal(await page.evaluate(() => document.activeElement.dataset.pointer), "/robot_defaults/radius");
    await page.click('[data-error="/options/seed"]');
    await page.waitForFunction(() => document.activeElement.id === "option-seed");
  }, ALLOWED);
});

test("what has no place is plain text", async () => {
  await onPage(async (page) => {
    await paste(page, FAULTY);
    await page.waitForSelector('[data-error="/colour"]');
    assert.equal(await page.evaluate(() => document.querySelector('[data-error="/colour"]').tagName), "DIV");
  }, ALLOWED);
});

test("a plan that is not valid is not called solved in green", async () => {
  const actions = [0.5, 4.5].map((x) => ({ x, y: 0.5, theta: 0 }));
  const [from, to] = actions;
  const request = {
    map: { rows: ["..#.."] },
    robots: [{ id: "a", radius: 0.3, linear_speed: 1, angular_speed: 1, start: from, goal: to }],
  };
  const plan = { robot: "a", actions: [{ type: "translate", t_start: 0, t_end: 4, from, to }] };
  await onPage(async (page) => {
    await paste(page, { ...request, plans: [plan] });
    await page.waitForSelector("#summary .badge.bad");
    assert.match(await page.innerText("#summary .badges"), /Solved\s+Not verified/);
    assert.equal(await page.locator("#summary .badge.good").count(), 0);
  });
});
