import assert from "node:assert/strict";
import { test } from "node:test";

import { plusTimes } from "../../../web/files/text.js";

test("sums of multiples are exact in decimal", () => {
  assert.equal(plusTimes(0, 3, 0.05), 0.15);
  assert.equal(plusTimes(-10.1, 37, 0.05), -8.25);
  assert.equal(plusTimes(0.1, 1, 0.2), 0.3);
  assert.equal(plusTimes(-51.224998, 1000, 0.05), -1.224998);
  assert.equal(plusTimes(5, 0, 0.05), 5);
});

test("small, large and whole numbers keep all digits", () => {
  assert.equal(plusTimes(1e-7, 2, 1.5e-8), 1.3e-7);
  assert.equal(plusTimes(1e21, 1, 1e21), 2e21);
  assert.equal(plusTimes(-0, 7, 100), 700);
});
