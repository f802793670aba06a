import assert from "node:assert/strict";
import { test } from "node:test";

import { degreesOf, radiansOf } from "../../../web/model/degrees.js";

test("degrees that are typed are shown as they were typed", () => {
  for (let tenths = -7200; tenths <= 7200; tenths += 1) {
    const degrees = tenths / 10;
    assert.equal(degreesOf(radiansOf(degrees)), degrees);
  }
});

test("what is no number stays", () => {
  assert.deepEqual([undefined, "east", null].map(degreesOf), [undefined, "east", null]);
  assert.equal(radiansOf(undefined), undefined);
});
