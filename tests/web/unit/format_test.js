// Numbers as the page shows them.

import assert from "node:assert/strict";
import { test } from "node:test";

import { count, grouped, megabytes, seconds } from "../../../web/ui/format.js";

test("thousands are apart, as toLocaleString has them", () => {
  for (const number of [0, 7, 999, 1000, 12345, 123456, 1234567, 1e9, -4321, 1000.5, 99999.25])
    assert.equal(grouped(number), number.toLocaleString("en"));
});

test("quantities have their digits and units", () => {
  assert.equal(seconds(3), "3.00 s");
  assert.equal(seconds(999.994), "999.99 s");
  assert.equal(seconds(12345.67), "12,345.7 s");
  assert.equal(megabytes(16_000_000), "16 MB");
  assert.equal(megabytes(1_234_567_890), "1,234.6 MB");
  assert.equal(count(1, "robot"), "1 robot");
  assert.equal(count(2000, "robot"), "2,000 robots");
  assert.equal(count(3, "more", "more"), "3 more");
});
