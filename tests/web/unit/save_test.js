import assert from "node:assert/strict";
import { test } from "node:test";

import { curlCommand, fileStem, pythonProgram } from "../../../web/files/save.js";

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

test("the program for Python fetches an example and holds any other request as a text", () => {
  const base = "http://fleet.example/plans/";
  const fetched = pythonProgram({ example: "hall-100", text: "{}" }, base, false);
  assert.match(fetched, /^from fleetplan import Client/);
  assert.match(fetched, /Client\("http:\/\/fleet.example\/plans"\)/);
  assert.match(fetched, /client.example\("hall-100"\)/);
  const text = String.raw`{"robots":[{"id":"a \"b\""}]}`;
  const held = pythonProgram({ example: null, text }, base, true);
  assert.ok(held.includes(`request = json.loads(r'''${text}''')`), held);
  assert.ok(held.includes('token=os.environ["TOKEN"]'), held);
});

test("the program for Python holds texts with quotes, too", async () => {
  const { execFileSync } = await import("node:child_process");
  for (const text of [`{"id": "'''"}`, `{"id": "\\\\'''\\n\ud83e\udd16"}`, `'`, `\\`]) {
    const program = pythonProgram({ example: null, text }, "http://fleet.example/", false);
    const literal = /json\.loads\((.*?)\)\n/s.exec(program)[1];
    const printed = execFileSync("python3", [
      "-c",
      `import sys; sys.stdout.buffer.write((${literal}).encode())`,
    ]);
    assert.equal(printed.toString(), text);
  }
});
