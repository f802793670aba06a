// The bar below the scene: play and pause, scrubber, clock, speed, loop. Drives a Player.

import { byId, setText } from "./dom.js";

const KEY_STEP = 0.25; // seconds
const LONG_KEY_STEP = 2; // seconds

export class Transport {
  #player;
  #changed;
  #play = byId("play");
  #restart = byId("restart");
  #scrubber = byId("scrubber");
  #clock = byId("clock");
  #speed = byId("speed");
  #loop = byId("loop");
  #resume = false; // playing was interrupted by dragging the scrubber

  /** `changed` is called after every change that a person made. */
  constructor(player, changed) {
    this.#player = player;
    this.#changed = changed;
    this.#play.addEventListener("click", () => this.toggle());
    this.#restart.addEventListener("click", () => this.restart());
    this.#loop.addEventListener("click", () => this.toggleLoop());
    this.#speed.addEventListener("change", () => {
      player.speed = Number(this.#speed.value);
    });
    this.#scrubber.addEventListener("input", () => this.#seek(Number(this.#scrubber.value)));
    this.#scrubber.addEventListener("pointerdown", () => {
      this.#resume = player.playing;
      player.pause();
      this.#changed();
    });
    this.#scrubber.addEventListener("pointerup", () => this.#release());
    this.#scrubber.addEventListener("pointercancel", () => this.#release());
    this.#scrubber.addEventListener("keydown", (event) => this.#onKey(event));
  }

  toggle() {
    this.#player.toggle();
    this.#changed();
  }

  restart() {
    this.#seek(0);
  }

  toggleLoop() {
    this.#player.loop = !this.#player.loop;
    this.#loop.setAttribute("aria-pressed", String(this.#player.loop));
  }

  /** One step faster (+1) or slower (-1). */
  changeSpeed(step) {
    const { options, selectedIndex } = this.#speed;
    this.#speed.selectedIndex = Math.min(options.length - 1, Math.max(0, selectedIndex + step));
    this.#player.speed = Number(this.#speed.value);
  }

  focusPlay() {
    this.#play.focus({ preventScroll: true });
  }

  /** Shows the player's state. */
  refresh() {
    const { time, duration, playing } = this.#player;
    const idle = duration <= 0;
    for (const control of [this.#play, this.#restart, this.#scrubber]) {
      if (control.disabled !== idle) control.disabled = idle;
    }
    this.#play.classList.toggle("playing", playing);
    this.#play.setAttribute("aria-label", playing ? "Pause" : "Play");
    this.#scrubber.max = String(duration || 1);
    this.#scrubber.value = String(time);
    this.#scrubber.style.setProperty("--share", `${idle ? 0 : (time / duration) * 100}%`);
    this.#scrubber.setAttribute("aria-valuetext", `${time.toFixed(2)} of ${duration.toFixed(2)} seconds`);
    setText(this.#clock, `${time.toFixed(2)} / ${duration.toFixed(2)} s`);
  }

  #release() {
    if (!this.#resume) return;
    this.#resume = false;
    if (this.#player.time < this.#player.duration) this.#player.play();
    this.#changed();
  }

  #seek(time) {
    this.#player.seek(time);
    this.#changed();
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
    this.#seek(targets[event.key]);
  }
}
