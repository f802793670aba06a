// The Analyse tab: it loads when it is opened; plans are simulated, and runs played.

import assert from "node:assert/strict";
import { test } from "node:test";

import { pause, planned } from "../support/browser.js";
import { hook, pagesFor, paste } from "../support/on_page.js";
import { expectedPose } from "../support/expected_pose.js";

const onPage = pagesFor();
const PHONE = { viewport: { width: 390, height: 844 }, isMobile: true, hasTouch: true };

/** Opens the Analyse tab by keys. */
async function openAnalysis(page) {
  await page.focus("#tab-plan");
  await page.keyboard.press("End");
  await page.waitForSelector(".simulation");
}

for (const [size, options] of [
  ["desktop", {}],
  ["phone", PHONE],
]) {
  test(`a plan is simulated by keys alone, and a run with a collision is played, ${size}`, async () => {
    await onPage(
      async (page) => {
        const answer = await planned(page, "crossing");
        await openAnalysis(page);
        const asked = page.waitForRequest((request) => request.url().endsWith("/v1/simulate"));
        await page.getByLabel("Executions").fill("40");
        await page.getByLabel("Minimum speed").fill("60");
        await page.getByRole("button", { name: "Simulate" }).focus();
        await page.keyboard.press("Enter");
        const body = JSON.parse((await asked).postData());
        assert.deepEqual(
          [body.policy, body.runs, body.disturbance.speed.min, body.plans.length],
          ["absorb_waits", 40, 0.6, answer.plans.length],
        );
        await page.waitForSelector(".share-words");
        const simulated = await page.evaluate(async (sent) => {
          const headers = { "Content-Type": "application/json" };
          return (await fetch("v1/simulate", { method: "POST", headers, body: sent })).json();
        }, JSON.stringify(body));
        assert.ok(simulated.collision_share > 0);
        const words = `${Number((simulated.collision_share * 100).toFixed(0))} %`;
        assert.equal(await page.innerText(".share-words b"), words);
        assert.match(await page.getAttribute(".quantiles >> nth=0", "aria-label"), /makespan \+/);

        const [first] = simulated.first_collisions;
        await page.getByRole("button", { name: `Execution ${first.run}: ` }).focus();
        await page.keyboard.press("Enter");
        await page.waitForFunction(() => /execution/.test(window.fleetplan.answer.warnings[0]));
        const from = Math.max(0, first.t - 2); // s, where it is played from
        await page.waitForFunction((begin) => window.fleetplan.time > begin, from);
        await pause(page);
        const { trace } = await page.evaluate(
          async (sent) => {
            const headers = { "Content-Type": "application/json" };
            return (await fetch("v1/simulate", { method: "POST", headers, body: sent })).json();
          },
          JSON.stringify({ ...body, runs: first.run + 1, trace: first.run }),
        );
        const time = await hook(page, "time");
        assert.ok(time >= first.t - 2.001);
        for (const { robot, actions } of trace.plans) {
          const { start } = body.robots.find(({ id }) => id === robot);
          const pose = await page.evaluate((id) => window.fleetplan.poseOf(id), robot);
          const expected = expectedPose(start, actions, time);
          assert.ok(Math.hypot(pose.x - expected.x, pose.y - expected.y) < 1e-6, robot);
        }
        await page.getByRole("button", { name: "Back to the plan" }).click();
        assert.deepEqual(await hook(page, "answer"), answer);
        assert.equal(await page.isVisible(".share-words"), true, "the figures stay");
      },
      { options },
    );
  });
}

test("with dependencies the same delays cause no collision", async () => {
  await onPage(async (page) => {
    await planned(page, "hospital-ward");
    await openAnalysis(page);
    await page.getByLabel("Policy").selectOption("dependencies");
    await page.getByLabel("Executions").fill("30");
    await page.getByRole("button", { name: "Simulate" }).click();
    await page.waitForSelector(".share-words");
    assert.equal(await page.innerText(".share-words b"), "0 %");
  });
});

test("a plan is made robust: margins are found, shown with their cost, and used", async () => {
  await onPage(async (page) => {
    const before = await planned(page, "crossing");
    const request = await hook(page, "request");
    await openAnalysis(page);
    await page.getByRole("button", { name: "Simulate" }).click();
    const start = page.getByRole("button", { name: "Make it robust" });
    await start.focus();
    const asked = page.waitForRequest((sent) => sent.url().endsWith("/v1/margins"));
    await page.keyboard.press("Enter");
    const body = JSON.parse((await asked).postData());
    assert.deepEqual(
      [body.policy, body.aim, body.disturbance.speed.min],
      ["absorb_waits", { collisions: 0.01 }, 0.8],
    );
    assert.deepEqual(body.request.robots, request.robots);
    const depend = page.getByRole("button", { name: "Try with dependencies" }); // no margin lasts without them
    await depend.focus();
    await page.keyboard.press("Enter");
    const use = page.getByRole("button", { name: "Use this plan" });
    await use.waitFor();
    assert.equal(await page.getByLabel("Policy").inputValue(), "dependencies");
    assert.match(
      await page.innerText(".robust .share-words >> nth=0"),
      /^Holds with: .* between robots\. Flowtime [+\u2212]/,
    );
    const rows = await page.$$eval(".robust tbody tr", (all) =>
      all.map((row) => [row.className, ...[...row.children].map((cell) => cell.textContent)]),
    );
    assert.match(rows[0].join("; "), /^; none; \d+ % of \d+; \+0 %$/);
    assert.equal(rows.filter(([name]) => name === "best").length, 1);
    assert.equal(await page.locator(".robust circle").count(), rows.length);
    assert.match(
      await page.getAttribute(".robust svg", "aria-label"),
      /cost of the margins: .*\+0 %: \d+ %; /,
    );

    await use.click();
    await page.waitForFunction(() => window.fleetplan.request.options?.interval_margin > 0);
    const answer = await hook(page, "answer");
    assert.equal(answer.verified, true);
    assert.notEqual(answer.flowtime, before.flowtime);
    await page.getByRole("button", { name: "Simulate" }).click();
    await page.waitForSelector(".share-words");
    assert.ok(parseFloat(await page.innerText(".share-words b")) <= 1);
    await page.keyboard.press("Control+z");
    await page.waitForFunction((flowtime) => window.fleetplan.answer?.flowtime === flowtime, before.flowtime);
    assert.deepEqual(await hook(page, "request"), request);
  });
});

test("figures of a simulation do not outlast their plan", async () => {
  await onPage(async (page) => {
    await planned(page, "crossing");
    await openAnalysis(page);
    await page.getByRole("button", { name: "Simulate" }).click();
    await page.waitForSelector(".robust");
    await paste(page, await hook(page, "request")); // opened again, without a plan
    await page.waitForFunction(() => window.fleetplan.answer === null);
    assert.equal(await page.locator(".robust, .share-words").count(), 0);
  });
});

test("the search for margins can be stopped", async () => {
  await onPage(async (page) => {
    await planned(page, "crossing");
    await openAnalysis(page);
    await page.getByRole("button", { name: "Simulate" }).click();
    const start = page.locator(".robust button").first();
    await start.waitFor();
    await page.route("**/v1/margins", () => {}); // no answer
    await start.click();
    await page.getByRole("button", { name: "Stop", exact: true }).click();
    assert.equal(await start.innerText(), "Make it robust");
    assert.equal(await page.innerText(".robust [role=status]"), "");
    await page.unroute("**/v1/margins");
    await page.getByLabel("Accepted collisions").fill("");
    await start.click();
    assert.equal(await start.innerText(), "Make it robust", "a number is missing");
  });
});

test("a tab that does not load says so and is loaded again on demand", async () => {
  await onPage(
    async (page) => {
      await page.route(/analysis_panel/, (route) => route.abort());
      await page.click("#tab-analyse");
      await page.waitForSelector("#panel-analyse .fault");
      await page.unroute(/analysis_panel/);
      await page.click("#panel-analyse button");
      await page.waitForSelector(".simulation");
    },
    { allowed: /ERR_FAILED/ },
  );
});
