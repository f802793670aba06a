// Two plans of one request, compared robot by robot and played in lockstep.

import assert from "node:assert/strict";
import { test } from "node:test";

import { choose, planAndPause, pressPlan, seek } from "../support/browser.js";
import { drop } from "../support/map_files.js";
import { coloursAt, countColour, hasTime, hook, pagesFor, themeColour } from "../support/on_page.js";

const onPage = pagesFor();

const compareWith = (page) => page.getByLabel("Compare the plan with");

async function openCompare(page) {
  await page.focus("#tab-plan");
  await page.keyboard.press("End");
  await page.getByText("Compare plans", { exact: true }).click();
}

/** An answer in which a robot waits at its start, and so is later. */
function delayed(answer, at, by) {
  const plans = structuredClone(answer.plans);
  const [first] = plans[at].actions;
  const later = plans[at].actions.map((action) => ({
    ...action,
    t_start: action.t_start + by,
    t_end: action.t_end + by,
  }));
  const wait = { type: "wait", t_start: 0, t_end: by, from: first.from, to: first.from };
  plans[at] = { ...plans[at], cost: plans[at].cost + by, actions: [wait, ...later] };
  return { ...answer, plans, verified: undefined };
}

const PHONE = { viewport: { width: 390, height: 844 }, isMobile: true, hasTouch: true };

/** Plans an example and drops the same plan, in which the first robot is 30 s late: {answer, second}. */
async function dropSecond(page) {
  await choose(page, "crossing");
  const answer = await planAndPause(page);
  await page.evaluate(() => document.activeElement.blur());
  const second = delayed(answer, 0, 30);
  await drop(page, { "second.json": JSON.stringify(second) });
  await page.waitForSelector(".differences");
  assert.equal((await hook(page, "answer")).plans[0].cost, second.plans[0].cost);
  return { answer, second };
}

/** Waits until there is one scene, which is painted over the whole frame. */
const fillsFrame = (page) =>
  page.waitForFunction(() => {
    const [scene, frame] = ["scene", "scene-frame"].map((id) => document.getElementById(id));
    const { width, height } = /** @type {HTMLCanvasElement} */ (scene);
    const [across, down] = [frame.clientWidth, frame.clientHeight].map((size) => size * devicePixelRatio);
    const isAlone = document.getElementById("other-scene") === null;
    return isAlone && Math.abs(width - across) <= 1 && Math.abs(height - down) <= 1;
  });

/** Shows the end of a plan, and the colours of both scenes at its last pose. */
async function coloursAtEnd(page, { cost, actions }) {
  await seek(page, cost);
  await hasTime(page, cost);
  const place = await page.evaluate((point) => window.fleetplan.pointOf(point), actions.at(-1).to);
  const beside = { x: place.x + 8, y: place.y + 8 }; // of the arrow, within the disk
  const [first] = await coloursAt(page, [beside]);
  const [other] = await coloursAt(page, [beside], "other-scene");
  return { first, other };
}

for (const [size, options] of [
  ["desktop", {}],
  ["phone", PHONE],
]) {
  test(`a plan dropped onto the first is played beside it, and the two are swapped, ${size}`, async () => {
    await onPage(
      async (page) => {
        const { answer, second } = await dropSecond(page);
        const { length } = answer.plans;
        assert.match(
          await page.innerText(".differences"),
          new RegExp(`^1 of ${length} robots changed; flowtime \\+30`),
        );
        const changed = page.locator('#panel-analyse tbody tr[data-change="times"]');
        assert.ok((await changed.innerText()).includes(answer.plans[0].robot));
        assert.equal(await page.locator('#panel-analyse tbody tr[data-change="same"]').count(), length - 1);
        await page.getByRole("button", { name: "Select the changed robots" }).click();
        assert.deepEqual(await hook(page, "chosen"), [answer.plans[0].robot]);
        await page.evaluate(() => scrollTo(0, 0));
        await page.keyboard.press("Escape");

        const boxes = await Promise.all(
          ["#scene", "#other-scene"].map((id) => page.locator(id).boundingBox()),
        );
        const [one, two] = boxes;
        assert.deepEqual([one.width, one.height], [two.width, two.height]);
        const place = size === "phone" ? [one.x, one.y + one.height] : [one.x + one.width, one.y];
        assert.deepEqual([two.x, two.y], place);

        const before = await coloursAtEnd(page, answer.plans[0]);
        assert.notEqual(before.first, before.other, "only in the other plan it is at its goal");
        await page.getByRole("button", { name: "Swap" }).click();
        assert.deepEqual((await hook(page, "answer")).plans, answer.plans);
        assert.match(await page.innerText(".differences"), /flowtime −30/);
        assert.equal(await hook(page, "duration"), second.plans[0].cost, "both end");
        const swapped = await coloursAtEnd(page, answer.plans[0]);
        assert.deepEqual(swapped, { first: before.other, other: before.first });
        await compareWith(page).selectOption("");
        await fillsFrame(page);
      },
      { options },
    );
  });
}

test("two plans side by side share the view, and robots are selected in either", async () => {
  await onPage(async (page) => {
    const { answer } = await dropSecond(page);
    const { robot } = answer.plans[1];
    const two = await page.locator("#other-scene").boundingBox();
    const placeOf = () => page.evaluate((id) => window.fleetplan.screenOf(id), robot);
    const before = await placeOf();
    await page.mouse.move(two.x + before.x, two.y + before.y);
    await page.mouse.wheel(0, -300);
    await page.waitForFunction(({ id, radius }) => window.fleetplan.screenOf(id).radius > radius, {
      id: robot,
      radius: before.radius,
    });
    const { x, y, radius } = await placeOf();
    const around = [0, 90, 180, 270].map((angle) => ({
      x: x + radius * 0.7 * Math.cos((angle + 45) * (Math.PI / 180)),
      y: y + radius * 0.7 * Math.sin((angle + 45) * (Math.PI / 180)),
    }));
    assert.deepEqual(
      await coloursAt(page, around, "other-scene"),
      await coloursAt(page, around),
      "both show it in the same place",
    );
    await page.mouse.click(two.x + x, two.y + y);
    assert.equal(await hook(page, "selected"), robot);
  });
});

test("the closest pair is marked in both scenes", async () => {
  await onPage(async (page) => {
    await dropSecond(page);
    await seek(page, 0);
    await hasTime(page, 0);
    const { ids } = await hook(page, "closest");
    const { x, y, radius } = await page.evaluate((id) => window.fleetplan.screenOf(id), ids[0]);
    const rim = [{ x, y: y + radius + 1.5 }];
    const coloursOfBoth = async () => [
      ...(await coloursAt(page, rim)),
      ...(await coloursAt(page, rim, "other-scene")),
    ];
    const [first, other] = await coloursOfBoth();
    await page.keyboard.press("c");
    const [marked, otherMarked] = await coloursOfBoth();
    assert.deepEqual([other, otherMarked], [first, marked]);
    assert.notEqual(marked, first);
  });
});

test("the other plan is drawn as rings over the first instead", async () => {
  await onPage(async (page) => {
    const { answer } = await dropSecond(page);
    await page.getByLabel("Show the other plan").selectOption("over");
    await fillsFrame(page);
    const { cost, actions } = answer.plans[0];
    await seek(page, cost);
    await hasTime(page, cost);
    const ink = await themeColour(page, "--scene-ink");
    const place = () => page.evaluate((point) => window.fleetplan.pointOf(point), actions.at(-1).to);
    const ghost = await countColour(page, ink, await place(), 60);
    await compareWith(page).selectOption("");
    assert.ok(ghost > (await countColour(page, ink, await place(), 60)), "the ghost was at its goal");
  });
});

test("a plan that is dropped and not valid says so where it is compared", async () => {
  await onPage(async (page) => {
    await choose(page, "crossing");
    const answer = await pressPlan(page);
    const long = answer.plans.find(({ actions }) => actions.length > 1);
    const short = { ...long, actions: long.actions.slice(0, 1) };
    const plans = answer.plans.map((plan) => (plan === long ? short : plan));
    await drop(page, { "short.json": JSON.stringify({ ...answer, plans }) });
    await page.getByText(/^This plan is not valid: \d+ violations?, listed under Plan\.$/).waitFor();
    await compareWith(page).selectOption("before 0");
    await page.getByRole("button", { name: "Swap" }).click();
    await page.getByText("This plan is not valid").waitFor({ state: "hidden" });
  });
});

test("a plan of other robots that is dropped is opened, not compared", async () => {
  await onPage(async (page) => {
    const request = await choose(page, "corridor-swap");
    const answer = await pressPlan(page);
    await choose(page, "crossing");
    await pressPlan(page);
    await drop(page, { "other.plan.json": JSON.stringify({ ...request, ...answer }) });
    await page.waitForFunction((id) => window.fleetplan.request.robots[0].id === id, request.robots[0].id);
    await page.waitForSelector("#check:not([hidden])");
    assert.equal(await page.getAttribute("#tab-plan", "aria-selected"), "true");
  });
});

test("after a replan with other options, the preceding plan is compared by keys alone", async () => {
  await onPage(async (page) => {
    await choose(page, "crossing");
    const first = await pressPlan(page);
    await page.click("#tab-options");
    await page.waitForSelector('#options [data-pointer="/options/inflation"]');
    await page.fill('#options [data-pointer="/options/inflation"]', "0.05");
    await page.keyboard.press("Tab");
    await page.evaluate(() => document.activeElement.blur());
    await page.keyboard.press("p");
    await page.waitForFunction(
      (flowtime) =>
        document.getElementById("cancel").hidden &&
        (window.fleetplan.answer?.flowtime ?? flowtime) !== flowtime,
      first.flowtime,
    );
    await openCompare(page);
    await compareWith(page).focus();
    await page.keyboard.press("ArrowDown");
    await page.waitForSelector(".differences");
    assert.match(await page.innerText(".differences"), /of 8 robots changed; flowtime [+−]/);
  });
});

test("the previous plans of a request are compared with the new one", async () => {
  await onPage(async (page) => {
    const request = await choose(page, "late-pallet");
    const previous = request.robots.filter((robot) => robot.previous).length;
    assert.ok(previous > 0);
    await pressPlan(page);
    await openCompare(page);
    await compareWith(page).selectOption("previous");
    assert.match(await page.innerText(".differences"), /robots changed/);
  });
});

test("a file that is no plan of these robots is told", async () => {
  await onPage(async (page) => {
    await choose(page, "crossing");
    await pressPlan(page);
    await openCompare(page);
    const buffer = Buffer.from(JSON.stringify({ plans: [{ robot: "nobody", actions: [] }] }));
    await page.setInputFiles("#panel-analyse input[type=file]", {
      name: "x.json",
      mimeType: "application/json",
      buffer,
    });
    await page.waitForSelector("#problem:not([hidden])");
    assert.match(await page.innerText("#problem"), /x\.json: It is not a plan of these robots/);
  });
});
