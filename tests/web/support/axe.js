// The rules of axe-core, run on a page.

import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";

const SOURCE = await readFile(new URL("../node_modules/axe-core/axe.min.js", import.meta.url), "utf8");

/** The rules that the colours of a page decide. */
export const COLOUR_RULES = ["color-contrast", "link-in-text-block"];

/**
 * Fails with every element of the page that violates one of these rules of axe-core. Without rules, all rules for pages
 * apply. `state` says what the page shows.
 */
export async function assertAccessible(page, state, rules = null) {
  if (!(await page.evaluate(() => "axe" in window))) await page.evaluate(SOURCE);
  const found = await violationsOn(page, rules, { selectors: false });
  assert.ok(found.passed > 0, "rules were applied");
  if (found.faults.length === 0) return;
  assert.deepEqual((await violationsOn(page, rules)).faults, [], state);
}

/** What violates the rules, and how many rules were passed. Selectors of elements take half of the time. */
function violationsOn(page, rules, options = {}) {
  return page.evaluate(
    async ({ values, options }) => {
      // Details of violations only, which takes a fraction of the time. No media, which the page does not have. No copy
      // of its styles, which none of these rules needs.
      const { violations, passes } = await /** @type {any} */ (window).axe.run({
        resultTypes: ["violations"],
        preload: false,
        ...options,
        ...(values && { runOnly: { type: "rule", values } }),
      });
      const faults = violations.flatMap(({ id, nodes }) =>
        nodes.map(({ target, failureSummary }) => `${id}: ${target?.join(" ")}: ${failureSummary}`),
      );
      return { faults, passed: passes.length };
    },
    { values: rules, options },
  );
}
