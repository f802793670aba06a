import assert from "node:assert/strict";
import { test } from "node:test";

import { optionOf, readOptions, withOption } from "../../../web/model/options.js";

const DOCUMENT = {
  components: {
    schemas: {
      Duration: { type: "number", description: "Seconds.", minimum: 0, maximum: 1e9 },
      PlanOptions: {
        type: "object",
        properties: {
          mode: {
            type: "string",
            title: "Way of planning",
            enum: ["first", "anytime"],
            "x-enumDescriptions": { first: "First solution" },
            default: "first",
          },
          time_budget_ms: { type: "number", minimum: 1, maximum: Number.MAX_VALUE },
          seed: { type: "integer", minimum: 0, default: 0 },
          start_safe_interval: {
            $ref: "#/components/schemas/Duration",
            "x-unit": "s",
            description: "Seconds kept free.",
          },
          connectivity: { type: "integer", enum: [4, 8], default: 8 },
          max_iterations: { type: ["integer", "null"], minimum: 0, default: null },
        },
      },
    },
  },
};
const OPTIONS = readOptions(DOCUMENT);
const seed = OPTIONS.find(({ name }) => name === "seed");
const mode = OPTIONS.find(({ name }) => name === "mode");

test("options have the names, order, ranges and defaults of the service's document", () => {
  const [first, budget, , interval, , steps] = OPTIONS;
  assert.deepEqual(
    OPTIONS.map(({ name }) => name),
    Object.keys(DOCUMENT.components.schemas.PlanOptions.properties),
  );
  assert.deepEqual([first.label, first.default], ["Way of planning", "first"]);
  assert.deepEqual([budget.label, budget.unit, budget.default], ["Time budget", "ms", null]);
  assert.deepEqual([budget.min, budget.max], [1, null]);
  assert.deepEqual([interval.min, interval.max, interval.unit], [0, 1e9, "s"]);
  assert.equal(interval.description, "Seconds kept free.");
  assert.deepEqual([steps.type, steps.default], ["integer", null]);
});

test("choices have the document's words, or those of their values", () => {
  const connectivity = OPTIONS.find(({ name }) => name === "connectivity");
  assert.deepEqual(mode.choices, [
    { value: "first", label: "First solution" },
    { value: "anytime", label: "Anytime" },
  ]);
  assert.deepEqual(connectivity.choices, [
    { value: 4, label: "4" },
    { value: 8, label: "8" },
  ]);
  assert.equal(seed.choices, null);
});

test("an option that is not set has its default", () => {
  assert.equal(optionOf({ robots: [] }, seed), 0);
  assert.equal(optionOf({ options: { seed: 7 } }, seed), 7);
  assert.equal(optionOf(null, mode), "first");
});

test("setting an option changes neither other options nor the original request", () => {
  const request = { robots: [], options: { mode: "anytime" } };
  const edited = withOption(request, seed, 3);
  assert.deepEqual(edited, { robots: [], options: { mode: "anytime", seed: 3 } });
  assert.deepEqual(request, { robots: [], options: { mode: "anytime" } });
  assert.equal(edited.robots, request.robots);
});

test("an option at its default is omitted, and so are empty options", () => {
  assert.deepEqual(withOption({ options: { seed: 3, mode: "anytime" } }, seed, 0), {
    options: { mode: "anytime" },
  });
  assert.deepEqual(withOption({ robots: [], options: { seed: 3 } }, seed, 0), { robots: [] });
  assert.deepEqual(withOption({ robots: [] }, seed, 0), { robots: [] });
});
