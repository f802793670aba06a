// The overview above the timeline: how many robots move, turn and wait over the whole plan, and the part of it that the
// timeline shows. A press or a drag moves that part there; keys do so in the timeline itself.

import { overviewOf } from "../model/overview.js";
import { byId, contextOf } from "../ui/dom.js";

const HEIGHT = 26; // pixels
const STEP = 2; // pixels a part
const ORDER = ["moving", "turning", "waiting"];

export class TimelineOverview {
  #session;
  #chart;
  #colours;
  #canvas = byId("timeline-overview");
  #sums = /** @type {any} */ (null);
  #width = 0;
  #scheduled = false;

  /** `chart`: see TimelineChart; `colours`: see RobotColours. */
  constructor(session, chart, colours) {
    this.#session = session;
    this.#chart = chart;
    this.#colours = colours;
    new ResizeObserver(() => this.#measure()).observe(this.#canvas);
    session.on("answer", () => this.#reset());
    session.on("time", () => this.#redraw());
    colours.onChange(() => this.#redraw());
    chart.onRange(() => this.#redraw());
    this.#canvas.addEventListener("pointerdown", (event) => {
      this.#canvas.setPointerCapture(event.pointerId);
      this.#go(event);
    });
    this.#canvas.addEventListener("pointermove", (event) => {
      if (this.#canvas.hasPointerCapture(event.pointerId)) this.#go(event);
    });
  }

  #go({ offsetX }) {
    const { left, width } = this.#chart.span;
    const share = Math.min(1, Math.max(0, (offsetX - left) / width));
    this.#chart.showAround(share * this.#session.player.duration);
  }

  #measure() {
    this.#width = this.#canvas.clientWidth;
    this.#reset();
  }

  #reset() {
    this.#sums = null;
    this.#redraw();
  }

  #redraw() {
    if (this.#scheduled || this.#width === 0) return;
    this.#scheduled = true;
    requestAnimationFrame(() => this.#paint());
  }

  #paint() {
    this.#scheduled = false;
    const ratio = window.devicePixelRatio || 1;
    Object.assign(this.#canvas, { width: this.#width * ratio, height: HEIGHT * ratio });
    const { duration, time } = this.#session.player;
    if (duration <= 0) return;
    const context = contextOf(this.#canvas);
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    const { left, width, range } = this.#chart.span;
    const { theme } = this.#colours;
    this.#paintSums(context, theme, left, Math.max(1, Math.floor(width / STEP)));
    const x = (t) => left + (t / duration) * width;
    context.strokeStyle = theme.accent;
    context.lineWidth = 2;
    context.strokeRect(x(range.from) + 1, 1, x(range.to) - x(range.from) - 2, HEIGHT - 2);
    context.fillStyle = theme.ink;
    context.fillRect(x(time) - 1, 0, 2, HEIGHT);
    context.font = `11px ${theme.font}`;
    context.textBaseline = "middle";
    context.fillStyle = theme.muted;
    context.fillText("Whole plan", 8, HEIGHT / 2);
  }

  #paintSums(context, theme, left, parts) {
    const { tracks, player } = this.#session;
    this.#sums ??= overviewOf(tracks.values(), player.duration, parts);
    const most = Math.max(1, tracks.size);
    for (let at = 0; at < parts; at += 1) {
      let y = HEIGHT - 2;
      for (const kind of ORDER) {
        const height = ((this.#sums[kind][at] ?? 0) / most) * (HEIGHT - 4);
        context.fillStyle = theme.states[kind];
        context.fillRect(left + at * STEP, y - height, STEP, height);
        y -= height;
      }
    }
  }
}
