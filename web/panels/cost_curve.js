// How the best plan's flowtime has fallen so far, as a small curve.

import { svgElement } from "../ui/dom.js";
import { seconds } from "../ui/format.js";

const WIDTH = 320;
const HEIGHT = 44;
const EDGE = 3;

/** Draws the costs, [{elapsed_ms, flowtime}], up to now; hidden until there are two, as one is no curve. */
export function drawCosts(box, costs, now_ms) {
  box.hidden = costs.length < 2;
  if (box.hidden) return;
  const first = costs[0];
  const last = costs[costs.length - 1];
  const span = Math.max(1, now_ms - first.elapsed_ms);
  const fall = Math.max(1e-9, first.flowtime - last.flowtime);
  const x = (elapsed) => EDGE + ((elapsed - first.elapsed_ms) / span) * (WIDTH - 2 * EDGE);
  const y = (cost) => EDGE + ((first.flowtime - cost) / fall) * (HEIGHT - 2 * EDGE);
  let path = `M${x(first.elapsed_ms)} ${y(first.flowtime)}`;
  for (const { elapsed_ms, flowtime } of costs.slice(1)) path += `H${x(elapsed_ms)}V${y(flowtime)}`;
  path += `H${x(now_ms)}`;
  const svg = svgElement("svg", { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, preserveAspectRatio: "none" });
  svg.append(svgElement("path", { d: path }));
  const share = ((fall / first.flowtime) * 100).toFixed(1);
  const words = `Flowtime fell from ${seconds(first.flowtime)} to ${seconds(last.flowtime)} (−${share} %)`;
  svg.setAttribute("role", "img");
  svg.setAttribute("aria-label", words);
  const caption = document.createElement("p");
  caption.className = "facts";
  caption.textContent = words;
  caption.setAttribute("aria-hidden", "true");
  box.replaceChildren(svg, caption);
}
