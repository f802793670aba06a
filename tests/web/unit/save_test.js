import assert from "node:assert/strict";
import { test } from "node:test";

import { curlCommand, fileStem } from "../../../web/files/save.js";

test("a file name derives from the opened name, without extension and special characters", () => {
  assert.equal(fileStem("corridor-swap"), "corridor-swap");
  assert.equal(fileStem("night shift.plan.json"), "night-shift");
  assert.equal(fileStem("Fleet.JSON"), "Fleet");
  assert.equal(fileStem("arena.map"), "arena");
  assert.equal(fileStem("arena.map.scen"), "arena.map");
  assert.equal(fileStem("lab.yaml"), "lab");
  assert.equal(fileStem("v1.2 (final).json"), "v1.2-final-");
  assert.equal(fileStem(""), "request");
});

test("the command line fetches an example and inlines any other request", () => {
  const base = "http://fleet.example/plans/";
  const post =
    "curl -sS http://fleet.example/plans/v1/plan -H 'Content-Type: application/json' --data-binary @-";
  assert.equal(
    curlCommand({ example: "hall-100", text: "{}" }, base, false),
    `curl -sS http://fleet.example/plans/v1/examples/hall-100 | ${post}`,
  );
  const text = `{"robots":[{"id":"o'neill"}]}`;
  assert.equal(curlCommand({ example: null, text }, base, false), `${post} <<'JSON'\n${text}\nJSON\n`);
});

test("the command presents a token where the service asks for one", () => {
  const command = curlCommand({ example: "crossing", text: "{}" }, "http://fleet.example/", true);
  assert.equal(command.match(/curl -sS -H "Authorization: Bearer \$TOKEN" http/g).length, 2);
});
