// How long the page takes until it can be used, on a slow connection: from the navigation until the first example is
// drawn and the Plan button is enabled. First with an empty cache, then again with a filled cache. Medians of some
// runs.
//
//   FLEETPLAN_BIN=… node bench/first_load.js [runs] [web root]

import { startBrowser } from "../support/browser.js";
import { startService } from "../support/service.js";

const RUNS = Number(process.argv[2] ?? 5);
const WEB_ROOT = process.argv[3];

const CONNECTION = {
  offline: false,
  latency: 150, // of a round trip, milliseconds
  downloadThroughput: 1.4e6 / 8, // bytes a second
  uploadThroughput: 1.4e6 / 8,
};

/** Loads the page in a new tab of the context: {ms until usable, requests, bytes received}. */
async function load(context, url) {
  const page = await context.newPage();
  const client = await context.newCDPSession(page);
  await client.send("Network.enable");
  await client.send("Network.emulateNetworkConditions", CONNECTION);
  let requests = 0;
  let bytes = 0;
  client.on("Network.loadingFinished", ({ encodedDataLength }) => {
    if (encodedDataLength > 0) requests += 1;
    bytes += encodedDataLength;
  });
  await page.addInitScript(() => {
    const look = () => {
      if (window.fleetplan?.request && !document.getElementById("plan").disabled) {
        window.usableAt = performance.now();
      } else {
        requestAnimationFrame(look);
      }
    };
    requestAnimationFrame(look);
  });
  await page.goto(url, { waitUntil: "commit" });
  const usable = await page.waitForFunction(() => window.usableAt);
  const ms = await usable.jsonValue();
  await page.waitForLoadState("networkidle");
  if (process.env.VERBOSE) await printTimings(page);
  await page.close();
  return { ms, requests, bytes };
}

/** The times at which each file was requested and had arrived. */
async function printTimings(page) {
  const entries = await page.evaluate(() =>
    performance
      .getEntries()
      .filter(({ entryType }) => entryType === "navigation" || entryType === "resource")
      .map(({ name, startTime, responseEnd, transferSize }) => ({
        name,
        startTime,
        responseEnd,
        transferSize,
      })),
  );
  for (const { name, startTime, responseEnd, transferSize } of entries) {
    const times = [startTime, responseEnd].map((time) => String(Math.round(time)).padStart(6)).join("");
    console.log(`  ${times} ms ${String(transferSize).padStart(8)} bytes  ${new URL(name).pathname}`);
  }
}

function median(values) {
  return [...values].sort((a, b) => a - b)[Math.floor(values.length / 2)];
}

const service = await startService(WEB_ROOT ? ["--web-root", WEB_ROOT] : []);
const browser = await startBrowser();
const loads = { first: [], second: [] };
for (let run = 0; run < RUNS; run += 1) {
  const context = await browser.newContext({ viewport: { width: 1440, height: 900 } });
  for (const name of ["first", "second"]) loads[name].push(await load(context, service.url));
  await context.close();
}
await browser.close();
await service.stop();

console.log("1.4 Mbit/s, 150 ms a round trip; until the first example is drawn and can be planned:");
for (const [name, results] of Object.entries(loads)) {
  const [ms, requests, bytes] = ["ms", "requests", "bytes"].map((key) =>
    median(results.map((result) => result[key])),
  );
  console.log(
    `${name.padEnd(6)} load ${(ms / 1000).toFixed(2)} s, ${requests} requests, ${(bytes / 1000).toFixed(0)} kB`,
  );
}
