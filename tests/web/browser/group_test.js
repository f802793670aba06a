// Several robots together: chosen with Ctrl, Shift, a box or keys, compared and edited.

import assert from "node:assert/strict";
import { test } from "node:test";

import { choose, planned } from "../support/browser.js";
import { hook, pagesFor } from "../support/on_page.js";

const onPage = pagesFor();

const row = (id) => `.robot[data-robot="${id}"]`;

test("robots chosen with Ctrl and Shift are compared", async () => {
  await onPage(async (page) => {
    const answer = await planned(page, "crossing");
    const [a, b, c] = answer.plans.map(({ robot }) => robot);
    await page.click(row(a));
    await page.click(row(c), { modifiers: ["Control"] });
    assert.deepEqual(await hook(page, "chosen"), [a, c]);
    const cells = await page.locator("#chosen tbody tr").first().innerText();
    assert.ok(cells.includes(answer.plans[0].cost.toFixed(1)), cells);
    assert.match(await page.innerText("#chosen"), /Nearest: /);
    await page.click("#chosen .quiet");
    const { time, gap } = await page.evaluate(
      (ids) => {
        const [one, other] = ids.map((id) => window.fleetplan.poseOf(id));
        return { time: window.fleetplan.time, gap: Math.hypot(one.x - other.x, one.y - other.y) };
      },
      [a, c],
    );
    const away = await page.evaluate(
      (ids) => {
        const places = ids.map(
          (id) => window.fleetplan.request.robots.find((robot) => robot.id === id).start,
        );
        return Math.hypot(places[0].x - places[1].x, places[0].y - places[1].y);
      },
      [a, c],
    );
    assert.ok(time > 0 && gap < away, "the moment of their nearest approach is shown");
    await page.click(row(c), { modifiers: ["Control"] });
    assert.deepEqual(await hook(page, "chosen"), [a]);
    assert.equal(await page.isVisible("#chosen"), false);
    await page.click(row(c), { modifiers: ["Shift"] });
    assert.deepEqual(await hook(page, "chosen"), [a, b, c]);
  });
});

test("a box chooses the robots in it, and Ctrl adds a robot of the scene", async () => {
  await onPage(async (page) => {
    await choose(page, "crossing");
    const robots = await page.evaluate(() =>
      window.fleetplan.request.robots.map(({ id }) => ({ id, ...window.fleetplan.screenOf(id) })),
    );
    const canvas = await page.locator("#scene").boundingBox();
    const middle = canvas.width / 2;
    const left = robots.filter(({ x }) => x < middle).map(({ id }) => id);
    const other = robots.find(({ x }) => x > middle);
    assert.ok(left.length >= 2);
    await page.keyboard.down("Shift");
    await page.mouse.move(canvas.x + 4, canvas.y + 70);
    await page.mouse.down();
    await page.mouse.move(canvas.x + middle / 2, canvas.y + canvas.height / 2, { steps: 3 });
    await page.mouse.move(canvas.x + middle, canvas.y + canvas.height - 4, { steps: 3 });
    await page.mouse.up();
    await page.keyboard.up("Shift");
    assert.deepEqual(await hook(page, "chosen"), left);
    await page.keyboard.down("Control");
    await page.mouse.click(canvas.x + other.x, canvas.y + other.y);
    await page.keyboard.up("Control");
    assert.deepEqual(await hook(page, "chosen"), [...left, other.id]);
  });
});

test("keys alone choose all robots of the list and edit them together", async () => {
  await onPage(async (page) => {
    const before = await choose(page, "warehouse");
    await page.keyboard.press("/");
    await page.keyboard.type("pallet");
    await page.focus("#choose-listed");
    await page.keyboard.press("Enter");
    const pallets = before.robots.filter(({ id }) => id.startsWith("pallet"));
    assert.deepEqual(
      await hook(page, "chosen"),
      pallets.map(({ id }) => id),
    );
    await page.focus("#tab-plan");
    await page.keyboard.press("ArrowRight");
    assert.equal(await page.innerText("#group-title"), "10 robots selected");
    assert.equal(await page.isVisible("#robot-form"), false);
    await page.focus("#group-numbers input >> nth=1");
    await page.keyboard.press("Control+a");
    await page.keyboard.insertText("0.75"); // at once: a speed of 0 would be refused
    await page.keyboard.press("Tab");
    const { robots } = await hook(page, "request");
    for (const robot of robots) {
      const was = before.robots.find(({ id }) => id === robot.id);
      assert.equal(robot.linear_speed, robot.id.startsWith("pallet") ? 0.75 : was.linear_speed, robot.id);
    }
    await page.focus("#delete-group");
    await page.keyboard.press("Enter");
    assert.equal((await hook(page, "request")).robots.length, 30);
    await page.keyboard.press("Control+z");
    await page.keyboard.press("Control+z");
    assert.deepEqual(await hook(page, "request"), before);
  });
});

test("Ctrl and Enter add a robot of the list", async () => {
  await onPage(async (page) => {
    const { robots } = await choose(page, "crossing");
    await page.focus(row(robots[1].id));
    await page.keyboard.press("Enter");
    await page.focus(row(robots[0].id));
    await page.keyboard.press("Control+Enter");
    assert.deepEqual(await hook(page, "chosen"), [robots[1].id, robots[0].id]);
  });
});
