// The clock of a plan: time runs from 0 to the duration at a chosen speed and rests at the end, or starts over.
// Pure: the caller says what the wall clock shows.

export class Player {
  time = 0; // seconds into the plan
  duration = 0; // seconds
  speed = 1; // plan seconds a wall-clock second
  loop = false;
  playing = false;
  #last = null; // wall clock at the last tick, seconds

  /** Takes a plan of the given length, at rest at its start. */
  reset(duration) {
    this.duration = duration;
    this.time = 0;
    this.pause();
  }

  /** Plays; from the start when it was at the end. */
  play() {
    if (this.duration <= 0) return;
    if (this.time >= this.duration) this.time = 0;
    this.playing = true;
    this.#last = null;
  }

  pause() {
    this.playing = false;
    this.#last = null;
  }

  toggle() {
    if (this.playing) this.pause();
    else this.play();
  }

  /** Forgets what the wall clock showed: time that goes by unseen does not count. */
  skip() {
    this.#last = null;
  }

  seek(time) {
    this.time = Math.min(this.duration, Math.max(0, time));
  }

  /** Advances to the wall clock's `now` (seconds). */
  tick(now) {
    if (!this.playing) return;
    const passed = this.#last === null ? 0 : Math.max(0, now - this.#last);
    this.#last = now;
    this.time += passed * this.speed;
    if (this.time < this.duration) return;
    if (this.loop) {
      this.time %= this.duration;
    } else {
      this.time = this.duration;
      this.pause();
    }
  }
}
