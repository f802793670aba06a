// Runs `node --test` with these arguments and one Chromium for all test files, one more at once than there are CPUs, as
// tests wait for frames. Without it, each file starts a Chromium of its own.

import { spawn } from "node:child_process";
import { once } from "node:events";
import { availableParallelism } from "node:os";
import { chromium } from "playwright-core";

import { LAUNCH } from "./support/browser.js";

const browser = await chromium.launchServer({ ...LAUNCH, host: "127.0.0.1" });
try {
  const files = `--test-concurrency=${availableParallelism() + 1}`;
  const tests = spawn(process.execPath, ["--test", files, ...process.argv.slice(2)], {
    env: { ...process.env, CHROMIUM_ENDPOINT: browser.wsEndpoint() },
    stdio: "inherit",
  });
  const [code] = await once(tests, "exit");
  process.exitCode = code ?? 1;
} finally {
  await browser.close();
}
