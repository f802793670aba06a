// Checks the unit of systemd in the Debian package.

import assert from "node:assert/strict";
import { test } from "node:test";

import { textOf } from "./support/files.js";

const unit = textOf("deploy/debian/fleetplan.service");

/** The settings of a section, by name. */
function settingsOf(section) {
  const text = new RegExp(`^\\[${section}\\]$([^[]*)`, "m").exec(unit)[1];
  return new Map([...text.matchAll(/^(\w+)=(.*)$/gm)].map(([, name, value]) => [name, value]));
}

test("the service is started again however often it fails", () => {
  assert.equal(settingsOf("Unit").get("StartLimitIntervalSec"), "0");
  const service = settingsOf("Service");
  assert.equal(service.get("Restart"), "on-failure");
  assert.ok(Number(service.get("RestartSec")) >= 1, "without a pause, a fault of the settings would take a CPU");
});
