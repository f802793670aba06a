// The sources of the page and its tests are formatted, free of lint errors and type-correct.

import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { test } from "node:test";
import { fileURLToPath } from "node:url";

const FOLDER = fileURLToPath(new URL("..", import.meta.url)); // with the package.json

const run = (script) => {
  const { status, stdout, stderr } = spawnSync("npm", ["run", "--silent", script], {
    cwd: FOLDER,
    encoding: "utf8",
  });
  assert.equal(status, 0, `npm run ${script}:\n${stdout}${stderr}`);
};

test("sources are formatted as Prettier formats them", () => run("format"));

test("ESLint finds no error or warning", () => run("lint"));

test("types agree with the JSDoc comments", () => run("types"));
