// The files of deploy/, and the settings and version of the server.

import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { readdirSync, readFileSync } from "node:fs";
import { fileURLToPath } from "node:url";

import { load } from "js-yaml";

const PROJECT = new URL("../../../", import.meta.url);

/** The absolute path of a file of the project. */
export function pathOf(name) {
  return fileURLToPath(new URL(name, PROJECT));
}

export function textOf(name) {
  return readFileSync(pathOf(name), "utf8");
}

/** The only YAML document of a file. */
export function yamlOf(name) {
  return load(textOf(name));
}

export function namesIn(folder) {
  return readdirSync(pathOf(folder)).sort();
}

/** What the server prints, such as for --help. */
export function outputOf(flag) {
  const { stdout, error } = spawnSync(process.env.FLEETPLAN_BIN, [flag], { encoding: "utf8" });
  if (error) throw error;
  return stdout;
}

/** Runs promtool; fails with what it prints if it finds a fault. */
export function promtool(...words) {
  const { error, status, stdout, stderr } = spawnSync("promtool", words, { encoding: "utf8" });
  assert.ifError(error);
  assert.equal(status, 0, stdout + stderr);
}

/** The names of the environment variables of all settings. */
export function settingNames() {
  return new Set(outputOf("--help").match(/FLEETPLAN_[A-Z_]+/g));
}

/** The bytes of a size such as 4MiB, or of a memory limit such as 512m or 2Gi. */
export function bytesOf(size) {
  const [, number, prefix] = /^(\d+)([mMgG])(?:i|iB)?$/.exec(size);
  return Number(number) * (prefix.toLowerCase() === "m" ? 2 ** 20 : 2 ** 30);
}

/** The most bytes that a replica needs, as docs/operations.md derives them. */
export function memoryOfReplica({ workers, maxBody, maxPlanMemory, mapCache, maxUnsent }) {
  const queue = 4 * workers;
  const bodies = bytesOf(maxBody) * (workers + queue + 1 + queue);
  const plans = bytesOf(maxPlanMemory) * (3 * workers + 2);
  return bytesOf("30MiB") + bodies + plans + bytesOf(mapCache) + bytesOf(maxUnsent);
}
