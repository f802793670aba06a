// The page in a frame of another page (?embed), and the moment of a plan that an address leads to.

import { byId } from "../ui/dom.js";
import { budgetOf } from "./planning_panel.js";

/** Leaves the scene, the timeline and the player, and a link to the whole page. */
export function embed(session) {
  document.documentElement.classList.add("embed");
  const link = byId("open-whole");
  const refresh = () => (link.href = `${location.pathname}${location.hash}`);
  link.hidden = false;
  refresh();
  session.on("answer", refresh);
  link.addEventListener("pointerenter", refresh); // the address follows later
  link.addEventListener("focus", refresh);
}

/** Plans the request unless its plan is there, and shows a moment of the plan at rest, seconds. */
export async function showMomentOfPlan(session, moment) {
  if (session.request === null) return;
  const { limits, request } = session;
  if (!session.hasPlan && !(await session.plan(budgetOf(request, limits)))) return;
  session.pause();
  session.seek(moment);
}
