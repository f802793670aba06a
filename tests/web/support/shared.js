// What the tests of a process share, whatever their files: a browser, and a server for each set of flags. They are started
// when a test first asks for them, and end after the last test.

import { after } from "node:test";

import { startBrowser } from "./browser.js";
import { startService } from "./service.js";

const started = new Map(); // promises of {end}, by what they are

after(async () => {
  for (const each of [...started.values()].reverse()) await each.then(({ end }) => end());
});

export async function sharedBrowser() {
  const { browser } = await share("browser", async () => {
    const browser = await startBrowser();
    return { browser, end: () => browser.close() };
  });
  return browser;
}

/** The server with these flags: {url}. */
export async function sharedService(flags = []) {
  const { service } = await share(`service ${flags.join(" ")}`, async () => {
    const service = await startService(flags);
    return { service, end: () => service.stop() };
  });
  return service;
}

function share(what, start) {
  if (!started.has(what)) started.set(what, start());
  return started.get(what);
}
