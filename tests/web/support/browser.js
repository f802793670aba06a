// Headless Chromium, and pages that record errors.

import { chromium } from "playwright-core";

const FLAGS = ["--no-sandbox", "--disable-gpu", "--disable-quic"];

const PATIENCE_MS = 120_000; // what is waited for takes long only on a busy machine

/** Chromium's error when a network interface of the machine appeared or disappeared. */
const DISTURBED = /ERR_NETWORK_CHANGED/;

/** How Chromium is launched: without windows, and the browser's own pages in them, which take a quarter of the time. */
const LAUNCH = {
  executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium-headless-shell",
  args: FLAGS,
};

export const startBrowser = () => chromium.launch(LAUNCH);

/** A context whose waits take as long as a busy machine needs. Its browser has visited the page, unless `isNew`. */
export async function newContext(browser, { isNew = false, ...options } = {}) {
  const context = await browser.newContext(options);
  if (!isNew) {
    await context.addInitScript(() => {
      const isPage = location.protocol.startsWith("http"); // others have no storage
      if (isPage && localStorage.length === 0) localStorage.setItem("fleetplan-visit", "{}");
    });
  }
  context.setDefaultTimeout(PATIENCE_MS);
  return context;
}

/**
 * A page that has loaded `url` and its first request, in its own context: {page, complaints, requested, close}.
 * `complaints` collects console errors, warnings and uncaught exceptions, `requested` every requested address.
 */
export async function openPage(browser, url, options = {}) {
  const context = await newContext(browser, { viewport: { width: 1440, height: 900 }, ...options });
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
  await pickExample(page, name);
  await page.waitForFunction(
    ({ before, text }) =>
      window.fleetplan.request !== before && JSON.stringify(window.fleetplan.request) === text,
    { before, text: JSON.stringify(expected) },
  );
  return expected;
}

/** Chooses an example, as a press on its picture does, also if it is the chosen one. */
export async function pickExample(page, name) {
  await page.locator(`.example[data-example="${name}"]`).evaluate((button) => button.click());
}

/** The name of the example that is chosen. */
export const chosenExample = (page) => page.getAttribute(".example[aria-current]", "data-example");

/** Presses Plan and waits for the answer. */
export async function pressPlan(page) {
  await page.click("#plan");
  const isDone = () => window.fleetplan.answer && document.getElementById("cancel").hidden;
  await page.waitForFunction(isDone);
  return page.evaluate(() => window.fleetplan.answer);
}

/** Waits until a plan plays, or has played, and pauses it, wherever it is by then. */
export async function pause(page) {
  await page.waitForFunction(() => window.fleetplan.time > 0);
  await page.evaluate(() => {
    if (window.fleetplan.playing) document.getElementById("play").click(); // at once: it may be about to end
  });
}

/** Presses Plan, waits for the answer, and pauses the plan once it plays; returns the answer. */
export async function planAndPause(page) {
  const answer = await pressPlan(page);
  await pause(page);
  return answer;
}

/** Chooses an example, plans it and pauses the plan; returns the answer. */
export async function planned(page, example) {
  await choose(page, example);
  return planAndPause(page);
}

/** Moves the scrubber to a time as dragging it does. */
export function seek(page, time) {
  return page.evaluate((value) => {
    const scrubber = document.getElementById("scrubber");
    scrubber.value = String(value);
    scrubber.dispatchEvent(new Event("input", { bubbles: true }));
  }, time);
}
