import assert from "node:assert/strict";
import { test } from "node:test";

import { latestOnly } from "../../../web/model/latest.js";

const rest = () => new Promise((resolve) => setTimeout(resolve, 20));

test("newer work replaces what has not begun", async () => {
  const begun = [];
  const later = latestOnly();
  later(5, async () => begun.push("first"));
  later(0, async () => begun.push("second"));
  await rest();
  assert.deepEqual(begun, ["second"]);
});

test("newer work aborts what is under way, whose failure is dropped", async () => {
  const later = latestOnly();
  const ended = [];
  later(0, (signal) => {
    const aborted = new Promise((_, reject) => signal.addEventListener("abort", () => reject(signal.reason)));
    return aborted.finally(() => ended.push("first"));
  });
  await rest();
  later(0, async (signal) => ended.push(signal.aborted));
  await rest();
  assert.deepEqual(ended, ["first", false]);
});
