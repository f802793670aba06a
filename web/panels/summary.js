// The outcome of planning: the figures of the answer.

import { byId, element, icon } from "../ui/dom.js";
import { count, grouped, metres, milliseconds, seconds } from "../ui/format.js";

const TICK = "M4.5 10.5 8.5 14.5 15.5 6";
const CROSS = "M5 5 15 15M15 5 5 15";
const PART = "M4.5 10h11";

const OUTCOMES = {
  solved: { text: "Solved", tone: "good", path: TICK },
  partial: { text: "Partially solved", tone: "fair", path: PART },
  none: { text: "No robot planned", tone: "bad", path: CROSS },
};

/** Names of the parts of timings_ms other than planning. */
const PARTS = { queue: "queue", parse: "parse", verify: "check", serialize: "write" };

/** A sentence about the outcome of planning. */
export function summarize(answer) {
  const outcome = OUTCOMES[answer.status]?.text ?? answer.status;
  const planned = `${count(answer.plans.length, "robot")} planned`;
  const failed = answer.unplanned.length > 0 ? `, ${answer.unplanned.length} without a plan` : "";
  const costs = `flowtime ${seconds(answer.flowtime)}, makespan ${seconds(answer.makespan)}`;
  return `${outcome}: ${planned}${failed}, ${costs}.`;
}

/** Shows the figures of the session's answer; a plan from a file may lack some of them. */
/** `fleet`: see FleetMotion; `show(ids, t)` shows a moment of two robots. */
export function watchSummary(session, fleet, show) {
  const refresh = () => showSummary(session, fleet, show);
  session.on("answer check", refresh);
  fleet.onCurve(refresh);
}

function showSummary(session, fleet, show) {
  const { answer, check, outdated } = session;
  const box = byId("summary");
  box.hidden = answer === null;
  if (answer === null) {
    box.replaceChildren();
    return;
  }
  const { flowtime, makespan, lower_bound: least } = answer;
  const gap = check?.min_clearance ?? answer.min_clearance ?? null;
  const figures = element(
    "dl",
    { class: "figures" },
    figure("Flowtime", seconds(flowtime), ...bound(flowtime, least?.flowtime)),
    figure("Makespan", seconds(makespan), ...bound(makespan, least?.makespan)),
    figure("Smallest gap", gap === null ? "–" : metres(gap), "between two robots"),
    answer.timings_ms ? effort(answer) : null,
  );
  box.classList.toggle("outdated", outdated !== null);
  box.replaceChildren(outdated === null ? badges(answer, check) : outdatedNote(answer, outdated), figures);
  if (fleet.least !== null && outdated === null) box.append(leastButton(fleet.least, show));
  if (answer.timings_ms) box.append(otherTimings(answer.timings_ms));
  if (answer.lattice_spacing) box.append(fact(`Lattice spacing ${metres(answer.lattice_spacing)}`));
  if (answer.warnings.length > 0) box.append(warningList(answer.warnings));
}

/** Leads to the moment at which two robots are closest in all of the plan. */
function leastButton({ ids, t, gap }, show) {
  const textContent = `Closest: ${ids.join(" and ")}, ${metres(gap)} at ${seconds(t)}`;
  const button = element("button", { type: "button", class: "quiet least", textContent });
  button.addEventListener("click", () => show(ids, t));
  return button;
}

/** What people want to know of a new plan at once: whether it is solved and verified, its smallest gap and margins. */
export function inShort({ status, verified, min_clearance: gap = null }, options = {}) {
  const outcome = `${OUTCOMES[status]?.text ?? status}${verified ? ", verified" : ""}`;
  const nearest = gap === null ? "" : ` Smallest gap ${metres(gap)}.`;
  const { inflation = 0, interval_margin = 0 } = options;
  return `${outcome}.${nearest} Margins: ${metres(inflation)} around each robot, ${seconds(interval_margin)} early or late.`;
}

function effort({ timings_ms: timings, search }) {
  const expansions = search ? count(search.expansions, "expansion") : "";
  return figure(
    "Planned in",
    milliseconds(timings.plan),
    expansions,
    `${milliseconds(timings.total)} in total`,
  );
}

/** The service's time besides planning. */
function otherTimings(timings) {
  const parts = Object.entries(PARTS).map(([part, words]) => `${words} ${(timings[part] ?? 0).toFixed(2)}`);
  return fact(`${parts.join(" · ")} ms`);
}

function fact(textContent) {
  return element("p", { class: "facts", textContent });
}

function badges(answer, check) {
  const outcome = OUTCOMES[answer.status] ?? OUTCOMES.none;
  const verified = check?.valid ?? answer.verified ?? null;
  const [tone, path] = verified === false ? ["", null] : [outcome.tone, outcome.path];
  const list = element("div", { class: "badges" }, badge(outcome.text, tone, path));
  if (verified) {
    list.append(
      badge("Verified", "good", TICK, "An independent check in continuous time found no collision"),
    );
  } else if (verified === false) {
    list.append(badge("Not verified", "bad", CROSS));
  }
  if (answer.deterministic === undefined) return list;
  const why = answer.deterministic
    ? "The same request and seed give the same plan"
    : "The time budget ended the search: another run may differ";
  list.append(badge(answer.deterministic ? "Deterministic" : "Not deterministic", "", null, why));
  return list;
}

/** What still holds of a plan whose request was edited. */
function outdatedNote({ plans }, outdated) {
  const holding = plans.filter(({ robot }) => !outdated.has(robot)).length;
  const note = `${grouped(holding)} of ${count(plans.length, "plan")} still hold.`;
  return element(
    "div",
    { class: "badges" },
    badge("Outdated", "fair", PART, "The request was edited after planning"),
    element("p", { class: "facts", textContent: `${note} Plan again, or undo the edits.` }),
  );
}

function badge(text, tone, path, title = "") {
  return element("span", { class: `badge ${tone}`, title }, path ? icon(path) : null, text);
}

function figure(name, value, ...notes) {
  const small = notes.filter((note) => note !== "").map((textContent) => element("small", { textContent }));
  return element("div", {}, element("dt", { textContent: name }), element("dd", {}, value, ...small));
}

function bound(value, least) {
  if (!(least > 0)) return [];
  return [`lower bound ${seconds(least)}`, `${(value / least).toFixed(2)} × lower bound`];
}

function warningList(warnings) {
  const texts = warnings.map((warning) =>
    typeof warning === "string" ? warning : (warning.detail ?? JSON.stringify(warning)),
  );
  return element(
    "ul",
    { class: "warnings", "aria-label": "Warnings" },
    ...texts.map((textContent) => element("li", { textContent })),
  );
}
