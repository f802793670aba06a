// How fast a robot drives and turns over time, as lines with the present moment. Sizes in CSS pixels.

import { greatest, speedLines, speedsAt } from "../model/speeds.js";
import { element, setText, svgElement } from "../ui/dom.js";

const WIDTH = 310;
const HEIGHT = 32;
const EDGE = 2; // above and below the line
const KINDS = {
  drive: { name: "Speed", unit: "m/s", ways: ["ahead", "backwards"] },
  turn: { name: "Turning", unit: "rad/s", ways: ["left", "right"] },
};

export class SpeedChart {
  /** @type {HTMLElement} */
  node;
  #actions;
  #end; // seconds
  #rows; // {kind, figure, now, mark} of what it does at all

  /** The chart of actions with a last one. */
  constructor(actions) {
    this.#actions = actions;
    this.#end = Math.max(actions.at(-1).t_end, 1e-9);
    const lines = speedLines(actions);
    const kinds = Object.keys(KINDS).filter((kind) => greatest(lines[kind]).some((most) => most > 0));
    this.#rows = kinds.map((kind) => this.#row(kind, lines[kind]));
    this.node = element("div", { class: "speeds" }, ...this.#rows.map(({ figure }) => figure));
  }

  /** Marks a time, seconds. */
  show(time) {
    const speeds = speedsAt(this.#actions, time);
    const x = this.#x(time).toFixed(1);
    for (const { kind, now, mark } of this.#rows) {
      setText(now, inWords(speeds[kind], KINDS[kind]));
      mark.setAttribute("x1", x);
      mark.setAttribute("x2", x);
    }
  }

  #x(time) {
    return WIDTH * Math.min(1, Math.max(0, time / this.#end));
  }

  #row(kind, line) {
    const { name, unit, ways } = KINDS[kind];
    const most = greatest(line);
    const range = most[0] + most[1];
    const y = (speed) => EDGE + ((most[0] - speed) / range) * (HEIGHT - 2 * EDGE);
    const bounds = ways.map((way, at) => `at most ${round(most[at])} ${unit} ${way}`);
    const words = bounds.filter((_, at) => most[at] > 0).join(", ");
    const svg = svgElement("svg", {
      viewBox: `0 0 ${WIDTH} ${HEIGHT}`,
      class: "quantiles",
      role: "img",
      "aria-label": `${name} in ${this.#end.toFixed(1)} s: ${words}`,
    });
    const rest = y(0);
    const points = line.map(([t, speed]) => `${this.#x(t).toFixed(1)},${y(speed).toFixed(1)}`);
    const mark = svgElement("line", { y1: 0, y2: HEIGHT, class: "speed-now" });
    svg.append(
      svgElement("line", { x1: 0, x2: WIDTH, y1: rest, y2: rest, class: "chart-line" }),
      svgElement("polyline", { points: points.join(" "), class: `chart-curve ${kind}` }),
      mark,
    );
    const now = element("b");
    const limit = element("span", {
      class: "note",
      textContent: `at most ${round(Math.max(...most))} ${unit}`,
    });
    const figure = element(
      "figure",
      { class: "chart" },
      element("figcaption", {}, `${name} `, now, limit),
      svg,
    );
    return { kind, figure, now, mark };
  }
}

function inWords(speed, { unit, ways }) {
  const [ahead, back] = ways;
  const way = speed === 0 || ahead === "ahead" ? "" : ` ${ahead}`;
  return `${round(Math.abs(speed))} ${unit}${speed < 0 ? ` ${back}` : way}`;
}

const round = (speed) => String(Number(speed.toPrecision(3)));
