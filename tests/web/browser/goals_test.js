// Goals of a robot in order, edited by keys and planned.

import assert from "node:assert/strict";
import { test } from "node:test";

import { pressPlan } from "../support/browser.js";
import { hook, pagesFor, paste } from "../support/on_page.js";

const onPage = pagesFor();

const HALL = {
  map: { rows: Array(5).fill("..........") },
  robot_defaults: { radius: 0.3, linear_speed: 1, angular_speed: 3 },
  robots: [{ id: "cart", start: { x: 0.5, y: 2.5 }, goal: { x: 5.5, y: 2.5 } }],
};

/** Opens the hall and the form of the goals of its robot. */
async function openGoals(page) {
  await paste(page, HALL);
  await page.click("#tab-edit");
  await page.selectOption("#edited-robot", "0");
  await page.click("#goals summary");
}

test("a goal is added, placed, served and moved earlier by keys alone, and the plan visits it", async () => {
  await onPage(async (page) => {
    await paste(page, HALL);
    await page.click("#tab-edit");
    await page.selectOption("#edited-robot", "0");
    await page.focus("#goals summary");
    await page.keyboard.press("Enter");
    await page.focus("#append-goal");
    await page.keyboard.press("Enter");
    const type = async (label, text) => {
      await page.locator("#goals-list li").nth(1).getByLabel(label).focus();
      await page.keyboard.press("Control+a");
      await page.keyboard.type(text);
      await page.keyboard.press("Tab");
    };
    await type("x", "2.5");
    await type("y", "4.5");
    await type("Service", "4");
    await page.getByRole("button", { name: "Move up: goal 2" }).focus();
    await page.keyboard.press("Enter");
    const [{ goals, goal }] = (await hook(page, "request")).robots;
    assert.equal(goal, undefined);
    assert.deepEqual(goals, [{ x: 2.5, y: 4.5, service: 4 }, HALL.robots[0].goal]);
    const { plans } = await pressPlan(page);
    const [first, last] = plans[0].visits;
    assert.ok(first.t_leave - first.t_arrive >= 4 - 1e-6 && last.t_leave === null);
    await page.getByRole("button", { name: "Remove: goal 1" }).focus();
    await page.keyboard.press("Enter");
    assert.deepEqual((await hook(page, "request")).robots, HALL.robots);
  });
});

test("a goal gets another pose by keys alone, one of both is planned, and a fault is shown at its field", async () => {
  await onPage(
    async (page) => {
      await openGoals(page);
      await page.getByRole("button", { name: "Or another pose: goal 1" }).focus();
      await page.keyboard.press("Enter");
      assert.equal(await page.isVisible("#robot-goal-numbers"), false);
      const pose = page.locator("#goals-list .poses-list li").nth(1);
      for (const [label, text] of [
        ["x", "1.5"],
        ["y", "0.5"],
        ["Heading", "90"],
        ["Bias", "0.25"],
      ]) {
        await pose.getByLabel(label).focus();
        await page.keyboard.press("Control+a");
        await page.keyboard.type(text);
      }
      const [{ goal }] = (await hook(page, "request")).robots;
      assert.deepEqual(
        goal.any_of.map(({ x, y, bias }) => [x, y, bias]),
        [
          [5.5, 2.5, undefined],
          [1.5, 0.5, 0.25],
        ],
      );
      assert.ok(Math.abs(goal.any_of[1].theta - Math.PI / 2) < 1e-5);
      const { plans } = await pressPlan(page);
      assert.equal(plans[0].visits[0].choice, 1); // the nearer one
      await pose.getByLabel("Bias").fill("-1");
      await page.waitForSelector("#goals-list .poses-list li .field-error");
      await page.getByRole("button", { name: "Remove: pose 2 of goal 1" }).click();
      assert.deepEqual((await hook(page, "request")).robots, HALL.robots);
    },
    { allowed: /status of 422/ },
  );
});

test("a robot in the way is told to make way, and one that is urgent when it is due", async () => {
  const waiter = { id: "waiter", start: { x: 3.5, y: 2.5 } };
  const lane = { ...HALL, map: { rows: ["##########", "####.#####", "..........", "##########"] } };
  const [cart] = HALL.robots;
  const moved = { ...cart, start: { x: 0.5, y: 1.5 }, goal: { x: 8.5, y: 1.5 } };
  await onPage(async (page) => {
    await paste(page, { ...lane, robots: [moved, { ...waiter, start: { x: 3.5, y: 1.5 } }] });
    await page.click("#tab-edit");
    await page.selectOption("#edited-robot", "1");
    await page.selectOption("#robot-idle", "yield");
    await page.selectOption("#edited-robot", "0");
    await page.getByLabel("Weight").fill("3");
    await page.click("#goals summary");
    const atGoals = page.waitForResponse(
      (response) =>
        response.url().endsWith("/v1/validate") &&
        response.request().postData()?.includes('"start":{"x":8.5'),
    );
    await page.locator("#goals-list").getByLabel("Due").fill("2");
    assert.equal((await atGoals).status(), 200, "the goals are checked");
    const { robots } = await hook(page, "request");
    assert.deepEqual([robots[0].weight, robots[0].goal.due, robots[1].idle], [3, 2, "yield"]);
    const { status, plans } = await pressPlan(page);
    assert.equal(status, "solved");
    assert.ok(plans[1].actions.length > 0, "it makes way");
    await page.click("#tab-plan");
    const seconds = plans[0].visits[0].late_by.toFixed(2);
    await page.waitForFunction(
      (text) => document.getElementById("inspector").innerText.includes(text),
      `Late at goal 1 by ${seconds} s`,
    );
    await page.click("#tab-edit");
    await page.selectOption("#edited-robot", "1");
    await page.selectOption("#robot-idle", "");
    assert.equal("idle" in (await hook(page, "request")).robots[1], false);
  });
});

test("a fault of a goal is shown at its field", async () => {
  await onPage(
    async (page) => {
      await openGoals(page);
      await page.locator("#goals-list").getByLabel("Service").fill("-1");
      await page.waitForSelector("#goals-list .field-error");
    },
    { allowed: /status of 422/ },
  );
});

test("a moving obstacle is added and led across by keys alone, and the plan keeps clear of it", async () => {
  await onPage(async (page) => {
    await paste(page, HALL);
    const direct = (await pressPlan(page)).makespan;
    await page.click("#tab-edit");
    await page.focus("#obstacles summary");
    await page.keyboard.press("Enter");
    await page.focus("#add-obstacle");
    await page.keyboard.press("Enter");
    const type = async (entry, label, text) => {
      await page
        .locator("#obstacle-motion li")
        .nth(entry)
        .getByLabel(label, { exact: false })
        .first()
        .focus();
      await page.keyboard.press("Control+a");
      await page.keyboard.type(text);
      await page.keyboard.press("Tab");
    };
    for (const [entry, x] of ["9.5", "0.5"].entries()) {
      await type(entry, "x m", x);
      await type(entry, "y m", "2.5");
    }
    const { obstacles } = await hook(page, "request");
    assert.deepEqual(obstacles, [
      {
        id: "obstacle-1",
        radius: 0.3,
        motion: [
          { t: 0, x: 9.5, y: 2.5 },
          { t: 10, x: 0.5, y: 2.5 },
        ],
      },
    ]);
    const answer = await pressPlan(page);
    assert.equal(answer.verified, true);
    assert.ok(answer.makespan > direct, "it has to make way");
    await page.focus("#delete-obstacle");
    await page.keyboard.press("Enter");
    assert.equal((await hook(page, "request")).obstacles, undefined);
  });
});
