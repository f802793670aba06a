// The robots without a plan, by their reasons, and the robots that are stuck. Offers more time for robots that had too
// little.

import { stuckOf } from "../model/stuck.js";
import { byId, element } from "../ui/dom.js";
import { grouped, seconds } from "../ui/format.js";
import { blockedBy, robotChip } from "./robot_list.js";

const MAX_UNFOLDED = 12; // robots of a reason
const WITH_MORE_TIME = ["budget_exhausted", "blocked_by_robots"]; // reasons that may change
const LONGER = 4; // times the budget, to offer

/** Names of the reasons of /v1/plan. */
export const REASONS = {
  start_blocked: "Start blocked",
  goal_blocked: "Goal blocked",
  goal_unreachable: "Goal unreachable",
  blocked_by_robots: "Blocked by other robots",
  budget_exhausted: "Out of time",
  committed_in_the_way: "In the way of committed motion",
  invalid: "Invalid",
  stuck: "Stuck within the horizon",
};

/**
 * Lists the robots that the session's answer leaves without a plan, and the robots that are stuck. `budgetOf(request,
 * limits)`: see planning_panel.js. `plan()` plans the request.
 */
export function watchUnplanned(session, budgetOf, plan) {
  const planLonger = (budget) => {
    const { request } = session;
    const options = { ...request.options, time_budget_ms: Math.round(budget * 1000) };
    session.edit({ ...request, options });
    plan();
  };
  session.on("answer limits", () => {
    const { answer, request, limits, outdated } = session;
    const listed = [...(answer?.unplanned ?? []), ...stuckOf(answer)];
    const box = byId("unplanned");
    box.hidden = listed.length === 0;
    box.replaceChildren();
    if (listed.length === 0) return;
    const longer = outdated === null ? longerBudget(answer, budgetOf(request, limits), limits) : null;
    box.append(
      element("h2", { textContent: answer.unplanned.length > 0 ? "Without a plan" : "Stuck" }),
      longer === null ? "" : moreTimeButton(longer, planLonger),
      ...groupsOf(listed).map(([reason, entries]) => groupOf(session, reason, entries)),
    );
  });
}

/** A longer budget, seconds, if one may help and the service has one; else null. */
export function longerBudget({ unplanned, search }, budget, { max_budget_ms = Infinity }) {
  const isOpen = search !== undefined && search.exhausted !== true;
  const mayHelp = isOpen && unplanned.some(({ reason }) => WITH_MORE_TIME.includes(reason));
  const longer = Math.min(LONGER * (budget ?? 0), max_budget_ms / 1000);
  return mayHelp && longer > (budget ?? Infinity) ? longer : null;
}

/** The entries by reason, the most frequent one first: [[reason, entries]]. */
export function groupsOf(unplanned) {
  const groups = new Map();
  for (const entry of unplanned) groups.set(entry.reason, [...(groups.get(entry.reason) ?? []), entry]);
  return [...groups].sort(([, a], [, b]) => b.length - a.length);
}

function moreTimeButton(budget, planLonger) {
  const textContent = `Plan again with ${seconds(budget)}`;
  const button = element("button", { type: "button", id: "more-time", textContent });
  button.addEventListener("click", () => planLonger(budget));
  return button;
}

function groupOf(session, reason, entries) {
  const name = REASONS[reason] ?? reason;
  const title = element(
    "summary",
    {},
    element("span", { class: "reason", textContent: name }),
    " ",
    element("span", { class: "count", textContent: grouped(entries.length) }),
  );
  const list = element("ul", { class: "stuck" }, ...entries.map((entry) => robotCard(session, entry)));
  const open = entries.length <= MAX_UNFOLDED;
  return element("details", { class: "reason-group", "data-reason": reason, open }, title, list);
}

function robotCard(session, entry) {
  return element(
    "li",
    { class: "card" },
    element("div", { class: "chips" }, robotChip(session, entry.robot)),
    entry.detail ? element("p", { textContent: entry.detail }) : null,
    blockedBy(session, entry),
  );
}
