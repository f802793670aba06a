// How long a frame takes while 300 robots play: the CPU time of the page's main thread from one frame to the next, for
// script, layout and drawing together, as reported by Chromium's tracing. Without a GPU, so that canvases are painted by
// the CPU; other work on the machine does not count, but for what it costs caches.
//
//   FLEETPLAN_BIN=… node bench/frame_times.js [robots] [seconds]

import { openPage, pressPlan, startBrowser } from "../support/browser.js";
import { startService } from "../support/service.js";

const ROBOTS = Number(process.argv[2] ?? 300);
const SECONDS = Number(process.argv[3] ?? 10);
const SIDE = 64; // cells

/** Numbers in [0, 1), the same each time (a linear congruential generator, constants of Numerical Recipes). */
function sequence(seed) {
  let state = seed;
  return () => (state = (Math.imul(state, 1664525) + 1013904223) >>> 0) / 2 ** 32;
}

/** Robots between random cells of an empty hall, no two starts and no two goals on one cell. */
function request() {
  const random = sequence(1);
  const cells = () => {
    const taken = new Set();
    while (taken.size < ROBOTS) taken.add(Math.floor(random() * SIDE * SIDE));
    return [...taken].map((cell) => ({ x: (cell % SIDE) + 0.5, y: Math.floor(cell / SIDE) + 0.5 }));
  };
  const [starts, goals] = [cells(), cells()];
  return {
    map: { rows: Array(SIDE).fill(".".repeat(SIDE)) },
    robot_defaults: { radius: 0.4, linear_speed: 1, angular_speed: 1.5 },
    robots: starts.map((start, at) => ({ id: `robot-${at + 1}`, start, goal: goals[at] })),
    options: { time_budget_ms: 60_000 },
  };
}

async function trace(page, milliseconds) {
  const client = await page.context().newCDPSession(page);
  const events = [];
  client.on("Tracing.dataCollected", ({ value }) => events.push(...value));
  const complete = new Promise((resolve) => client.once("Tracing.tracingComplete", resolve));
  const includedCategories = ["devtools.timeline", "disabled-by-default-devtools.timeline"];
  await client.send("Tracing.start", { transferMode: "ReportEvents", traceConfig: { includedCategories } });
  await page.waitForTimeout(milliseconds);
  await client.send("Tracing.end");
  await complete;
  return events;
}

const DRAWING = ["UpdateLayoutTree", "Layout", "PrePaint", "Paint", "Layerize", "Commit"];

/**
 * CPU milliseconds of the page's main thread for each frame: [{script, drawn, all}], in scripts alone, with style,
 * layout and drawing, and with all that the browser does beside them.
 */
function framesOf(events) {
  const scripts = events.filter(({ name }) => name === "FireAnimationFrame");
  const { pid, tid } = scripts[0];
  const own = (name) =>
    events
      .filter(
        (event) => event.name === name && event.pid === pid && event.tid === tid && event.tdur !== undefined,
      )
      .sort((a, b) => a.ts - b.ts);
  const tasks = own("RunTask");
  const drawn = [...scripts, ...DRAWING.flatMap(own)];
  const begins = own("Commit").map(({ ts, dur }) => ts + dur); // a frame ends with its commit
  const sum = (parts, from, to) =>
    parts.reduce((total, { ts, tdur }) => total + (ts >= from && ts < to ? tdur : 0), 0) / 1000;
  return begins.slice(1).map((end, at) => ({
    script: sum(scripts, begins[at], end),
    drawn: sum(drawn, begins[at], end),
    all: sum(tasks, begins[at], end),
  }));
}

function percentile(values, share) {
  const sorted = [...values].sort((a, b) => a - b);
  return sorted[Math.min(sorted.length - 1, Math.floor(share * sorted.length))];
}

const service = await startService();
const browser = await startBrowser();
const { page } = await openPage(browser, service.url);
await page.click("#paste");
await page.fill("#paste-text", JSON.stringify(request()));
await page.click("#paste-form button");
const answer = await pressPlan(page);
await page.waitForFunction(() => window.fleetplan.time > 0.5);
const frames = framesOf(await trace(page, SECONDS * 1000));
if (!(await page.evaluate(() => window.fleetplan.playing))) throw new Error("the plan was too short");
await browser.close();
await service.stop();

console.log(
  `${answer.plans.length} of ${ROBOTS} robots, ${frames.length} frames in ${SECONDS} s, 1440 × 900 pixels`,
);
for (const part of ["script", "drawn", "all"]) {
  const times = frames.map((frame) => frame[part]);
  const shown = [0.5, 0.95, 0.99].map((share) => `p${share * 100} ${percentile(times, share).toFixed(1)}`);
  console.log(`${part.padEnd(6)} ${shown.join("  ")} ms`);
}
