import assert from "node:assert/strict";
import { test } from "node:test";

import { optionOf, OPTIONS, withOption } from "../../../web/model/options.js";

const seed = OPTIONS.find(({ name }) => name === "seed");
const mode = OPTIONS.find(({ name }) => name === "mode");

test("an option that is not set has its default", () => {
  assert.equal(optionOf({ robots: [] }, seed), 0);
  assert.equal(optionOf({ options: { seed: 7 } }, seed), 7);
  assert.equal(optionOf(null, mode), "first");
});

test("setting an option changes no other and not the request it came from", () => {
  const request = { robots: [], options: { mode: "anytime" } };
  const edited = withOption(request, seed, 3);
  assert.deepEqual(edited, { robots: [], options: { mode: "anytime", seed: 3 } });
  assert.deepEqual(request, { robots: [], options: { mode: "anytime" } });
  assert.equal(edited.robots, request.robots);
});

test("an option at its default is left out, and options that are all left out", () => {
  assert.deepEqual(withOption({ options: { seed: 3, mode: "anytime" } }, seed, 0), {
    options: { mode: "anytime" },
  });
  assert.deepEqual(withOption({ robots: [], options: { seed: 3 } }, seed, 0), { robots: [] });
  assert.deepEqual(withOption({ robots: [] }, seed, 0), { robots: [] });
});
