// Small charts. Each has its figures in words for screen readers. Sizes in CSS pixels.

import { change, percent } from "../model/simulation.js";
import { element, svgElement } from "../ui/dom.js";

const WIDTH = 320;
const ROW = 20;
const NAME = 96;
const RIGHT = 8;
const BAND = 8; // the height of a bar

/** A share as a bar with its words. */
export function shareBar(label, share, words) {
  const bar = element("div", { class: "share-bar", role: "img", "aria-label": `${label}: ${words}` });
  const part = element("span", { class: "share-part" });
  part.style.width = `${share * 100}%`;
  bar.append(part);
  return element(
    "div",
    {},
    element("p", { class: "share-words" }, element("b", { textContent: words }), ` ${label}`),
    bar,
  );
}

/**
 * Quantiles as rows: {name, p10, p50, p90, max}. A thin line reaches the maximum, a band goes from p10 to p90, and a
 * tick marks p50. `inWords(value)` formats a figure.
 */
export function quantileRows(title, rows, inWords) {
  const most = Math.max(...rows.map(({ max }) => max), 1e-9);
  const x = (value) => NAME + (Math.max(0, value) / most) * (WIDTH - NAME - RIGHT);
  const height = (rows.length + 1) * ROW;
  const words = rows.map(({ name, p50, p90 }) => `${name} ${inWords(p50)}, ${inWords(p90)}`).join("; ");
  const svg = svgElement("svg", {
    viewBox: `0 0 ${WIDTH} ${height}`,
    class: "quantiles",
    role: "img",
    "aria-label": `${title}, median and 90th percentile: ${words}`,
  });
  rows.forEach(({ name, p10, p50, p90, max }, at) => {
    const middle = at * ROW + ROW / 2;
    svg.append(
      text(name, { x: NAME - 6, y: middle, class: "chart-name" }),
      line(x(p10), x(max), middle, "chart-line"),
      svgElement("rect", {
        x: x(p10),
        y: middle - BAND / 2,
        width: Math.max(1, x(p90) - x(p10)),
        height: BAND,
        class: "chart-band",
      }),
      svgElement("rect", {
        x: x(p50) - 1,
        y: middle - BAND,
        width: 2,
        height: 2 * BAND,
        class: "chart-tick",
      }),
    );
  });
  svg.append(
    text("0", { x: NAME, y: height - ROW / 2, class: "chart-unit" }),
    text(inWords(most), { x: WIDTH - RIGHT, y: height - ROW / 2, class: "chart-name" }),
  );
  return element("figure", { class: "chart" }, element("figcaption", { textContent: title }), svg);
}

/** A line through values at even steps, from 0: `values` may be empty. */
export function lineChart(title, values, inWords) {
  const height = 64;
  const most = Math.max(...values, 1e-9);
  const last = values.at(-1);
  const svg = svgElement("svg", {
    viewBox: `0 0 ${WIDTH} ${height}`,
    class: "quantiles",
    role: "img",
    "aria-label": `${title}: ${last === undefined ? "nothing yet" : `${inWords(last)} now, at most ${inWords(most)}`}`,
  });
  const x = (at) => (at / Math.max(1, values.length - 1)) * WIDTH;
  const y = (value) => height - 4 - (value / most) * (height - 20);
  const points = values.map((value, at) => `${x(at).toFixed(1)},${y(value).toFixed(1)}`);
  svg.append(
    svgElement("polyline", { points: points.join(" "), class: "chart-curve" }),
    text(inWords(most), { x: WIDTH - RIGHT, y: 9, class: "chart-name" }),
  );
  return element("figure", { class: "chart" }, element("figcaption", { textContent: title }), svg);
}

/**
 * What margins cost, {cost, share, isBest}: `share` of executions that go wrong (up) by `cost` (right). A line joins those
 * that are better than all cheaper ones.
 */
export function costCurve(title, points) {
  const [height, left, bottom] = [120, 46, 18];
  const costs = points.map(({ cost }) => cost);
  const [least, most] = [Math.min(...costs), Math.max(...costs)];
  const x = ({ cost }) => left + ((cost - least) / Math.max(1e-9, most - least)) * (WIDTH - left - RIGHT);
  const y = ({ share }) => 6 + (1 - share) * (height - bottom - 12);
  const ordered = [...points].sort((one, other) => one.cost - other.cost);
  const words = ordered.map((point) => `${change(point.cost)}: ${percent(point.share)}`).join("; ");
  const svg = svgElement("svg", {
    viewBox: `0 0 ${WIDTH} ${height}`,
    class: "quantiles",
    role: "img",
    "aria-label": `${title}: ${words}`,
  });
  const better = ordered.filter(({ share }, at) => ordered.slice(0, at).every((each) => each.share > share));
  const corners = better.map((point) => `${x(point).toFixed(1)},${y(point).toFixed(1)}`);
  svg.append(
    text("100 %", { x: left - 4, y: y({ share: 1 }), class: "chart-name" }),
    text("0 %", { x: left - 4, y: y({ share: 0 }), class: "chart-name" }),
    text(change(least), { x: left, y: height - 7, class: "chart-unit" }),
    text(change(most), { x: WIDTH - RIGHT, y: height - 7, class: "chart-name" }),
    svgElement("polyline", { points: corners.join(" "), class: "chart-curve" }),
    ...ordered.map((point) =>
      svgElement("circle", {
        cx: x(point).toFixed(1),
        cy: y(point).toFixed(1),
        r: point.isBest ? 5 : 3,
        class: point.isBest ? "chart-tick" : "chart-band",
      }),
    ),
  );
  return element("figure", { class: "chart" }, element("figcaption", { textContent: title }), svg);
}

function text(content, attributes) {
  const made = svgElement("text", attributes);
  made.textContent = content;
  return made;
}

const line = (x1, x2, y, name) => svgElement("line", { x1, x2, y1: y, y2: y, class: name });
