// The page measures gaps as the service's check does: in the plan of each example and, to have robots under way, with loads
// and with committed motion, in that of the example a moment later.

import assert from "node:assert/strict";
import { after, test } from "node:test";

import { clearanceOf } from "../../../web/model/clearance.js";
import { FleetMotion } from "../../../web/model/fleet_motion.js";
import { Shown } from "../../../web/model/shown.js";
import { Signals } from "../../../web/model/signals.js";
import { startService } from "../support/service.js";

const service = await startService();
after(() => service.stop());

const AGREED = 1e-6; // metres: the service rounds gaps of contact to 0
const LATER = [0.2, 0.5]; // of the time that the plan takes
const COMMIT = 1; // seconds

async function ask(path, body) {
  const init = body && {
    method: "POST",
    headers: { "Content-Type": "application/json" },
    body: JSON.stringify(body),
  };
  const response = await fetch(new URL(path, service.url), init);
  const answer = await response.json();
  assert.equal(response.status, 200, `${path}: ${JSON.stringify(answer).slice(0, 500)}`);
  return answer;
}

/** The gaps that the page has of a plan: {least, apart} of all pairs, and without those at rest, metres. */
async function gapsOnPage(request, answer) {
  const shown = new Shown();
  shown.showRequest(request);
  shown.showAnswer(answer, null);
  const signals = new Signals();
  const session = Object.assign(shown, { on: (names, listener) => signals.on(names, listener) });
  const fleet = new FleetMotion(session, async (motions) => clearanceOf(motions, undefined, false));
  const computed = new Promise((resolve) => fleet.onCurve(() => fleet.curve && resolve(fleet.curve)));
  signals.emit("answer");
  const { gap } = await computed;
  const all = clearanceOf([...fleet.byId.values()]);
  return { least: all.gap[all.least], apart: gap.reduce((least, each) => Math.min(least, each), Infinity) };
}

async function assertAgree(request, answer) {
  assert.equal(answer.verified, true);
  const { least, apart } = await gapsOnPage(request, answer);
  assert.ok(Math.abs(least - answer.min_clearance) <= AGREED, `${least} is not ${answer.min_clearance}`);
  assert.ok(apart >= -AGREED, `${apart} is marked as an overlap`);
}

/** The request for a later moment of a plan, in which robots are under way. */
async function laterRequest(request, { plans, makespan }, share) {
  const at = Math.round(makespan * share * 1000) / 1000;
  return ask("v1/advance", { request, plans, at, commit: COMMIT });
}

const { examples } = await ask("v1/examples");

for (const { name } of examples) {
  test(`${name}: the page and the service measure the same gaps`, async () => {
    const request = await ask(`v1/examples/${name}`);
    const answer = await ask("v1/plan", request);
    await assertAgree(request, answer);
    for (const share of LATER) {
      const later = await laterRequest(request, answer, share);
      await assertAgree(later, await ask("v1/plan", later));
    }
  });
}
