// The card of several chosen robots: their figures side by side, and where they are nearest to each other.

import { compareRobots, nearestAmong } from "../model/comparison.js";
import { showMoment } from "../scene/pair_view.js";
import { byId, element } from "../ui/dom.js";
import { count, metres, seconds } from "../ui/format.js";
import { robotChip } from "./robot_list.js";

const MAX = 50; // robots whose nearest approach is computed at once
const COLUMNS = ["Robot", "Cost, s", "Delay", "Drives", "Turns", "Waits", "Distance, m"];

/** `stage`: see Stage; `fleet`: see FleetMotion. */
export function watchChosen(session, stage, fleet) {
  const box = byId("chosen");
  let shown = ""; // the ids and the answer, so that hovering does not build the table again
  let answer = null;
  session.on("answer marks", () => {
    const { chosen } = session;
    if (chosen.join("\n") === shown && session.answer === answer) return;
    shown = chosen.join("\n");
    answer = session.answer;
    box.hidden = chosen.length < 2;
    box.replaceChildren(...(box.hidden ? [] : contentOf(session, stage, fleet, chosen)));
  });
}

function contentOf(session, stage, fleet, chosen) {
  const heading = element("h2", {
    id: "chosen-title",
    textContent: `${count(chosen.length, "robot")} selected`,
  });
  if (session.answer === null) return [heading, element("p", { class: "facts" }, "Plan to compare them.")];
  const table = tableOf(session, compareRobots(chosen, session.tracks));
  const nearest = chosen.length <= MAX ? nearestAmong(chosen, fleet.byId) : null;
  return [heading, table, nearest === null ? "" : nearestButton(session, stage, nearest)];
}

function tableOf(session, rows) {
  const head = COLUMNS.map((textContent) => element("th", { scope: "col", textContent }));
  const body = rows.map(({ id, cost, delay, moving, turning, waiting, distance }) => {
    const figures = [cost, delay, moving, turning, waiting, distance];
    const cells = figures.map((value) => element("td", {}, value === null ? "–" : value.toFixed(1)));
    return element("tr", {}, element("th", { scope: "row" }, robotChip(session, id)), ...cells);
  });
  const table = element(
    "table",
    {},
    element("thead", {}, element("tr", {}, ...head)),
    element("tbody", {}, ...body),
  );
  return element(
    "div",
    { class: "figures-table", tabIndex: 0, role: "region", "aria-label": "Figures" },
    table,
  );
}

function nearestButton(session, stage, { t, gap, ids }) {
  const show = element("button", {
    type: "button",
    class: "quiet",
    textContent: `Nearest: ${ids.join(" and ")}, ${metres(gap)} at ${seconds(t)}`,
  });
  show.addEventListener("click", () => showMoment(session, stage, ids, t));
  return show;
}
