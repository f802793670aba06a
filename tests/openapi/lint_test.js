// The document passes a linter of OpenAPI 3.1.

import { spawnSync } from "node:child_process";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import assert from "node:assert/strict";
import { fileURLToPath } from "node:url";

import { openSession } from "./support/session.js";

const LINTER = fileURLToPath(new URL("node_modules/@redocly/cli/bin/cli.js", import.meta.url));
const RULES = fileURLToPath(new URL("redocly.yaml", import.meta.url));

const { document } = await openSession();

function lint(root) {
  const folder = mkdtempSync(join(tmpdir(), "openapi-"));
  try {
    const file = join(folder, "openapi.json");
    writeFileSync(file, JSON.stringify(root, null, 2));
    return spawnSync(process.execPath, [LINTER, "lint", file, "--config", RULES, "--format", "stylish"], {
      encoding: "utf8",
      env: { ...process.env, REDOCLY_TELEMETRY: "off", REDOCLY_SUPPRESS_UPDATE_NOTICE: "true" },
    });
  } finally {
    rmSync(folder, { recursive: true });
  }
}

test("the linter finds no error or warning in the document", () => {
  const { status, stdout, stderr } = lint(document.root);
  assert.equal(status, 0, stdout + stderr);
});

test("the linter finds an operation without a summary and an example that breaks its schema", () => {
  const broken = structuredClone(document.root);
  delete broken.paths["/v1/limits"].get.summary;
  broken.components.responses.NotFound.content["application/problem+json"].examples.not_found.value.status =
    "404";
  const { status, stdout } = lint(broken);
  assert.notEqual(status, 0);
  assert.match(stdout, /operation-summary/);
  assert.match(stdout, /no-invalid-media-type-examples/);
});
