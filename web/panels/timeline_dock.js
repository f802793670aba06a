// The dock of the timeline below the scene: folding, height, the robots that are closest now,
// and the order of the rows.

import { delayOf } from "../model/gantt.js";
import { byId, setText } from "../ui/dom.js";
import { metres } from "../ui/format.js";
import { watchGaps } from "./gaps.js";
import { TimelineChart } from "./timeline_chart.js";
import { TimelineOverview } from "./timeline_overview.js";

const EVERY_MS = 100; // between updates of the text while playing
const HEIGHT = { least: 110, first: 242, step: 24 }; // pixels: how high the body may get; the styles keep the scene larger
const SMALL = "(max-width: 51.25em), (max-height: 43.75em)"; // windows in which the scene needs the room more

export class TimelineDock {
  #session;
  #fleet;
  #toggle = byId("timeline-toggle");
  #body = byId("timeline-body");
  #divider = byId("timeline-divider");
  #sort = byId("timeline-sort");
  #compact = byId("timeline-compact");
  #chart;
  #closest = byId("timeline-closest");
  #least = byId("timeline-least");
  #scroll = byId("timeline-scroll");
  #preferences;
  #small = matchMedia(SMALL);
  #hadPlan = false; // before the first plan, it is folded
  #updated = -Infinity;

  /** See TimelineChart; `show(ids, t)` shows a moment of two robots; `preferences`: see Preferences. */
  constructor(session, colours, fleet, transport, overStrip, show, preferences) {
    this.#session = session;
    this.#fleet = fleet;
    this.#preferences = preferences;
    this.#chart = new TimelineChart(session, colours, fleet, transport, overStrip);
    new TimelineOverview(session, this.#chart, colours);
    this.#compact.addEventListener("click", () => this.#makeCompact());
    this.#toggle.addEventListener("click", () => {
      this.#fold(!this.#body.hidden);
      preferences.set("timelineFolded", this.#body.hidden);
    });
    this.#sort.addEventListener("change", () => this.#chart.sortBy(this.#sort.value));
    this.#least.addEventListener("click", () => show(fleet.least.ids, fleet.least.t));
    watchGaps(session, fleet, this.#chart, show);
    this.#watchDivider();
    this.#fold(true);
    this.#small.addEventListener("change", () => this.#hadPlan && this.#foldAsPreferred());
    session.on("answer", () => {
      if (!this.#hadPlan && session.answer !== null) {
        this.#hadPlan = true;
        this.#foldAsPreferred();
      }
      const known = [...session.tracks.values()].some((track) => delayOf(track) > -Infinity);
      this.#sort.querySelector("[value=delay]").disabled = !known;
      byId("legend-bound").hidden = !known;
    });
    session.on("answer time playback", () => this.#showClosest());
    fleet.onCurve(() => {
      this.#showLeast();
      this.#updated = -Infinity;
      this.#showClosest();
    });
  }

  /** `paint(context, theme, {layout, ids})` paints on top of the chart, see gantt.js. */
  addOverlay(paint) {
    this.#chart.addOverlay(paint);
  }

  /** Paints the chart again. */
  redraw() {
    this.#chart.redraw();
  }

  #makeCompact() {
    const isCompact = this.#compact.getAttribute("aria-pressed") !== "true";
    this.#compact.setAttribute("aria-pressed", String(isCompact));
    this.#chart.compact(isCompact);
  }

  #foldAsPreferred() {
    this.#fold(this.#preferences.get("timelineFolded", this.#small.matches));
  }

  #fold(folded) {
    this.#body.hidden = this.#divider.hidden = folded;
    this.#toggle.setAttribute("aria-expanded", String(!folded));
  }

  #showClosest() {
    const now = performance.now();
    if (this.#session.player.playing && now - this.#updated < EVERY_MS) return;
    this.#updated = now;
    const pair = this.#session.answer === null ? null : this.#fleet.nearestAt(this.#session.player.time);
    const text = pair === null ? "" : `Closest now: ${pair.ids.join(" and ")}, ${metres(pair.gap)}`;
    setText(this.#closest, text);
    this.#closest.title = text; // whole names where there is no room
  }

  #showLeast() {
    const { least } = this.#fleet;
    this.#least.hidden = least === null;
    if (least === null) return;
    setText(this.#least, `Smallest gap ${metres(least.gap)}`);
    this.#least.title = `${least.ids.join(" and ")} at ${least.t.toFixed(2)} s: show that moment`;
  }

  #watchDivider() {
    this.#setHeight(this.#preferences.get("timelineHeight", HEIGHT.first));
    this.#divider.addEventListener("pointerdown", (event) => {
      event.preventDefault();
      this.#divider.setPointerCapture(event.pointerId);
    });
    this.#divider.addEventListener("pointermove", (event) => {
      if (this.#divider.hasPointerCapture(event.pointerId))
        this.#setHeight(this.#body.offsetHeight - event.movementY);
    });
    this.#divider.addEventListener("pointerup", () => this.#keepHeight());
    this.#divider.addEventListener("keydown", (event) => {
      const steps = { ArrowUp: HEIGHT.step, ArrowDown: -HEIGHT.step };
      if (!(event.key in steps)) return;
      event.preventDefault();
      this.#setHeight(this.#body.offsetHeight + steps[event.key]);
      this.#keepHeight();
    });
    new ResizeObserver(() => this.#describeHeight()).observe(this.#body);
  }

  /** Lets the body get so high, if its content is. */
  #setHeight(height) {
    this.#body.style.maxHeight = `${Math.max(HEIGHT.least, height)}px`;
  }

  #keepHeight() {
    this.#preferences.set("timelineHeight", parseFloat(this.#body.style.maxHeight));
  }

  #describeHeight() {
    const now = this.#body.offsetHeight;
    const content = now + this.#scroll.scrollHeight - this.#scroll.clientHeight;
    const values = { now, min: Math.min(HEIGHT.least, content), max: content };
    for (const [name, value] of Object.entries(values)) {
      this.#divider.setAttribute(`aria-value${name}`, String(Math.round(value)));
    }
  }
}
