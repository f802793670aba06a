import assert from "node:assert/strict";
import { test } from "node:test";
import { deflateSync } from "node:zlib";

import { isLinkState, LONGEST_LINK, readLinkState, writeLinkState } from "../../../web/files/address.js";

const REQUEST = {
  map: { rows: ["#.é☃", "...."], resolution: 0.05, origin: { x: -0.1, y: 1e-7 } },
  robots: [{ id: 'ä\n"', start: { x: 0.1, y: 0.30000000000000004 } }],
};
const fragmentOf = (bytes) => `#r=${Buffer.from(bytes).toString("base64url")}`;

test("a request survives the round trip through a link", async () => {
  const fragment = await writeLinkState(REQUEST);
  assert.match(fragment, /^#r=[\w-]+$/);
  assert.equal(isLinkState(fragment), true);
  assert.equal(isLinkState("#warehouse"), false);
  assert.deepEqual(await readLinkState(fragment), REQUEST);
});

test("a map of plain walls takes little room", async () => {
  const rows = Array.from({ length: 60 }, (_, row) => (row % 5 ? "." : "#").repeat(80));
  assert.ok((await writeLinkState({ map: { rows }, robots: [] })).length < LONGEST_LINK / 20);
});

test("other deflate streams are read, too", async () => {
  assert.deepEqual(await readLinkState(fragmentOf(deflateSync('{"robots": []}'))), { robots: [] });
});

test("a damaged link is rejected, wherever the damage is", async () => {
  const fragment = await writeLinkState(REQUEST);
  const damaged = /link is damaged or truncated.*Ask for a new link/;
  for (let length = 3; length < fragment.length; length += 1)
    await assert.rejects(readLinkState(fragment.slice(0, length)), damaged, `cut to ${length}`);
  for (let at = 3; at < fragment.length - 1; at += 1) {
    const other = fragment[at] === "A" ? "B" : "A";
    await assert.rejects(
      readLinkState(fragment.slice(0, at) + other + fragment.slice(at + 1)),
      damaged,
      `changed at ${at}`,
    );
  }
  await assert.rejects(readLinkState(`${fragment}%20`), damaged);
  await assert.rejects(readLinkState(fragmentOf(deflateSync("no JSON"))), damaged);
  await assert.rejects(readLinkState(fragmentOf(deflateSync(Buffer.from([34, 255, 34])))), damaged);
});

test("a link that inflates beyond the limit is rejected early", async () => {
  const bomb = deflateSync(Buffer.alloc(64 * 2 ** 20, " "));
  await assert.rejects(readLinkState(fragmentOf(bomb)), /more than 8 MiB/);
});
