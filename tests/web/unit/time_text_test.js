import assert from "node:assert/strict";
import { test } from "node:test";

import { readTime } from "../../../web/model/time_text.js";

test("times are seconds, minutes and hours, or a share of the plan", () => {
  for (const [text, expected] of [
    ["12.5", 12.5],
    [" 12,5 s ", 12.5],
    [".25", 0.25],
    ["3.", 3],
    ["1:05", 65],
    ["1:00:05.5", 3605.5],
    ["40 %", 80],
    ["100%", 200],
  ])
    assert.equal(readTime(text, 200), expected, text);
});

test("other texts are no times", () => {
  for (const text of ["", "soon", "-1", "1:", ":30", "1:20 %", "1e3", "5 m", "."])
    assert.equal(readTime(text, 200), null, text);
});
