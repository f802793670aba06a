import assert from "node:assert/strict";
import { test } from "node:test";

import { recordingSpeed } from "../../../web/share/animation.js";
import { assembled } from "../../../web/share/html_page.js";

const PARTS = { name: "a <b> & c", style: "p{}", body: "<p>here</p>", data: "{}", code: "go()", modules: {} };

test("long plans are recorded faster, so that the animation lasts at most a minute", () => {
  assert.equal(recordingSpeed(30, 1), 1);
  assert.equal(recordingSpeed(30, 4), 4);
  assert.equal(recordingSpeed(300, 2), 5);
});

test("no name, data or code ends a part of the page", () => {
  const page = assembled({
    ...PARTS,
    data: JSON.stringify({ id: "</script><script>alert(1)</script>" }),
    code: 'show("</script>")',
    style: "p::before{content:'</style>'}",
  });
  assert.ok(page.includes("<title>a &lt;b> &amp; c – Fleetplan</title>"));
  assert.equal(page.match(/<\/script/g).length, 3);
  assert.equal(page.match(/<\/style/g).length, 1);
  const data = /id="shared">(.*?)<\/script>/s.exec(page)[1];
  assert.deepEqual(JSON.parse(data), { id: "</script><script>alert(1)</script>" });
});

test("imported modules are in the page by their names", async () => {
  const page = assembled({ ...PARTS, modules: { "part-0": "export const n = 7; // ü" } });
  const { imports } = JSON.parse(/type="importmap">(.*?)<\/script>/s.exec(page)[1]);
  assert.equal((await import(imports["part-0"])).n, 7);
});
