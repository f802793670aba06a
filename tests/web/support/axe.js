// The rules of axe-core, run on a page.

import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";

const SOURCE = await readFile(new URL("../node_modules/axe-core/axe.min.js", import.meta.url), "utf8");

/**
 * Fails with every element of the page that violates a rule of axe-core; `state` says what the page shows. `rules`:
 * those that are run, by default all that axe-core recommends.
 */
export async function assertAccessible(page, state, rules = null) {
  if (!(await page.evaluate(() => "axe" in window))) await page.evaluate(SOURCE);
  const options = { resultTypes: ["violations"], ...(rules === null ? {} : { runOnly: rules }) };
  const found = await page.evaluate(async (asked) => {
    const { violations, passes } = await /** @type {any} */ (window).axe.run(asked);
    const faults = violations.flatMap(({ id, nodes }) =>
      nodes.map(({ target, failureSummary }) => `${id}: ${target.join(" ")}: ${failureSummary}`),
    );
    return { faults, passed: passes.length };
  }, options);
  assert.ok(found.passed > 0, "rules were applied");
  assert.deepEqual(found.faults, [], state);
}
