// Progress of planning in headless Chromium: what is shown until there is an answer.

import assert from "node:assert/strict";
import { test } from "node:test";

import { choose, chosenExample, openPage, pressPlan } from "../support/browser.js";
import { hook, pagesFor, paste, streamPlan } from "../support/on_page.js";
import { startService } from "../support/service.js";
import { sharedBrowser } from "../support/shared.js";

const onPage = pagesFor();

const progressOf = (costs) =>
  costs.map(([flowtime, makespan], at) => {
    const best = { flowtime, makespan };
    return ["progress", { elapsed_ms: 100 * at, attempt: at + 1, planned: 2, robots: 2, best }];
  });

/** The heights at which the drawn curve goes on, from its beginning. */
async function heightsOf(page) {
  const path = await page.getAttribute("#cost-curve path", "d");
  return [...path.matchAll(/(?:M\S+ |V)(\S+?)(?=H|$)/g)].map(([, y]) => Number(y));
}

test("the falling cost is drawn while planning", async () => {
  await onPage(async (page) => {
    const costs = [90, 80, 72.5].map((flowtime) => [flowtime, 40]);
    await streamPlan(page, progressOf(costs));
    await page.click("#plan");
    await page.waitForFunction(() => /72\.50/.test(document.getElementById("so-far").textContent));
    assert.match(
      await page.getAttribute("#cost-curve svg", "aria-label"),
      /^Flowtime fell from 90\.00 s to 72\.50 s \(−19\.4 %\)$/,
    );
    assert.equal(
      await page.innerText("#so-far"),
      "2 of 2 robots planned, attempt 3, flowtime 72.50 s, makespan 40.00 s",
    );
    const heights = await heightsOf(page);
    assert.equal(heights.length, 3);
    assert.ok(heights[0] < heights[1] && heights[1] < heights[2], "lower cost is further down");
    await page.click("#cancel");
    assert.equal(await hook(page, "answer"), null);
  });
});

test("a falling makespan is drawn as such while the flowtime rises", async () => {
  await onPage(async (page) => {
    const request = await choose(page, "crossing");
    await paste(page, { ...request, options: { ...request.options, objective: "makespan" } });
    await page.waitForFunction(() => window.fleetplan.request.options.objective === "makespan");
    const costs = [
      [11_881, 300],
      [12_215, 270],
    ];
    await streamPlan(page, progressOf(costs));
    await page.click("#plan");
    await page.waitForSelector("#cost-curve svg");
    assert.equal(
      await page.innerText("#cost-curve .facts"),
      "Makespan fell from 300.00 s to 270.00 s (−10.0 %)",
    );
    assert.match(await page.innerText("#so-far"), /, makespan 270\.00 s, flowtime 12,215\.0 s$/);
    for (const height of await heightsOf(page)) assert.ok(height >= 0 && height <= 44, `${height} is drawn`);
  });
});

test("the outcome is announced with both costs", async () => {
  await onPage(async (page) => {
    const { flowtime, makespan } = await pressPlan(page);
    const announced = await page.innerText("#announcer");
    for (const cost of [flowtime, makespan]) assert.ok(announced.includes(cost.toFixed(2)), announced);
  });
});

test("the best plan is kept when the connection is lost", async () => {
  await onPage(async (page) => {
    const better = await pressPlan(page);
    await choose(page, await chosenExample(page));
    assert.equal(await hook(page, "answer"), null);
    const worse = { ...better, plans: better.plans.slice(1) };
    await streamPlan(page, [...progressOf([[90, 40]]), ["incumbent", worse], ["incumbent", better]], {
      cut: true,
    });
    await page.click("#plan");
    await page.waitForSelector("#problem:not([hidden])");
    assert.match(
      await page.innerText("#problem"),
      /No response from the service.*The best plan found until then is shown/s,
    );
    assert.deepEqual(await hook(page, "answer"), better);
    assert.match(await page.innerText("#summary"), /Solved\s+Verified/);
    await page.waitForFunction(() => window.fleetplan.time > 0);
  });
});

test("the best plan is kept when the service is killed while it improves it", async () => {
  const service = await startService();
  try {
    const { page, close } = await openPage(await sharedBrowser(), service.url);
    const request = await choose(page, "crossing");
    await paste(page, { ...request, options: { mode: "anytime", time_budget_ms: 60_000 } });
    await page.waitForFunction(() => window.fleetplan.request.options?.mode === "anytime");
    await page.click("#plan");
    await page.waitForFunction(() => window.fleetplan.answer?.status === "solved"); // a plan came
    assert.equal(await page.isVisible("#cancel"), true, "better ones may follow");
    await service.kill();
    await page.waitForSelector("#problem:not([hidden])");
    assert.equal((await hook(page, "answer")).status, "solved");
    await close();
  } finally {
    await service.kill();
  }
});

/** Answers plans with 503; returns what ends that. */
async function overloaded(page, headers) {
  const problem = {
    title: "Service Unavailable",
    detail: "The queue is full.",
    status: 503,
    code: "overloaded",
  };
  const contentType = "application/problem+json";
  await page.route("**/v1/plan", (route) =>
    route.fulfill({ status: 503, contentType, headers, body: JSON.stringify(problem) }),
  );
  return () => page.unroute("**/v1/plan");
}

test("planning waits for a busy service, and can be cancelled meanwhile", async () => {
  await onPage(
    async (page) => {
      const free = await overloaded(page, { "Retry-After": "1" });
      await page.click("#plan");
      const waits = () => /The service is busy/.test(document.getElementById("so-far").textContent);
      await page.waitForFunction(waits);
      assert.match(await page.innerText("#announcer"), /is retried in 1 s/);
      await page.click("#cancel");
      assert.equal(await hook(page, "answer"), null);
      await page.click("#plan");
      await page.waitForFunction(waits);
      await free();
      await page.waitForFunction(() => window.fleetplan.answer?.verified);
      assert.equal(await page.isVisible("#problem"), false);
    },
    { allowed: /status of 503/ },
  );
});

test("a busy service that does not say when to come back is reported", async () => {
  await onPage(
    async (page) => {
      await overloaded(page, {});
      await page.click("#plan");
      await page.waitForSelector("#problem:not([hidden])");
      assert.match(await page.innerText("#problem"), /The queue is full\./);
    },
    { allowed: /status of 503/ },
  );
});

test("robots that ran out of time are counted by reason, and planned with more", async () => {
  await onPage(async (page) => {
    const request = await choose(page, "warehouse");
    await paste(page, { ...request, options: { time_budget_ms: 5 } });
    await page.waitForFunction(() => window.fleetplan.request.options.time_budget_ms === 5);
    let answer = await pressPlan(page);
    assert.equal(answer.status === "solved", false, "5 ms do not suffice");
    const late = answer.unplanned.filter(({ reason }) => reason === "budget_exhausted");
    const group = page.locator('.reason-group[data-reason="budget_exhausted"]');
    assert.match(await group.locator("summary").innerText(), new RegExp(`^Out of time ${late.length}$`));
    assert.equal(await group.locator(".card").count(), late.length);
    for (let round = 0; round < 8 && answer.status !== "solved"; round += 1) {
      await page.click("#more-time");
      await page.waitForFunction(() => window.fleetplan.answer && !window.fleetplan.outdated);
      answer = await hook(page, "answer");
    }
    assert.equal(answer.status, "solved");
    assert.ok((await hook(page, "request")).options.time_budget_ms >= 20);
  });
});
