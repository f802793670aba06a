// Headless Chromium, and pages that record errors.

import { chromium } from "playwright-core";

const FLAGS = [
  "--no-sandbox",
  "--disable-gpu",
  "--disable-quic",
  "--no-first-run",
  "--disable-background-networking",
  "--disable-component-update",
  "--disable-sync",
];

/** Chromium's error when a network interface of the machine appeared or disappeared. */
const DISTURBED = /ERR_NETWORK_CHANGED/;

export function startBrowser() {
  return chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: FLAGS });
}

/**
 * A page that has loaded `url` and its first request, in its own context: {page, complaints, requested, close}.
 * `complaints` collects console errors, warnings and uncaught exceptions, `requested` every requested address.
 */
export async function openPage(browser, url, options = {}) {
  const context = await browser.newContext({ viewport: { width: 1440, height: 900 }, ...options });
  const page = await context.newPage();
  const complaints = [];
  const requested = [];
  page.on("console", (message) => {
    if (["error", "warning"].includes(message.type())) complaints.push(message.text());
  });
  page.on("pageerror", (error) => complaints.push(String(error)));
  page.on("request", (request) => requested.push(request.url()));
  const disturbed = new Promise((resolve) => {
    page.on("console", (message) => DISTURBED.test(message.text()) && resolve("disturbed"));
  });
  const begun = begin(page, url).catch((error) => error);
  const outcome = await Promise.race([begun, disturbed]);
  if (outcome === "disturbed" || DISTURBED.test(outcome?.message)) {
    await context.close();
    return openPage(browser, url, options);
  }
  if (outcome instanceof Error) {
    const shown = await page.innerText("body").catch(() => "no page");
    const details = `${complaints.join("; ")}; requested ${requested.join(" ")}; it shows ${shown}`;
    throw new Error(`the page did not start: ${details}`, { cause: outcome });
  }
  return { page, complaints, requested, close: () => context.close() };
}

async function begin(page, url) {
  await page.goto(url);
  await page.waitForFunction(() => window.fleetplan?.request);
}

/** Chooses an example and waits until it is drawn, again if it was open already. */
export async function choose(page, name) {
  const before = await page.evaluateHandle(() => window.fleetplan.request);
  const expected = await page.evaluate(
    async (example) => (await fetch(`v1/examples/${example}`)).json(),
    name,
  );
  await page.selectOption("#example", name);
  await page.waitForFunction(
    ({ before, text }) =>
      window.fleetplan.request !== before && JSON.stringify(window.fleetplan.request) === text,
    { before, text: JSON.stringify(expected) },
  );
  return expected;
}

/** Presses Plan and waits for the answer. */
export async function pressPlan(page) {
  await page.click("#plan");
  const isDone = () => window.fleetplan.answer && document.getElementById("cancel").hidden;
  await page.waitForFunction(isDone, null, { timeout: 60_000 });
  return page.evaluate(() => window.fleetplan.answer);
}

/** Chooses an example, plans it and pauses the plan, wherever it is by then; returns the answer. */
export async function planned(page, example) {
  await choose(page, example);
  const answer = await pressPlan(page);
  await page.waitForFunction(() => window.fleetplan.time > 0);
  if (await page.evaluate(() => window.fleetplan.playing)) await page.click("#play");
  return answer;
}

/** Moves the scrubber to a time as dragging it does. */
export function seek(page, time) {
  return page.evaluate((value) => {
    const scrubber = document.getElementById("scrubber");
    scrubber.value = String(value);
    scrubber.dispatchEvent(new Event("input", { bubbles: true }));
  }, time);
}
