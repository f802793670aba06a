// The robots without a plan, and why.

import { byId, element } from "../ui/dom.js";
import { robotChip } from "./robot_chip.js";

/** Reasons of /v1/plan in words. */
export const REASONS = {
  start_blocked: "Start blocked",
  goal_blocked: "Goal blocked",
  goal_unreachable: "Goal unreachable",
  blocked_by_robots: "Blocked by other robots",
  budget_exhausted: "Out of time",
};

/** Lists the robots that the session's answer leaves without a plan. */
export function watchUnplanned(session) {
  session.on("answer", () => showUnplanned(session.answer?.unplanned ?? [], session));
}

function showUnplanned(unplanned, session) {
  const box = byId("unplanned");
  box.hidden = unplanned.length === 0;
  box.replaceChildren();
  if (unplanned.length === 0) return;
  const entries = unplanned.map(({ robot, reason, detail, blocked_by }) =>
    element(
      "li",
      { class: "card" },
      element(
        "div",
        { class: "chips" },
        robotChip(session, robot),
        element("span", { class: "reason", textContent: REASONS[reason] ?? reason }),
      ),
      detail ? element("p", { textContent: detail }) : null,
      blocked_by?.length > 0
        ? element("div", { class: "chips" }, "In the way:", ...blocked_by.map((id) => robotChip(session, id)))
        : null,
    ),
  );
  box.append(element("h2", { textContent: "Without a plan" }), element("ul", { class: "stuck" }, ...entries));
}
