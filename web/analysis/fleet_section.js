// Keeping a fleet running: rounds, charts of throughput and latency, and robots that are held.

import { FleetRun, throughput } from "../model/fleet_run.js";
import { robotChip } from "../panels/robot_list.js";
import { ring } from "../scene/marks.js";
import { element, setText } from "../ui/dom.js";
import { count, milliseconds, seconds } from "../ui/format.js";
import { lineChart } from "./charts.js";
import { button, numberPart } from "./fields.js";

const SHOWN = 60; // rounds in the charts
const HELD = { width: 3, alpha: 1, dashes: [] };

export class FleetSection {
  #session;
  #run;
  #period = numberPart("Round length", "s", 2, { min: 0.5, max: 60 });
  #held = numberPart("Hold for", "s", 10, { min: 0.1, max: 10000 });
  #start = button("Run", () => this.#toggle(), { class: "primary" });
  #hold = button("Hold", () => this.#holdSelected());
  #byClick = element("input", { type: "checkbox" });
  #status = element("p", { class: "facts" });
  #total = element("p", { class: "fleet-clock" }); // how long the fleet has run
  #holds = element("ul", { class: "plain" });
  #charts = element("div", { class: "results" });
  #selected = null;

  element;

  /** `page`: see fillAnalysis. */
  constructor({ session, stage, service }) {
    this.#session = session;
    this.#run = new FleetRun(session, service, () => performance.now());
    this.element = element(
      "div",
      { class: "simulation" },
      element("p", {
        class: "facts",
        textContent:
          "Robots shuttle between their goals and starts, round after round. Each round is planned while the previous one is played.",
      }),
      element("div", { class: "parts" }, this.#period.field, this.#held.field),
      element("div", { class: "row" }, this.#start, this.#hold),
      element("label", { class: "choice" }, this.#byClick, "Hold robots by clicking them"),
      this.#total,
      this.#status,
      this.#holds,
      this.#charts,
    );
    this.#run.onChange(() => this.#show());
    session.on("answer", () => this.#refresh());
    session.on("marks", () => this.#onMarks());
    session.on("time", () => this.#run.running && this.#showTotal());
    stage.addOverlay((context, { scale, screen, theme, time }) => {
      for (const { robot } of this.#run.running ? this.#run.holds : []) {
        const radius = session.radiusOf(robot, time) * scale + 5;
        ring(context, screen(session.poseOf(robot, time)), radius, theme.danger, HELD);
      }
    });
    this.#show();
  }

  #toggle() {
    if (this.#run.running) this.#run.stop();
    else if (this.#period.input.reportValidity()) this.#run.start(this.#period.input.valueAsNumber);
  }

  #onMarks() {
    const { selected } = this.#session;
    const isAnother = selected !== this.#selected;
    this.#selected = selected;
    if (isAnother && selected !== null && this.#byClick.checked && this.#run.running) this.#holdSelected();
    this.#refresh();
  }

  #holdSelected() {
    if (!this.#held.input.reportValidity()) return;
    const { selected } = this.#session;
    const duration = this.#held.input.valueAsNumber;
    this.#run.hold(selected, duration);
    this.#session.announce(`${selected} is held for ${seconds(duration)}.`);
  }

  #refresh() {
    const { running } = this.#run;
    const { selected, hasPlan } = this.#session;
    setText(this.#start, running ? "Stop" : "Run");
    this.#start.disabled = !running && !hasPlan;
    this.#hold.disabled = !running || selected === null;
    setText(this.#hold, selected === null ? "Hold" : `Hold ${selected}`);
  }

  #showTotal() {
    const { rounds, running } = this.#run;
    const ended = rounds.reduce((sum, { length }) => sum + length, 0);
    if (!running && ended === 0) return;
    const total = Math.floor(ended + (running ? this.#session.player.time : 0));
    const clock = `${Math.floor(total / 60)}:${String(total % 60).padStart(2, "0")}`;
    setText(this.#total, `In operation for ${clock}`);
  }

  #show() {
    this.#refresh();
    const { rounds, holds } = this.#run;
    const last = rounds.at(-1);
    setText(this.#status, last === undefined ? "" : roundsInWords(rounds.length, last));
    this.#showTotal();
    this.#holds.replaceChildren(
      ...holds.map(({ robot, left }) => {
        const release = button("Release", () => this.#run.hold(robot, 0), { class: "quiet" });
        return element(
          "li",
          { class: "chips" },
          robotChip(this.#session, robot),
          `held, ${left.toFixed(1)} s left`,
          release,
        );
      }),
    );
    if (last === undefined) return;
    const latencies = rounds.map(({ latency }) => latency).slice(-SHOWN);
    this.#charts.replaceChildren(
      lineChart("Goals per minute", throughput(rounds).slice(-SHOWN), (value) => value.toFixed(0)),
      lineChart("Planning time per round", latencies, milliseconds),
    );
  }
}

/** How many rounds have ended, and the robots of the last round that do not get on. */
function roundsInWords(rounds, { unplanned, stuck }) {
  const parts = [
    count(rounds, "round"),
    unplanned > 0 ? `${count(unplanned, "robot")} without a plan` : null,
    stuck > 0 ? `${count(stuck, "robot")} stuck` : null,
  ];
  return parts.filter((part) => part !== null).join(", ");
}
