// The overview above the timeline: how many robots move, turn and wait over the whole plan, and the part of it that the
// timeline shows. A press or a drag moves this part there. In the timeline itself, keys move it.

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
  #ground = document.createElement("canvas"); // what stays while the plan plays
  #place = ""; // where and how large it is painted; "" if it is not
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
    colours.onChange(() => this.#reset());
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
    this.#place = "";
    this.#redraw();
  }

  #redraw() {
    if (this.#scheduled || this.#width === 0) return;
    this.#scheduled = true;
    requestAnimationFrame(() => this.#paint());
  }

  #paint() {
    this.#scheduled = false;
    if (this.#width === 0) return; // it was folded meanwhile
    const ratio = window.devicePixelRatio || 1;
    const [width, height] = [Math.round(this.#width * ratio), Math.round(HEIGHT * ratio)];
    if (this.#canvas.width !== width || this.#canvas.height !== height) {
      Object.assign(this.#canvas, { width, height });
    }
    const context = contextOf(this.#canvas);
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.clearRect(0, 0, width, height);
    const { duration, time } = this.#session.player;
    if (duration <= 0) return;
    const { left, width: span, range } = this.#chart.span;
    const place = [left, span, width, height].join();
    if (place !== this.#place) this.#paintGround(ratio);
    this.#place = place;
    context.drawImage(this.#ground, 0, 0);
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    const { theme } = this.#colours;
    const x = (t) => left + (t / duration) * span;
    context.strokeStyle = theme.accent;
    context.lineWidth = 2;
    context.strokeRect(x(range.from) + 1, 1, x(range.to) - x(range.from) - 2, HEIGHT - 2);
    context.fillStyle = theme.ink;
    context.fillRect(x(time) - 1, 0, 2, HEIGHT);
  }

  /** Paints how many robots move, turn and wait. */
  #paintGround(ratio) {
    const { width, height } = this.#canvas;
    Object.assign(this.#ground, { width, height }); // and clears it
    const { tracks, player } = this.#session;
    const context = contextOf(this.#ground);
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    const { left, width: span } = this.#chart.span;
    const { theme } = this.#colours;
    const parts = Math.max(1, Math.floor(span / STEP));
    const sums = overviewOf(tracks.values(), player.duration, parts);
    const most = Math.max(1, tracks.size);
    for (let at = 0; at < parts; at += 1) {
      let y = HEIGHT - 2;
      for (const kind of ORDER) {
        const tall = ((sums[kind][at] ?? 0) / most) * (HEIGHT - 4);
        context.fillStyle = theme.states[kind];
        context.fillRect(left + at * STEP, y - tall, STEP, tall);
        y -= tall;
      }
    }
    context.font = `${11 * theme.zoom}px ${theme.font}`;
    context.textBaseline = "middle";
    context.fillStyle = theme.muted;
    context.fillText("Whole plan", 8, HEIGHT / 2);
  }
}
