// What a first visit shows: an example is planned and plays, with a line that says what is seen, and the next steps.

import { byId, setText } from "../ui/dom.js";
import { count } from "../ui/format.js";

/** The example that is open on a first visit. */
export const FIRST_EXAMPLE = "warehouse";

/** `plan()` plans the session's request, and plays the plan; resolves when it is done. */
export async function welcome(session, plan) {
  if (session.example !== FIRST_EXAMPLE || session.answer !== null || session.planning !== null) return;
  const { request } = session;
  await plan();
  if (session.request !== request || !session.hasPlan) return; // another request is open, or the service is busy
  const box = byId("welcome");
  const close = () => {
    box.hidden = true;
  };
  setText(byId("welcome-text"), describe(session.answer));
  box.hidden = false;
  session.on("request", close);
  byId("welcome-close").addEventListener("click", close);
  byId("welcome-draw").addEventListener("click", () => byId("new-map").requestSubmit());
  byId("welcome-open").addEventListener("click", () => byId("open").click());
}

function describe({ plans, timings_ms: { plan } }) {
  const time = plan < 1000 ? `${Math.max(1, Math.round(plan))} ms` : `${(plan / 1000).toFixed(1)} s`;
  return `${count(plans.length, "robot")} cross a warehouse, and no two of them touch: planned in ${time}, and checked.`;
}
