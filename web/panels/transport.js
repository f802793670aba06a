// The bar below the scene: play and pause, steps from event to event, scrubber, clock, speed, loop.

import { eventTimes, nextEvent } from "../model/playback.js";
import { byId, setText } from "../ui/dom.js";
import { count, seconds } from "../ui/format.js";
import { NO_PREFERENCES } from "../ui/preferences.js";

const KEY_STEP = 0.25; // seconds
const LONG_KEY_STEP = 2; // seconds
const SAME = 1e-6; // seconds, as of nextEvent
const MAX_NAMED = 3; // robots that an event is told of
const PER_SECOND = 1e6; // browsers keep 15 digits of a value: of the latest times, these decimals

export class Transport {
  #session;
  #player;
  #play = byId("play");
  #restart = byId("restart");
  #scrubber = byId("scrubber");
  #clock = byId("clock");
  #speed = byId("speed");
  #loop = byId("loop");
  #previous = byId("previous-event");
  #next = byId("next-event");
  #events = new Map(); // event times by robot id, null for all robots
  #resume = false; // playing was interrupted by dragging the scrubber
  #preferences;

  /** `preferences`: see Preferences. */
  constructor(session, preferences = NO_PREFERENCES) {
    this.#session = session;
    this.#player = session.player;
    this.#preferences = preferences;
    this.#speed.value = String(preferences.get("speed", 1));
    this.#player.speed = Number(this.#speed.value) || 1;
    watchHeight(this.#clock.parentElement);
    this.#play.addEventListener("click", () => session.togglePlaying());
    this.#restart.addEventListener("click", () => this.restart());
    this.#previous.addEventListener("click", () => this.step(-1));
    this.#next.addEventListener("click", () => this.step(1));
    this.#loop.addEventListener("click", () => this.toggleLoop());
    this.#speed.addEventListener("change", () => this.#takeSpeed());
    this.#scrubber.addEventListener("input", () => session.seek(Number(this.#scrubber.value)));
    this.#scrubber.addEventListener("pointerdown", () => {
      this.#resume = this.#player.playing;
      session.pause();
    });
    this.#scrubber.addEventListener("pointerup", () => this.#release());
    this.#scrubber.addEventListener("pointercancel", () => this.#release());
    this.#scrubber.addEventListener("keydown", (event) => this.#onKey(event));
    session.on("answer", () => this.#events.clear());
    session.on("answer time playback", () => this.#refresh());
    this.#refresh();
  }

  restart() {
    this.#session.seek(0);
  }

  /** To the next event (+1) or the previous event (-1), of the selected robot if there is one. */
  step(direction) {
    this.#session.pause();
    const times = this.#eventsOf(this.#session.selected);
    this.#session.seek(nextEvent(times, this.#player.time, direction));
    this.#session.announce(`${seconds(this.#player.time)}: ${this.#changesAt(this.#player.time)}`);
  }

  /** What robots do from a time on, in words: the selected one, or those that begin something. */
  #changesAt(time) {
    const { tracks, selected } = this.#session;
    const begins = ({ actions }) => actions.some(({ t_start }) => Math.abs(t_start - time) < SAME);
    const ends = ({ cost }) => cost !== null && Math.abs(cost - time) < SAME;
    const changed = [...tracks].filter(([, track]) => begins(track) || ends(track)).map(([id]) => id);
    const ids = selected !== null && changed.includes(selected) ? [selected] : changed;
    const named = ids.slice(0, MAX_NAMED).map((id) => `${id} ${this.#session.stateOf(id)}`);
    return [...named, ...(ids.length > MAX_NAMED ? [`${ids.length - MAX_NAMED} more`] : [])].join(", ");
  }

  toggleLoop() {
    this.#player.loop = !this.#player.loop;
    this.#loop.setAttribute("aria-pressed", String(this.#player.loop));
  }

  /** One step faster (+1) or slower (-1). */
  changeSpeed(step) {
    const { options, selectedIndex } = this.#speed;
    this.#speed.selectedIndex = Math.min(options.length - 1, Math.max(0, selectedIndex + step));
    this.#takeSpeed();
  }

  #takeSpeed() {
    this.#player.speed = Number(this.#speed.value);
    this.#preferences.set("speed", this.#player.speed);
  }

  focusPlay() {
    this.#play.focus({ preventScroll: true });
  }

  #eventsOf(id) {
    const { tracks } = this.#session;
    const own = tracks.get(id)?.actions.length > 0 ? id : null;
    if (!this.#events.has(own)) {
      this.#events.set(own, eventTimes(own === null ? [...tracks.values()] : [tracks.get(own)]));
    }
    return this.#events.get(own);
  }

  /** Shows the player's state. */
  #refresh() {
    const { time, duration, playing } = this.#player;
    const idle = duration <= 0;
    for (const control of [this.#play, this.#restart, this.#scrubber, this.#previous, this.#next]) {
      if (control.disabled !== idle) control.disabled = idle;
    }
    this.#play.classList.toggle("playing", playing);
    this.#play.setAttribute("aria-label", playing ? "Pause" : "Play");
    this.#scrubber.max = String(scrubberEnd(duration) || 1);
    this.#scrubber.value = String(time);
    this.#scrubber.style.setProperty("--share", `${idle ? 0 : (time / duration) * 100}%`);
    this.#scrubber.setAttribute("aria-valuetext", spoken(time, duration));
    const end = duration.toFixed(2);
    setText(this.#clock, `${time.toFixed(2)} / ${end} s`);
    this.#clock.parentElement.style.setProperty("--digits", String(2 * end.length + 5)); // one width while it plays
  }

  #release() {
    if (!this.#resume) return;
    this.#resume = false;
    if (this.#player.time < this.#player.duration) this.#session.play();
  }

  #onKey(event) {
    const { time, duration } = this.#player;
    const step = event.shiftKey ? LONG_KEY_STEP : KEY_STEP;
    const targets = {
      ArrowRight: time + step,
      ArrowUp: time + step,
      ArrowLeft: time - step,
      ArrowDown: time - step,
      PageUp: time + duration / 10,
      PageDown: time - duration / 10,
      Home: 0,
      End: duration,
    };
    if (!(event.key in targets)) return;
    event.preventDefault();
    this.#session.seek(targets[event.key]);
  }
}

/** A time in words, such as "1 minute 5.2 seconds of 2 minutes 0.0 seconds". */
function spoken(time, duration) {
  const words = (value) => {
    const tenths = Math.round(value * 10);
    const minutes = Math.floor(tenths / 600);
    const rest = `${((tenths % 600) / 10).toFixed(1)} seconds`;
    return minutes === 0 ? rest : `${count(minutes, "minute")} ${rest}`;
  };
  return duration > 0 ? `${words(time)} of ${words(duration)}` : "no plan yet";
}

/** Tells the styles how high the player is, above which cards open. */
function watchHeight(player) {
  new ResizeObserver(() => {
    document.documentElement.style.setProperty("--player-height", `${player.offsetHeight}px`);
  }).observe(player);
}

/** The end of the scrubber: not before the duration (seconds), however the browser rounds a value. */
export function scrubberEnd(duration) {
  return Math.ceil(duration * PER_SECOND) / PER_SECOND;
}
