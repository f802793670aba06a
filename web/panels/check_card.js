// The service's check of the plan shown: valid, or its violations. Pressing a violation shows
// it.

import { kindInWords } from "../model/checks.js";
import { showMoment } from "../scene/pair_view.js";
import { byId, element, icon } from "../ui/dom.js";
import { count, metres, seconds } from "../ui/format.js";

const TICK = "M4.5 10.5 8.5 14.5 15.5 6";
const CROSS = "M5 5 15 15M15 5 5 15";
const MAX = 100; // violations to list
const DISTANCES = {
  robot_collision: "between their centres",
  obstacle_collision: "from its centre to the wall",
};

/** Checks the session's plan on demand and shows the result. `stage`: see Stage. */
export function watchCheck(session, stage) {
  const button = byId("check-plan");
  button.addEventListener("click", async () => {
    button.disabled = true;
    button.textContent = "Checking…";
    await session.validate();
    button.textContent = "Check plan";
    button.disabled = false;
  });
  session.on("answer", () => (byId("checking").hidden = session.answer === null));
  session.on("check", () => showCheck(session, stage));
}

function showCheck(session, stage) {
  const box = byId("check");
  const { check } = session;
  box.hidden = check === null;
  box.replaceChildren();
  if (check === null) return;
  box.className = `card check ${check.valid ? "good" : "bad"}`;
  const gap = check.min_clearance;
  const nearest = gap === null ? "" : ` The smallest gap between two robots is ${metres(gap)}.`;
  const total = check.violations_total ?? check.violations.length;
  const title = check.valid ? "Valid" : `Not valid: ${count(total, "violation")}`;
  box.append(
    element("h2", {}, icon(check.valid ? TICK : CROSS), title),
    element("p", {
      textContent: check.valid
        ? `The service checked every motion in continuous time and found no violation.${nearest}`
        : nearest.trim(),
    }),
  );
  if (!check.valid) box.append(violationList(check.violations, total, session, stage));
  session.announce(box.querySelector("h2").textContent);
}

function violationList(violations, total, session, stage) {
  const list = element("ol", { class: "violations" });
  for (const violation of violations.slice(0, MAX)) {
    list.append(element("li", {}, violationButton(violation, session, stage)));
  }
  const more = total - Math.min(violations.length, MAX);
  if (more > 0) list.append(element("li", { textContent: `and ${count(more, "more", "more")}` }));
  return list;
}

function violationButton({ kind, robots, t, distance, required, detail }, session, stage) {
  const names = robots.map((id) => element("span", { class: "robot-name", textContent: id }));
  const button = element(
    "button",
    { type: "button", class: "violation", "data-kind": kind },
    element("span", { class: "violation-kind", textContent: kindInWords(kind) }),
    element("span", { class: "violation-time", textContent: seconds(t) }),
    element("span", { class: "violation-robots" }, ...names),
    kind in DISTANCES
      ? element("span", {
          textContent: `${metres(distance)} ${DISTANCES[kind]}, ${metres(required)} required`,
        })
      : null,
    element("span", { class: "violation-detail", textContent: detail }),
  );
  button.addEventListener("click", () => {
    showMoment(session, stage, robots, t);
  });
  return button;
}
