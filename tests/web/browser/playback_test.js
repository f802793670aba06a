// Ways to look at a plan: steps from event to event, colours, paths.

import assert from "node:assert/strict";
import { test } from "node:test";

import { choose, planAndPause, seek } from "../support/browser.js";
import { coloursAt, hasTime, pagesFor, paste, themeColour } from "../support/on_page.js";

const onPage = pagesFor();

/** A robot that turns, goes right and turns back; another that stands. */
const TURNING = {
  map: { rows: [".....", "....."] },
  robot_defaults: { radius: 0.4, linear_speed: 1, angular_speed: 1 },
  robots: [
    { id: "turner", start: { x: 0.5, y: 0.5, theta: 1 }, goal: { x: 4.5, y: 0.5, theta: 1 } },
    { id: "post", start: { x: 2.5, y: 1.5 } },
  ],
};

async function planned(page, request) {
  await paste(page, request);
  const answer = await planAndPause(page);
  await page.keyboard.press("r");
  await hasTime(page, 0);
  return answer;
}

test("keys and buttons step from event to event", async () => {
  await onPage(async (page) => {
    const answer = await planned(page, TURNING);
    const ends = answer.plans[0].actions.map(({ t_end }) => t_end);
    assert.equal(ends.length, 3);
    for (const end of ends) {
      await page.keyboard.press(".");
      await hasTime(page, end);
    }
    await page.click("#previous-event");
    await hasTime(page, ends[1]);
    await page.keyboard.press(",");
    await hasTime(page, ends[0]);
    await page.click("#next-event");
    await hasTime(page, ends[1]);
  });
});

test("with a selected robot, steps go to its own events", async () => {
  await onPage(async (page) => {
    await choose(page, "crossing");
    const answer = await planAndPause(page);
    const [{ robot, actions }] = answer.plans.filter((plan) => plan.actions.length > 1);
    await page.click(`.robot[data-robot="${robot}"]`);
    await page.keyboard.press("r");
    for (const { t_end } of actions) {
      await page.keyboard.press(".");
      await hasTime(page, t_end);
    }
  });
});

test("coloured by state, robots change colour with their state", async () => {
  await onPage(async (page) => {
    const answer = await planned(page, TURNING);
    await page.click("#view-menu summary");
    await page.check("input[name=colours][value=state]");
    const [turn, drive] = answer.plans[0].actions;
    const seen = [];
    for (const time of [turn.t_end / 2, (drive.t_start + drive.t_end) / 2, answer.makespan]) {
      await seek(page, time);
      await hasTime(page, time);
      const state = await page.evaluate(() => window.fleetplan.stateOf("turner"));
      const expected = await themeColour(page, `--state-${state}`);
      const { x, y, radius } = await page.evaluate(() => window.fleetplan.screenOf("turner"));
      const { theta } = await page.evaluate(() => window.fleetplan.poseOf("turner"));
      const behind = { x: x - Math.cos(theta) * radius * 0.8, y: y + Math.sin(theta) * radius * 0.8 };
      assert.deepEqual(await coloursAt(page, [behind]), [expected], state);
      seen.push(state);
    }
    assert.deepEqual(seen, ["turning", "moving", "arrived"]);
  });
});

test("paths are painted whole, as what remains, or not at all", async () => {
  await onPage(async (page) => {
    const answer = await planned(page, TURNING);
    const [, drive] = answer.plans[0].actions;
    const time = drive.t_start + (drive.t_end - drive.t_start) * 0.6;
    await seek(page, time);
    await hasTime(page, time);
    await page.click("#view-menu summary");
    const painted = async (x) => {
      const place = await page.evaluate((at) => window.fleetplan.pointOf({ x: at, y: 0.5 }), x);
      const [on, off] = await coloursAt(page, [place, { x: place.x, y: place.y + 6 }]);
      return on !== off;
    };
    const seen = {};
    for (const paths of ["whole", "remaining", "none"]) {
      await page.check(`input[name=paths][value=${paths}]`);
      seen[paths] = [await painted(1.75), await painted(3.75)];
    }
    assert.deepEqual(seen, { whole: [true, true], remaining: [false, true], none: [false, false] });
  });
});

test("the view menu closes with Escape and returns the focus", async () => {
  await onPage(async (page) => {
    await page.focus("#view-menu summary");
    await page.keyboard.press("Enter");
    await page.focus("input[name=paths][value=none]");
    await page.keyboard.press("Escape");
    assert.equal(await page.evaluate(() => document.getElementById("view-menu").open), false);
    assert.equal(await page.evaluate(() => document.activeElement.closest("#view-menu") !== null), true);
  });
});

test("the scrubber is valid at the end of plans of any duration", async () => {
  await onPage(async (page) => {
    for (const t_end of [
      29.63154999175816, 10.56071246609105, 0.7082952024278107, 44.13056343826284, 99999999.7,
    ]) {
      const [from, to] = [0.5, 4.5].map((x) => ({ x, y: 0.5, theta: 0 }));
      const actions = [{ type: "translate", t_start: 0, t_end, from, to }];
      const [robot] = TURNING.robots;
      await paste(page, { ...TURNING, robots: [robot], plans: [{ robot: robot.id, actions }] });
      await page.waitForFunction((duration) => window.fleetplan.duration === duration, t_end);
      await page.focus("#scrubber");
      await page.keyboard.press("End");
      await hasTime(page, t_end);
      const { valid, value } = await page.evaluate(() => {
        const scrubber = document.getElementById("scrubber");
        return { valid: scrubber.checkValidity(), value: Number(scrubber.value) };
      });
      assert.equal(valid, true, String(t_end));
      assert.ok(Math.abs(value - t_end) < 1e-6, `${value}`);
    }
  });
});
