// The timeline's controls for gaps. Gaps are between disks or beyond vicinities. Gaps below a threshold are marked, and
// a button leads from one to the next.

import { spellsBelow } from "../model/clearance.js";
import { byId, setText } from "../ui/dom.js";
import { count } from "../ui/format.js";

/** `fleet`: see FleetMotion; `chart`: see TimelineChart; `show(ids, t)` shows a moment of two robots. */
export function watchGaps(session, fleet, chart, show) {
  const input = byId("gap-threshold");
  const next = byId("gap-next");
  let spells = [];

  const refresh = () => {
    const threshold = input.value === "" || !input.checkValidity() ? null : input.valueAsNumber / 1000;
    spells = threshold === null || fleet.curve === null ? [] : spellsBelow(fleet.curve, threshold);
    chart.setThreshold(threshold);
    next.hidden = threshold === null || fleet.curve === null;
    next.disabled = spells.length === 0;
    setText(next, spells.length === 0 ? "never" : count(spells.length, "time"));
  };
  const vicinity = byId("gap-vicinity");
  const showVicinity = () => {
    const keeps = session.scene.robots.some((robot) => robot.vicinity > 0);
    vicinity.parentElement.hidden = !keeps;
    fleet.beyondVicinity = keeps && vicinity.checked;
  };
  vicinity.addEventListener("change", showVicinity);
  session.on("request", showVicinity);
  input.addEventListener("input", refresh);
  fleet.onCurve(refresh);
  next.addEventListener("click", () => {
    const { time } = session.player;
    const { least } = spells.find((spell) => fleet.curve.t[spell.least] > time + 1e-6) ?? spells[0];
    const { t, ids } = fleet.momentOf(least);
    show(ids, t);
    session.announce(`${ids.join(" and ")} at ${t.toFixed(2)} s`);
  });
}
