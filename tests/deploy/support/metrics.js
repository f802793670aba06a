// The metrics of a running server, and the series that PromQL expressions use.

import { startService } from "../../web/support/service.js";

/** The text of /metrics of a server that has just started, and `has(series)`. */
export async function metricsOfServer() {
  const service = await startService();
  try {
    const text = await (await fetch(new URL("/metrics", service.url))).text();
    const has = (series) => text.includes(`\n${series}`) || text.includes(`\n${series.replace(/\{.*/, "")} `);
    return { text, has };
  } finally {
    await service.stop();
  }
}

/**
 * The series of this service in an expression. If a series has exactly one label that is not a pattern, with this
 * label.
 */
export function seriesIn(expression) {
  return expression.match(/\b(?:fleetplan|process)_\w+(?:\{[^}=~]*="[^"]*"\})?/g) ?? [];
}
