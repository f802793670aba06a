// The travel times of the selected robot to every place: their choice in the menu of the view, the legend, and the time
// at the pointer. For people who move the view by keys, the time in its middle.

import { bandsUpTo, shadeOf } from "../model/travel_field.js";
import { ARROWS } from "../model/placement.js";
import { drawCrosshair } from "../scene/marks.js";
import { byId, element, setText } from "../ui/dom.js";
import { grouped } from "../ui/format.js";

const HOW_TO_READ = "Point at a place to read its time.";

/** `times`: see TravelTimes. */
export function watchTravelTimes(session, stage, times) {
  const choice = /** @type {HTMLInputElement} */ (byId("view-menu").querySelector("input[name=travel]"));
  const card = new TravelCard(session, stage, times);
  choice.addEventListener("change", () => times.switch(choice.checked));
  times.onChange(() => card.show());
}

class TravelCard {
  #session;
  #stage;
  #times;
  #box = byId("travel");
  #state = byId("travel-state");
  #legend = byId("travel-legend");
  #reading = byId("travel-reading");
  /** @type {any} */
  #pointer = null; // {x, y}, metres
  #told = "none"; // the state that was announced

  constructor(session, stage, times) {
    this.#session = session;
    this.#stage = stage;
    this.#times = times;
    stage.onPoint((point) => this.#point(point));
    stage.onPan(() => this.#read());
    stage.canvas.addEventListener("focus", () => this.#read());
    stage.canvas.addEventListener("blur", () => this.#read());
    stage.canvas.addEventListener("keydown", (event) => event.key in ARROWS && this.#tell());
    stage.addOverlay((context, view) => this.#paint(context, view));
  }

  show() {
    const { isOn, field, state } = this.#times;
    this.#box.hidden = !isOn;
    this.#stage.setLook({ travel: isOn && field !== null ? { field } : null });
    if (!isOn) return;
    setText(this.#state, this.#stateInWords());
    this.#legend.replaceChildren(...(field === null ? [] : legendOf(field)));
    this.#read();
    if (state !== this.#told && state !== "computing") this.#session.announce(this.#stateInWords());
    this.#told = state;
  }

  #stateInWords() {
    const { robot, field, state } = this.#times;
    if (robot === null) return "Select a robot to see how long it takes to every place.";
    if (state === "none") return "There is no map.";
    const what = `${robot}, alone, from its start`;
    if (state === "failed") return `${what}: the travel times could not be computed.`;
    const share = field === null ? 0 : Math.floor((100 * field.known) / field.count);
    if (state === "computing") return `${what}: ${share} % computed.`;
    return field.known < field.count ? `${what}; coarse, as more would take long.` : `${what}.`;
  }

  #point(point) {
    this.#pointer = point;
    this.#read();
  }

  get #isByKeys() {
    return this.#pointer === null && this.#stage.canvas.matches(":focus-visible");
  }

  #read() {
    if (this.#times.isOn) setText(this.#reading, this.#timeInWords());
  }

  #timeInWords() {
    const { field } = this.#times;
    if (field === null) return "";
    if (this.#pointer !== null) return timeInWords(field.timeAt(this.#pointer), "the pointer");
    return this.#isByKeys
      ? timeInWords(field.timeAt(this.#stage.middle), "the middle of the view")
      : HOW_TO_READ;
  }

  /** Tells the time in the middle of the view, after a key has moved it. */
  #tell() {
    if (!this.#times.isOn || this.#times.field === null) return;
    this.#pointer = null;
    this.#read();
    this.#session.announce(this.#timeInWords());
  }

  /** Marks the middle of the view as long as its time is read. */
  #paint(context, { viewport, theme }) {
    if (!this.#times.isOn || this.#times.field === null || !this.#isByKeys) return;
    drawCrosshair(context, theme, { x: viewport.width / 2, y: viewport.height / 2 });
  }
}

/** A time of TravelField.timeAt in words. */
export function timeInWords(time, where) {
  if (time === null) return `No place for this robot at ${where}.`;
  if (time.seconds === Infinity) return `No way to ${where}.`;
  return `${time.isNear ? "About " : ""}${grouped(time.seconds.toFixed(1))} s to ${where}.`;
}

/** The entries of a legend: a band of times each, and what has no way. */
function legendOf(field) {
  const { step, count } = bandsUpTo(field.most);
  const inWords = (time) => grouped(Number(time.toPrecision(6)));
  const bands = Array.from({ length: count }, (_, band) =>
    legendEntry(
      `travel-${shadeOf(band, count)}`,
      `${inWords(band * step)} to ${inWords((band + 1) * step)} s`,
    ),
  );
  return field.hasNoWay ? [...bands, legendEntry("no-way", "no way")] : bands;
}

function legendEntry(look, words) {
  return element("li", {}, element("span", { class: `patch ${look}` }), words);
}
