// The timeline's chart on the page: scrolling, zooming, pointing and keys. The picture is
// painted when its content changes; during playback only the playhead moves.

import { orderRows, panTime, revealTime, rowAt, scrollToRow, timeAt, xOf, zoomTime } from "../model/gantt.js";
import { Signals } from "../model/signals.js";
import { byId, contextOf } from "../ui/dom.js";
import { seconds } from "../ui/format.js";
import { wheelFactor, wheelTravel } from "../ui/input.js";
import { AXIS, paintGantt, STRIP } from "./gantt_painter.js";
import { watchPinching, watchScrubbing } from "./timeline_gestures.js";

const LABELS = { wide: 132, narrow: 108 }; // pixels for the robots' names
const NARROW = 560; // pixels
const RIGHT = 10; // pixels kept free at the right
const ROW = { fine: 20, coarse: 28, compact: 6 }; // pixels; coarse for fingers
const KEY_ZOOM = 1.5;
const WHEEL_GAIN = 0.005; // see wheelFactor

export class TimelineChart {
  #session;
  #colours;
  #fleet;
  #transport;
  #box = byId("timeline-scroll");
  #canvas = byId("timeline-canvas");
  #playhead = byId("timeline-playhead");
  #rows = byId("timeline-rows");
  #usualHeight = matchMedia("(pointer: coarse)").matches ? ROW.coarse : ROW.fine;
  #rowHeight = this.#usualHeight;
  #signals = new Signals();
  #sortedBy = "listed";
  /** @type {number | null} */
  #threshold = null;
  #ids = []; // row by row
  #range = { from: 0, to: 0 };
  #size = { clientWidth: 0, clientHeight: 0 }; // of the box, kept to avoid a layout in each frame; of the chart, see #zoom
  #scroll = 0;
  #scheduled = false;
  #overlays = [];
  #revealed = null; // the selected robot whose row was revealed last

  /**
   * `fleet`: see FleetMotion; `transport`: see Transport. `overStrip(whether)` is called as the pointer
   * enters and leaves the curve of the smallest gap.
   */
  constructor(session, colours, fleet, transport, overStrip) {
    this.#session = session;
    this.#colours = colours;
    this.#fleet = fleet;
    this.#transport = transport;
    new ResizeObserver(() => this.#measure()).observe(this.#box);
    session.on("answer", () => this.#show());
    session.on("time", () => this.#follow());
    session.on("time playback", () => session.player.playing || this.#describe());
    session.on("marks", () => this.#mark());
    colours.onChange(() => this.#repaint());
    fleet.onCurve(() => this.#repaint());
    this.#box.addEventListener("scroll", () => this.#measure());
    this.#box.addEventListener("wheel", (event) => this.#onWheel(event), { passive: false });
    this.#box.addEventListener("keydown", (event) => this.#onKey(event));
    this.#box.addEventListener("dblclick", () => this.#setRange({ from: 0, to: session.player.duration }));
    watchPinching(this.#box, (x, factor) => this.#zoomTime(this.#timeAt(x), factor));
    watchScrubbing(this.#box, session, {
      timeAt: (x) => (x < this.#layout().left * this.#zoom ? null : this.#timeAt(x)),
      robotAt: (y) => this.#ids[rowAt(this.#layout(), y / this.#zoom)] ?? null,
      over: (y) => overStrip(y !== null && y < STRIP * this.#zoom),
    });
  }

  /** `paint(context, theme, {layout, ids})` paints on top, see gantt.js. */
  addOverlay(paint) {
    this.#overlays.push(paint);
    this.redraw();
  }

  /** Paints with the next frame. */
  redraw() {
    this.#repaint();
  }

  /** Makes the rows thin, or as high as usual. */
  compact(isCompact) {
    this.#rowHeight = isCompact ? ROW.compact : this.#usualHeight;
    this.#order();
    this.#repaint();
  }

  /** Where its time is: {left, width} in pixels and {range} in seconds. */
  get span() {
    const { left, width, range } = this.#layout();
    return { left: left * this.#zoom, width: width * this.#zoom, range };
  }

  /** `listener` is called when another range of time is shown. */
  onRange(listener) {
    this.#signals.on("range", listener);
  }

  /** Moves the range of time so that a moment is in its middle. */
  showAround(t) {
    const shift = t - (this.#range.from + this.#range.to) / 2;
    this.#setRange(panTime(this.#range, this.#session.player.duration, shift));
  }

  /** Marks gaps below a threshold, metres; null: none. */
  setThreshold(threshold) {
    this.#threshold = threshold;
    this.#repaint();
  }

  /** Sorts the rows: "listed", "start", "cost" or "delay". */
  sortBy(key) {
    this.#sortedBy = key;
    this.#order();
    this.#repaint();
  }

  #show() {
    this.#range = { from: 0, to: this.#session.player.duration };
    this.#order();
    this.#describe();
    this.#repaint();
  }

  #order() {
    this.#ids = orderRows(this.#session.scene.robots, this.#session.tracks, this.#sortedBy);
    this.#rows.style.height = `${(STRIP + AXIS + this.#ids.length * this.#rowHeight) * this.#zoom}px`;
  }

  /** The chart has pixels of its own, which grow with the browser's font size: so many of the page. */
  get #zoom() {
    return this.#colours.theme.zoom;
  }

  /** The time at a distance from the left of the box, pixels of the page. */
  #timeAt(x) {
    return timeAt(this.#layout(), x / this.#zoom);
  }

  #measure() {
    const { clientWidth, clientHeight, scrollTop } = this.#box;
    this.#size = { clientWidth: clientWidth / this.#zoom, clientHeight: clientHeight / this.#zoom };
    this.#scroll = scrollTop / this.#zoom;
    this.#repaint();
  }

  #layout() {
    const { clientWidth, clientHeight } = this.#size;
    const left = clientWidth < NARROW ? LABELS.narrow : LABELS.wide;
    const top = STRIP + AXIS;
    return {
      left,
      width: Math.max(1, clientWidth - left - RIGHT),
      top,
      height: Math.max(0, clientHeight - top),
      rowHeight: this.#rowHeight,
      scroll: this.#scroll,
      rows: this.#ids.length,
      range: this.#range,
    };
  }

  // Painting

  #repaint() {
    if (this.#scheduled) return;
    this.#scheduled = true;
    requestAnimationFrame(() => this.#paint());
  }

  #paint() {
    this.#scheduled = false;
    const { clientWidth, clientHeight } = this.#size;
    if (clientHeight === 0) return;
    const zoom = this.#zoom;
    const ratio = (window.devicePixelRatio || 1) * zoom;
    const [width, height] = [Math.round(clientWidth * ratio), Math.round(clientHeight * ratio)];
    if (this.#canvas.width !== width || this.#canvas.height !== height) {
      Object.assign(this.#canvas, { width, height });
      this.#canvas.style.width = `${clientWidth * zoom}px`;
      this.#canvas.style.height = `${clientHeight * zoom}px`;
    }
    const context = contextOf(this.#canvas);
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    const layout = this.#layout();
    paintGantt(context, {
      layout,
      ids: this.#ids,
      session: this.#session,
      colours: this.#colours,
      curve: this.#fleet.curve,
      beyondVicinity: this.#fleet.beyondVicinity,
      threshold: this.#threshold,
    });
    const { theme } = this.#colours;
    for (const paint of this.#overlays) paint(context, theme, { layout, ids: this.#ids });
    this.#playhead.style.height = `${clientHeight * zoom}px`;
    this.#placePlayhead();
  }

  #placePlayhead() {
    const layout = this.#layout();
    const { time, duration } = this.#session.player;
    const x = xOf(layout, time);
    this.#playhead.hidden = duration <= 0 || x < layout.left - 1 || x > layout.left + layout.width + 1;
    this.#playhead.style.transform = `translateX(${(x * this.#zoom).toFixed(1)}px)`;
  }

  /** Follows the current time: moves the range when the time leaves it. */
  #follow() {
    const { time, duration } = this.#session.player;
    const range = revealTime(this.#range, duration, time);
    if (range !== this.#range) this.#setRange(range);
    else this.#placePlayhead();
  }

  #mark() {
    const { selected } = this.#session;
    if (selected !== this.#revealed) {
      this.#revealed = selected;
      this.#revealRow(this.#ids.indexOf(selected));
      this.#describe();
    }
    this.#repaint();
  }

  #revealRow(row) {
    if (row >= 0) this.#box.scrollTop = scrollToRow(this.#layout(), row) * this.#zoom;
  }

  #describe() {
    const { selected, player } = this.#session;
    const moment = `at ${player.time.toFixed(2)} of ${seconds(player.duration)}`;
    const robot = selected === null ? "no robot selected" : `${selected} ${this.#session.stateOf(selected)}`;
    this.#box.setAttribute("aria-label", `Timeline of ${this.#ids.length} robots: ${robot} ${moment}`);
  }

  // Steering

  #setRange(range) {
    this.#range = range;
    this.#signals.emit("range");
    this.#repaint();
  }

  #zoomTime(anchor, factor) {
    this.#setRange(zoomTime(this.#range, this.#session.player.duration, anchor, factor));
  }

  #onWheel(event) {
    if (event.ctrlKey || event.metaKey) {
      event.preventDefault();
      const x = event.clientX - this.#box.getBoundingClientRect().left;
      this.#zoomTime(this.#timeAt(x), wheelFactor(event, WHEEL_GAIN));
      return;
    }
    const travel = wheelTravel(event);
    const across = event.shiftKey ? travel.down || travel.across : travel.across;
    const down = event.shiftKey ? 0 : travel.down;
    if (Math.abs(across) <= Math.abs(down)) return; // the browser scrolls the rows
    event.preventDefault();
    const shift = (across / this.span.width) * (this.#range.to - this.#range.from);
    this.#setRange(panTime(this.#range, this.#session.player.duration, shift));
  }

  #onKey(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const { player } = this.#session;
    const keys = {
      ArrowUp: () => this.#choose(-1),
      ArrowDown: () => this.#choose(1),
      ArrowLeft: () => this.#step(-1),
      ArrowRight: () => this.#step(1),
      Home: () => this.#goTo(0),
      End: () => this.#goTo(player.duration),
      "+": () => this.#zoomTime(player.time, KEY_ZOOM),
      "=": () => this.#zoomTime(player.time, KEY_ZOOM),
      "-": () => this.#zoomTime(player.time, 1 / KEY_ZOOM),
    };
    if (!(event.key in keys)) return;
    event.preventDefault();
    keys[event.key]();
  }

  /** Selects the robot of the row below (1) or above (-1). */
  #choose(direction) {
    if (this.#ids.length === 0) return;
    const at = this.#ids.indexOf(this.#session.selected);
    const next = at < 0 ? (direction > 0 ? 0 : this.#ids.length - 1) : at + direction;
    this.#session.select(this.#ids[Math.max(0, Math.min(this.#ids.length - 1, next))]);
    this.#announce();
  }

  #step(direction) {
    this.#transport.step(direction);
    this.#announce();
  }

  #goTo(time) {
    this.#session.pause();
    this.#session.seek(time);
    this.#announce();
  }

  #announce() {
    const { selected, player } = this.#session;
    const what = selected === null ? "" : `${selected} ${this.#session.stateOf(selected)}, `;
    this.#session.announce(`${what}${seconds(player.time)}`);
  }
}
