// Runs `node --test` with these arguments, on all test files if none is named. Starting a process, and Chromium in it,
// takes longer than most tests. So the files of browser/ and of unit/ are run in batches: a process each, which runs
// file after file.

import { spawn } from "node:child_process";
import { once } from "node:events";
import { mkdtemp, readdir, rm, stat, writeFile } from "node:fs/promises";
import { availableParallelism, tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";

const AT_ONCE = availableParallelism() + 1; // processes, as tests wait for frames
const BATCHES = 2 * AT_ONCE; // so that a process that is done early takes another batch

async function testFiles(folder) {
  const names = await readdir(folder);
  return names.filter((name) => name.endsWith("_test.js")).map((name) => join(folder, name));
}

/** Writes a module to `folder` for each of so many batches of the files, which imports them; about as much to each. */
async function writeBatches(files, folder, name, count) {
  const sized = await Promise.all(files.map(async (file) => ({ file, size: (await stat(file)).size })));
  sized.sort((one, other) => other.size - one.size);
  /** @type {string[]} */ const modules = Array.from({ length: Math.min(count, files.length) }, () => "");
  sized.forEach(({ file }, at) => {
    modules[at % modules.length] += `await import(${JSON.stringify(pathToFileURL(resolve(file)).href)});\n`;
  });
  const batches = modules.map((text, at) => ({ path: join(folder, `${name}_${at + 1}_test.mjs`), text }));
  await Promise.all(batches.map(({ path, text }) => writeFile(path, text)));
  return batches.map(({ path }) => path);
}

const given = process.argv.slice(2);
const options = given.filter((each) => each.startsWith("-"));
const named = given.filter((each) => !each.startsWith("-"));
const FOLDERS = ["browser", "static", "unit"];
const files = named.length > 0 ? named : (await Promise.all(FOLDERS.map(testFiles))).flat();
const within = (name) => files.filter((file) => resolve(file).startsWith(resolve(name)));
const folder = await mkdtemp(join(tmpdir(), "fleetplan-page-tests-"));
try {
  const [inBrowser, units] = [within("browser"), within("unit")];
  const others = files.filter((file) => !inBrowser.includes(file) && !units.includes(file));
  const all = [
    ...(await writeBatches(inBrowser, folder, "browser", BATCHES)),
    ...others,
    ...(await writeBatches(units, folder, "unit", AT_ONCE)),
  ];
  const tests = spawn(process.execPath, ["--test", `--test-concurrency=${AT_ONCE}`, ...options, ...all], {
    stdio: "inherit",
  });
  const [code] = await once(tests, "exit");
  process.exitCode = code ?? 1;
} finally {
  await rm(folder, { recursive: true });
}
