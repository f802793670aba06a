// Whether the page stays responsive with a thousand robots or four million cells. It measures the page's longest task
// while these are opened or planned, and the scripts and styles of a frame while the camera moves or the plan plays.
//
// The figures are CPU time of the page's main thread, as reported by Chromium's tracing, without a GPU. "painted"
// includes the painting of canvases, which a GPU would do. Other work on the machine does not count, except for its
// effect on caches. Medians of some runs.
//
//   FLEETPLAN_BIN=… node bench/frame_times.js [runs] [seconds of each movement]

import { mkdtemp, rm, writeFile } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";

import { openPage, startBrowser } from "../support/browser.js";
import { startService } from "../support/service.js";
import { buildingAsImage, buildingAsRows, buildingOfRos, warehouseOf } from "./requests.js";
import { framesOf, longestTask, traced } from "./tracing.js";

const RUNS = Number(process.argv[2] ?? 3);
const SECONDS = Number(process.argv[3] ?? 5);
const AIM = { task: 100, frame: 8 }; // milliseconds
const FLEETS = [500, 1000];
const SETTLED_MS = 2500; // after what was waited for: checks, lists and pictures follow
const EVERY_MS = 16;
const PATIENT = { timeout: 60_000 };

/** Opens files of the disk: contents that are passed to the page would take its time. */
async function openFiles(page, files) {
  const paths = Object.entries(files).map(([name, content]) => [join(folder, name), content]);
  for (const [path, content] of paths) await writeFile(path, content);
  await page.setInputFiles(
    "#file",
    paths.map(([path]) => path),
  );
}

/** Opens a request by these steps. */
async function opened(page, steps) {
  const before = await page.evaluateHandle(() => window.fleetplan.request);
  await steps();
  await page.waitForFunction((request) => window.fleetplan.request !== request, before);
}

const hasCheck = (page) => page.waitForFunction(() => window.fleetplan.check !== null, null, PATIENT);

/** Steps whose longest task counts: [name, prepare(page), steps(page)]. */
function openings(request, plan) {
  const robots = `${request.robots.length} robots`;
  const none = async () => {};
  const openRequest = (page) =>
    opened(page, () => openFiles(page, { "warehouse.json": JSON.stringify(request) }));
  const openBuilding = (request) => (page) =>
    opened(page, () => openFiles(page, { "building.json": JSON.stringify(request) }));
  const selectRobot = async (page) => {
    await openBuilding(buildingAsRows())(page);
    await page.locator("#robots .robot").first().click();
    await page.click("#view-menu summary");
  };
  const showTravelTimes = async (page) => {
    await page.check("input[name=travel]");
    await page.waitForSelector("#travel-legend li", PATIENT);
  };
  const openRos = (page) =>
    opened(page, async () => {
      await openFiles(page, buildingOfRos());
      await page.click("dialog[open] .primary");
    });
  const openPlan = async (page) => {
    await openFiles(page, { "warehouse.plan.json": plan });
    await hasCheck(page);
  };
  const showRequest = async (page) => {
    await openRequest(page);
    await page.waitForTimeout(SETTLED_MS);
  };
  const pressPlan = async (page) => {
    await page.click("#plan");
    await page.waitForFunction(() => window.fleetplan.answer !== null, null, PATIENT);
  };
  return [
    ["open 4 M cells as rows", none, openBuilding(buildingAsRows())],
    ["open 4 M cells as an image", none, openBuilding(buildingAsImage())],
    ["open 4 M cells of ROS", none, openRos],
    ["travel times on 4 M cells", selectRobot, showTravelTimes],
    [`open ${robots}`, none, openRequest],
    [`open a plan of ${robots}`, none, openPlan],
    [`adopt a plan of ${robots}`, showRequest, pressPlan],
  ];
}

async function movement(page, step) {
  const end = Date.now() + SECONDS * 1000;
  for (let at = 0; Date.now() < end; at += 1) {
    await step(at);
    await page.waitForTimeout(EVERY_MS);
  }
}

/** Movements whose frames count: [name, steps(page)], of a plan that is open. */
const MOVEMENTS = [
  [
    "zoom",
    async (page, middle) => {
      await page.mouse.move(...middle);
      await movement(page, (at) => page.mouse.wheel(0, at % 60 < 30 ? -60 : 60));
    },
  ],
  [
    "pan",
    async (page, [x, y]) => {
      await page.focus("#scene");
      for (let times = 0; times < 3; times += 1) await page.keyboard.press("+");
      await page.mouse.move(x, y);
      await page.mouse.down();
      await movement(page, (at) => page.mouse.move(x + 200 * Math.sin(at / 15), y + 100 * Math.cos(at / 15)));
      await page.mouse.up();
    },
  ],
  [
    "play",
    async (page) => {
      await page.keyboard.press("f");
      await page.click("#play");
      await page.waitForTimeout(SECONDS * 1000);
      await page.click("#play");
    },
  ],
];

function percentile(values, share) {
  const sorted = [...values].sort((a, b) => a - b);
  return sorted[Math.min(sorted.length - 1, Math.floor(share * sorted.length))];
}

const median = (values) => percentile(values, 0.5);

/** The medians of the members of some objects. */
const medians = (results) =>
  Object.fromEntries(Object.keys(results[0]).map((key) => [key, median(results.map((each) => each[key]))]));

async function repeated(measure) {
  const results = [];
  for (let run = 0; run < RUNS; run += 1) results.push(await measure());
  return medians(results);
}

async function planOf(request) {
  const headers = { "Content-Type": "application/json" };
  const init = { method: "POST", headers, body: JSON.stringify(request) };
  const answer = await (await fetch(`${service.url}v1/plan`, init)).json();
  return JSON.stringify({ ...request, ...answer });
}

/** What `measure(page)` resolves to on a fresh page. */
async function onPage(measure) {
  const { page, close } = await openPage(browser, service.url);
  try {
    await page.waitForTimeout(SETTLED_MS);
    return await measure(page);
  } finally {
    await close();
  }
}

function taskOf(prepare, steps) {
  return onPage(async (page) => {
    await prepare(page);
    const events = await traced(page, async () => {
      await steps(page);
      await page.waitForTimeout(SETTLED_MS);
    });
    return longestTask(events);
  });
}

function frameOf(plan, steps) {
  return onPage(async (page) => {
    await openFiles(page, { "warehouse.plan.json": plan });
    await hasCheck(page);
    await page.waitForTimeout(SETTLED_MS);
    const box = await page.locator("#scene").boundingBox();
    const middle = [box.x + box.width / 2, box.y + box.height / 2];
    const frames = framesOf(await traced(page, () => steps(page, middle)));
    const p95 = (valueOf) => percentile(frames.map(valueOf), 0.95);
    return {
      both: p95(({ script, style }) => script + style),
      painted: p95(({ all }) => all),
      perSecond: frames.length / SECONDS,
    };
  });
}

const ms = (value) => value.toFixed(1).padStart(8);
const verdict = (value, aim) => (value <= aim ? "" : `  above ${aim}`);

const folder = await mkdtemp(join(tmpdir(), "fleetplan-"));
const service = await startService();
const browser = await startBrowser();
const plans = new Map();
for (const robots of FLEETS) plans.set(robots, await planOf(warehouseOf(robots)));
const most = Math.max(...FLEETS);

console.log(`longest task, ms${" ".repeat(20)} CPU    wall`);
for (const [name, prepare, steps] of openings(warehouseOf(most), plans.get(most))) {
  const { cpu, wall } = await repeated(() => taskOf(prepare, steps));
  console.log(`${name.padEnd(32)}${ms(cpu)}${ms(wall)}${verdict(cpu, AIM.task)}`);
}
console.log(`CPU of a frame, p95, ms      script+style painted  frames/s`);
for (const robots of FLEETS) {
  for (const [name, steps] of MOVEMENTS) {
    const { both, painted, perSecond } = await repeated(() => frameOf(plans.get(robots), steps));
    const what = `${name}, ${robots} robots`;
    console.log(`${what.padEnd(32)}${ms(both)}${ms(painted)}${ms(perSecond)}${verdict(both, AIM.frame)}`);
  }
}
await browser.close();
await service.stop();
await rm(folder, { recursive: true });
