// Questions to a plan: the timeline, a robot's card, how near robots come, what blocks one, what a check finds.
// In headless Chromium, against the real server.

import assert from "node:assert/strict";
import { test } from "node:test";

import { choose, planAndPause, pressPlan, seek } from "../support/browser.js";
import { expectedGap as gapAt } from "../support/expected_pose.js";
import { pagesFor, paste, twoFrames } from "../support/on_page.js";

const NEAR = 1e-9; // metres
const DANGER = "198,47,38,255"; // --scene-danger where it is light
const HEAD = 64; // pixels above the first row: the curve and the axis
const ROW = 20;
const LABELS = 132;
const RIGHT = 10;

const onFreshPage = pagesFor();
const onPage = (steps, options = { colorScheme: "light" }) => onFreshPage(steps, { options });

/** Plans an example and pauses: {request, answer}. */
async function planned(page, name) {
  const request = await choose(page, name);
  const answer = await planAndPause(page);
  return { request, answer };
}

const hook = (page, name) => page.evaluate((member) => window.fleetplan[member], name);
const isSelected = (page, id) => page.waitForFunction((robot) => window.fleetplan.selected === robot, id);
const hasTime = (page, time, slack = 1e-9) =>
  page.waitForFunction(([t, near]) => Math.abs(window.fleetplan.time - t) <= near, [time, slack]);

/** Where a moment of the whole plan is in a row of the timeline, pixels in its box. */
async function placeOf(page, row, share) {
  const width = await page.evaluate(() => document.getElementById("timeline-scroll").clientWidth);
  return { x: LABELS + (width - LABELS - RIGHT) * share, y: HEAD + (row + 0.5) * ROW };
}

/** Presses a row of the timeline at a share of the time shown. */
async function pressRow(page, row, share) {
  await page.locator("#timeline-scroll").click({ position: await placeOf(page, row, share) });
}

test("the closest robots are those found by comparing all pairs", async () => {
  await onPage(async (page) => {
    const { request, answer } = await planned(page, "crossing");
    const ids = request.robots.map(({ id }) => id);
    for (const share of [0, 0.21, 0.5, 0.77, 1]) {
      await seek(page, answer.makespan * share);
      const time = await hook(page, "time");
      const closest = await hook(page, "closest");
      const pairs = ids.flatMap((one, at) => ids.slice(at + 1).map((other) => [one, other]));
      const least = Math.min(...pairs.map((pair) => gapAt(request, answer, pair, time)));
      assert.ok(Math.abs(closest.gap - least) < NEAR);
      assert.ok(Math.abs(gapAt(request, answer, closest.ids, time) - closest.gap) < NEAR);
      const words = await page.innerText("#timeline-closest");
      for (const id of closest.ids) assert.ok(words.includes(id), words);
    }
  });
});

test("a press on the smallest gap goes to its moment", async () => {
  await onPage(async (page) => {
    await planned(page, "hospital-ward");
    await page.waitForFunction(() => window.fleetplan.least);
    const { t, ids } = await hook(page, "least");
    await page.click("#timeline-least");
    await hasTime(page, t);
    assert.equal(await hook(page, "selected"), ids[0]);
  });
});

test("pressing a row of the timeline selects its robot and seeks; dragging continues", async () => {
  await onPage(async (page) => {
    const { request, answer } = await planned(page, "crossing");
    await pressRow(page, 2, 0.5);
    await isSelected(page, request.robots[2].id);
    await hasTime(page, answer.makespan * 0.5, answer.makespan * 0.01);
    const box = await page.locator("#timeline-scroll").boundingBox();
    const [from, to] = [await placeOf(page, 1, 0.3), await placeOf(page, 1, 0.8)];
    await page.mouse.move(box.x + from.x, box.y + from.y);
    await page.mouse.down();
    await page.mouse.move(box.x + to.x, box.y + to.y, { steps: 4 });
    await hasTime(page, answer.makespan * 0.8, answer.makespan * 0.01);
    await page.mouse.up();
    assert.equal(await hook(page, "selected"), request.robots[1].id);
  });
});

test("the playhead is at the current time", async () => {
  await onPage(async (page) => {
    const { answer } = await planned(page, "crossing");
    for (const share of [0.25, 0.9]) {
      await seek(page, answer.makespan * share);
      await twoFrames(page);
      const head = await page.locator("#timeline-playhead").boundingBox();
      const box = await page.locator("#timeline-scroll").boundingBox();
      const { x } = await placeOf(page, 0, share);
      assert.ok(Math.abs(head.x + head.width / 2 - box.x - x) < 1);
    }
  });
});

/** The colours painted on a canvas in a square around a place, half of it `half` pixels wide. */
async function coloursAround(page, canvasId, { x, y }, half) {
  await twoFrames(page);
  return page.evaluate(
    ([id, left, top, reach]) => {
      const canvas = document.getElementById(id);
      const ratio = canvas.width / canvas.clientWidth;
      const copy = new OffscreenCanvas(2 * reach, 2 * reach).getContext("2d");
      copy.drawImage(canvas, Math.round(-(left - reach) * ratio), Math.round(-(top - reach) * ratio));
      const { data } = copy.getImageData(0, 0, 2 * reach, 2 * reach);
      return Array.from({ length: data.length / 4 }, (_, at) => data.slice(4 * at, 4 * at + 4).join());
    },
    [canvasId, x, y, Math.ceil(half)],
  );
}

test("hovering a row highlights its robot, hovering a robot its row", async () => {
  await onPage(async (page) => {
    const { request } = await planned(page, "crossing");
    const box = await page.locator("#timeline-scroll").boundingBox();
    await page.mouse.move(box.x + 40, box.y + HEAD + 3.5 * ROW);
    const fourth = request.robots[3].id;
    await page.waitForFunction(
      (id) => document.getElementById("readout").textContent.startsWith(`${id}:`),
      fourth,
    );
    await page.mouse.move(5, 5);
    const ground = { x: 2, y: HEAD + 5.5 * ROW };
    const before = await coloursAround(page, "timeline-canvas", ground, 1);
    const sixth = await page.evaluate((id) => window.fleetplan.screenOf(id), request.robots[5].id);
    const scene = await page.locator("#scene").boundingBox();
    await page.mouse.move(scene.x + sixth.x, scene.y + sixth.y);
    assert.notDeepEqual(await coloursAround(page, "timeline-canvas", ground, 1), before);
  });
});

test("arrow keys select robots and step through events, with announcements", async () => {
  await onPage(async (page) => {
    const { request, answer } = await planned(page, "crossing");
    await page.focus("#timeline-scroll");
    await page.keyboard.press("Home");
    await hasTime(page, 0);
    await page.keyboard.press("ArrowDown");
    await page.keyboard.press("ArrowDown");
    const { id } = request.robots[1];
    await isSelected(page, id);
    const { actions } = answer.plans.find(({ robot }) => robot === id);
    await page.keyboard.press("ArrowRight");
    await hasTime(page, actions[0].t_end, 1e-6);
    await page.keyboard.press("ArrowLeft");
    await hasTime(page, 0);
    await page.keyboard.press("End");
    await hasTime(page, answer.makespan);
    assert.match(await page.getAttribute("#timeline-scroll", "aria-label"), new RegExp(`${id} arrived at `));
    assert.ok((await page.innerText("#announcer")).startsWith(`${id} arrived`));
    await page.keyboard.press("ArrowUp");
    await isSelected(page, request.robots[0].id);
  });
});

test("rows are sorted by cost, departure, and delay if the bound is known", async () => {
  await onPage(async (page) => {
    const { answer } = await planned(page, "warehouse");
    const first = async (by) => {
      await page.keyboard.press("Escape");
      await page.selectOption("#timeline-sort", by);
      await page.focus("#timeline-scroll");
      await page.keyboard.press("ArrowDown");
      const id = await hook(page, "selected");
      return answer.plans.find(({ robot }) => robot === id);
    };
    const startOf = ({ actions }) => actions.find(({ type }) => type !== "wait").t_start;
    assert.equal((await first("cost")).cost, Math.max(...answer.plans.map(({ cost }) => cost)));
    assert.equal(startOf(await first("start")), Math.min(...answer.plans.map(startOf)));
    const bounded = answer.plans.some((plan) => "lower_bound" in plan);
    const offered = await page.evaluate(
      () => !document.querySelector("#timeline-sort [value=delay]").disabled,
    );
    assert.equal(offered, bounded);
    assert.equal(await page.locator("#legend-bound").isVisible(), bounded);
    if (!bounded) return;
    const delayOf = ({ cost, lower_bound }) => cost - lower_bound;
    assert.equal(delayOf(await first("delay")), Math.max(...answer.plans.map(delayOf)));
  });
});

test("Ctrl and the wheel zoom in time around the pointer, a double click shows all", async () => {
  await onPage(async (page) => {
    const { answer } = await planned(page, "crossing");
    const box = await page.locator("#timeline-scroll").boundingBox();
    const middle = await placeOf(page, 1, 0.5);
    await page.mouse.move(box.x + middle.x, box.y + middle.y);
    await page.keyboard.down("Control");
    for (let turn = 0; turn < 4; turn += 1) await page.mouse.wheel(0, -200);
    await page.keyboard.up("Control");
    await pressRow(page, 1, 0.5);
    await hasTime(page, answer.makespan / 2, answer.makespan * 0.01);
    await pressRow(page, 1, 0.02);
    await hasTime(page, answer.makespan / 2, answer.makespan / 16);
    await page.locator("#timeline-scroll").dblclick({ position: await placeOf(page, 1, 0.5) });
    await pressRow(page, 1, 0.1);
    await hasTime(page, answer.makespan * 0.1, answer.makespan * 0.01);
  });
});

test("two fingers zoom the timeline, keep their times, and do not seek", async () => {
  await onPage(
    async (page) => {
      const { answer } = await planned(page, "crossing");
      await seek(page, 0);
      const box = await page.locator("#timeline-scroll").boundingBox();
      const session = await page.context().newCDPSession(page);
      const touch = async (type, ...shares) => {
        const places = await Promise.all(shares.map((share) => placeOf(page, 1, share)));
        const touchPoints = places.map(({ x, y }, id) => ({ x: box.x + x, y: box.y + y, id }));
        await session.send("Input.dispatchTouchEvent", { type, touchPoints });
      };
      await touch("touchStart", 0.4);
      await touch("touchStart", 0.4, 0.6);
      for (const half of [0.15, 0.2, 0.25, 0.3]) await touch("touchMove", 0.5 - half, 0.5 + half);
      await touch("touchEnd");
      assert.equal(await hook(page, "time"), 0);
      for (const [share, moment] of [
        [0.2, 0.4],
        [0.8, 0.6],
      ]) {
        await pressRow(page, 1, share);
        await hasTime(page, answer.makespan * moment, answer.makespan * 0.01);
      }
    },
    { hasTouch: true },
  );
});

test("rows scroll, and the selected one is scrolled into view", async () => {
  await onPage(async (page) => {
    const { request } = await planned(page, "hall-100");
    const last = request.robots.at(-1).id;
    const scrolled = () => page.evaluate(() => document.getElementById("timeline-scroll").scrollTop);
    assert.equal(await scrolled(), 0);
    await page.locator(`.robot[data-robot="${last}"]`).click();
    await page.waitForFunction(() => document.getElementById("timeline-scroll").scrollTop > 1000);
    const box = await page.locator("#timeline-scroll").boundingBox();
    const low = await scrolled();
    await page.mouse.move(box.x + 300, box.y + HEAD + 20);
    await page.mouse.wheel(0, -600);
    await page.waitForFunction((top) => document.getElementById("timeline-scroll").scrollTop < top, low);
  });
});

test("the dock folds, and its divider is moved by keyboard and by dragging", async () => {
  await onPage(async (page) => {
    await planned(page, "warehouse");
    const height = async () => (await page.locator("#timeline-body").boundingBox()).height;
    const first = await height();
    await page.focus("#timeline-divider");
    await page.keyboard.press("ArrowUp");
    const taller = await height();
    assert.ok(taller > first);
    assert.equal(Number(await page.getAttribute("#timeline-divider", "aria-valuenow")), taller);
    const divider = await page.locator("#timeline-divider").boundingBox();
    await page.mouse.move(divider.x + 50, divider.y + 4);
    await page.mouse.down();
    await page.mouse.move(divider.x + 50, divider.y - 56, { steps: 3 });
    await page.mouse.up();
    assert.ok(Math.abs((await height()) - taller - 60) < 2);
    await page.click("#timeline-toggle");
    assert.equal(await page.locator("#timeline-body").isVisible(), false);
    assert.equal(await page.getAttribute("#timeline-toggle", "aria-expanded"), "false");
  });
});

test("the card of a robot lists its actions, marks the current one and seeks to each", async () => {
  await onPage(async (page) => {
    const { answer } = await planned(page, "hospital-ward");
    const plan = answer.plans.reduce((most, each) =>
      each.actions.length > most.actions.length ? each : most,
    );
    await page.locator(`.robot[data-robot="${plan.robot}"]`).click();
    const card = page.locator("#inspector");
    await card.waitFor();
    assert.equal(await card.getAttribute("aria-label"), `Robot ${plan.robot}`);
    assert.equal(await card.locator("tbody tr").count(), plan.actions.length);
    const at = Math.floor(plan.actions.length / 2);
    await card.locator(".action").nth(at).click();
    await hasTime(page, plan.actions[at].t_start);
    const current = await card
      .locator("tbody tr")
      .evaluateAll((rows) =>
        rows.flatMap((row, index) => (row.getAttribute("aria-current") === "step" ? [index] : [])),
      );
    assert.deepEqual(current, [at]);
    await page.keyboard.press("Escape");
    await card.waitFor({ state: "hidden" });
    assert.equal(await hook(page, "selected"), null);
  });
});

test("the card of a robot shows how its time is spent, and its delay if the bound is known", async () => {
  await onPage(async (page) => {
    const { answer } = await planned(page, "hospital-ward");
    const moving = answer.plans.filter((plan) => plan.actions.length > 0);
    for (const { robot, cost, lower_bound, actions } of moving) {
      await page.locator(`.robot[data-robot="${robot}"]`).click();
      await isSelected(page, robot);
      const words = await page.innerText("#inspector");
      assert.ok(words.includes(`${cost.toFixed(2)} s`), words);
      const sum = (kind) =>
        actions
          .filter(({ type }) => type === kind)
          .reduce((total, { t_start, t_end }) => total + t_end - t_start, 0);
      for (const [word, type] of [
        ["moving", "translate"],
        ["turning", "rotate"],
        ["waiting", "wait"],
      ]) {
        assert.equal(words.includes(`${word} ${sum(type).toFixed(1)} s`), sum(type) > 0, words);
      }
      assert.equal(words.includes("its lower bound"), lower_bound !== undefined, words);
    }
  });
});

// One waits in a bay until the other has come through the corridor.
const BAY = {
  map: { rows: ["###.####", "........"] },
  robot_defaults: { radius: 0.45, linear_speed: 1, angular_speed: 3 },
  robots: [
    { id: "comer", start: { x: 7.5, y: 0.5, theta: Math.PI }, goal: { x: 0.5, y: 0.5 } },
    { id: "waiter", start: { x: 3.5, y: 1.5 }, goal: { x: 7.5, y: 0.5 } },
  ],
};

test("a wait names the robot that causes it, and pressing the name selects that robot", async () => {
  await onPage(async (page) => {
    await paste(page, BAY);
    const answer = await pressPlan(page);
    const waiting = answer.plans.find(({ actions }) => actions.some(({ type }) => type === "wait"));
    const other = BAY.robots.find(({ id }) => id !== waiting.robot).id;
    await page.locator(`.robot[data-robot="${waiting.robot}"]`).click();
    const wait = page.locator('#inspector tr[data-type="wait"]').first();
    assert.match(await wait.innerText(), /wait [\d.]+ s\s+for/);
    assert.equal(await wait.locator(".chip").innerText(), other);
    await wait.locator(".chip").click();
    await isSelected(page, other);
    assert.equal(await page.getAttribute("#inspector", "aria-label"), `Robot ${other}`);
  });
});

/** How many pixels of the scene around a robot are in the colour of danger. */
async function dangerAround(page, id) {
  const place = await page.evaluate((robot) => window.fleetplan.screenOf(robot), id);
  const colours = await coloursAround(page, "scene", place, place.radius + 12);
  return colours.filter((colour) => colour === DANGER).length;
}

test("a robot without a plan shows the reason, and its blockers are ringed in the scene", async () => {
  await onPage(async (page) => {
    const { answer } = await planned(page, "partly-solvable");
    const { robot, blocked_by } = answer.unplanned.find((entry) => entry.blocked_by.length > 0);
    const before = await dangerAround(page, blocked_by[0]);
    await page.locator(`.robot[data-robot="${robot}"]`).click();
    await page.locator("#inspector .reason").waitFor();
    assert.equal(await page.locator("#inspector .chip").first().innerText(), blocked_by[0]);
    assert.ok((await dangerAround(page, blocked_by[0])) > before + 20);
    const onTop = await page.evaluate((id) => {
      const { x, y } = window.fleetplan.screenOf(id);
      const { left, top } = document.getElementById("scene").getBoundingClientRect();
      return document.elementFromPoint(left + x, top + y).id;
    }, blocked_by[0]);
    assert.equal(onTop, "scene", "the card does not hide the blocking robot");
  });
});

test("the closest pair is joined in the scene when switched on or while hovering its curve", async () => {
  await onPage(async (page) => {
    const { answer } = await planned(page, "crossing");
    await seek(page, answer.makespan * 0.3);
    await page.mouse.move(5, 5);
    const picture = async () => {
      await twoFrames(page);
      return page.evaluate(() => document.getElementById("scene").toDataURL());
    };
    const plain = await picture();
    await page.click("#show-closest");
    await page.mouse.move(5, 5);
    const joined = await picture();
    assert.notEqual(joined, plain);
    assert.equal(await page.getAttribute("#show-closest", "aria-pressed"), "true");
    await page.evaluate(() => document.activeElement.blur());
    await page.keyboard.press("c");
    assert.equal(await picture(), plain);
    const box = await page.locator("#timeline-scroll").boundingBox();
    await page.mouse.move(box.x + 400, box.y + 20);
    assert.equal(await picture(), joined);
    await page.mouse.move(5, 5);
    assert.equal(await picture(), plain);
  });
});

test("a plan is checked on demand and valid", async () => {
  await onPage(async (page) => {
    await planned(page, "hospital-ward");
    await page.click("#check-plan");
    await page.locator("#check.good").waitFor();
    assert.match(await page.innerText("#check"), /^Valid\n.*smallest gap between two robots is 60 mm/s);
    assert.equal((await hook(page, "check")).valid, true);
  });
});

/** The answer with all waits of a robot left out, so that what follows comes too early. */
function withoutWaits(answer, id) {
  const plans = answer.plans.map((plan) => {
    if (plan.robot !== id) return plan;
    let earlier = 0;
    const actions = [];
    for (const action of plan.actions) {
      if (action.type === "wait") earlier += action.t_end - action.t_start;
      else actions.push({ ...action, t_start: action.t_start - earlier, t_end: action.t_end - earlier });
    }
    return { ...plan, actions, cost: plan.cost - earlier };
  });
  return { ...answer, plans };
}

test("violations are listed, and pressing one shows its moment and robots", async () => {
  await onPage(async (page, { url }) => {
    await page.route("**/v1/plan", async (route) => {
      const response = await fetch(new URL("v1/plan", url), {
        method: "POST",
        headers: { "Content-Type": "application/json" },
        body: route.request().postData(),
      });
      await route.fulfill({ json: withoutWaits(await response.json(), "waiter") });
    });
    await paste(page, BAY);
    await pressPlan(page);
    await page.click("#check-plan");
    await page.locator("#check.bad").waitFor();
    const { violations } = await hook(page, "check");
    const collision = violations.findIndex(({ kind }) => kind === "robot_collision");
    assert.ok(collision >= 0);
    const entry = page.locator("#check .violation").nth(collision);
    const words = await entry.innerText();
    for (const part of ["Robots collide", "comer", "waiter", "required"])
      assert.ok(words.includes(part), words);
    await entry.click();
    await hasTime(page, violations[collision].t);
    assert.equal(await hook(page, "selected"), violations[collision].robots[0]);
    assert.equal(await hook(page, "playing"), false);
    for (const id of violations[collision].robots) {
      assert.ok((await dangerAround(page, id)) > 60, `${id} is marked`);
    }
    await seek(page, 0);
    assert.equal(await dangerAround(page, "comer"), 0);
  });
});

test("the timeline folds when the window becomes narrow, and unfolds when it becomes wide", async () => {
  await onPage(async (page) => {
    const body = page.locator("#timeline-body");
    await planned(page, "crossing");
    assert.equal(await body.isVisible(), true);
    await page.setViewportSize({ width: 390, height: 844 });
    await body.waitFor({ state: "hidden" });
    await page.setViewportSize({ width: 1440, height: 900 });
    await body.waitFor({ state: "visible" });
  });
});

test("on a phone the timeline starts folded, a tap on a row selects, the card is below", async () => {
  const phone = {
    viewport: { width: 390, height: 844 },
    isMobile: true,
    hasTouch: true,
    colorScheme: "light",
  };
  await onPage(async (page) => {
    const request = await choose(page, "crossing");
    await pressPlan(page);
    assert.equal(await page.locator("#timeline-body").isVisible(), false);
    await page.tap("#timeline-toggle");
    await page.locator("#timeline-scroll").tap({ position: { x: 250, y: HEAD + 28 * 1.5 } });
    await isSelected(page, request.robots[1].id);
    const scene = await page.locator("#scene-frame").boundingBox();
    const card = await page.locator("#inspector").boundingBox();
    assert.ok(card.y >= scene.y + scene.height - 1);
    assert.ok(card.width > 380);
  }, phone);
});
