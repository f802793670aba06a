// The clock of a plan: playing it frame by frame, and stepping from event to event. No DOM; the caller passes
// in the wall clock and the screen's frames.

const SAME = 1e-6; // seconds: actions of two robots that end together are one moment

export class Player {
  time = 0; // seconds into the plan
  duration = 0; // seconds
  speed = 1; // plan seconds a wall-clock second
  loop = false;
  playing = false;
  #last = null; // wall clock at the last tick, seconds

  /** Starts over with a plan of the given duration, paused. */
  reset(duration) {
    this.duration = duration;
    this.time = 0;
    this.pause();
  }

  /** Goes on at the same time in a plan of another duration. */
  extend(duration) {
    this.duration = duration;
    this.time = Math.min(this.time, duration);
  }

  /** Plays; from the start if it was at the end. */
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

  /** Forgets the wall clock: time while the page is hidden does not count. */
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

export class Playback {
  #player;
  #nextFrame;
  #listener;
  #ticking = false; // a frame is requested

  /** `nextFrame` calls back with the wall clock, milliseconds; `listener` has moved() and ended(). */
  constructor(player, nextFrame, listener) {
    this.#player = player;
    this.#nextFrame = nextFrame;
    this.#listener = listener;
  }

  play() {
    this.#player.play();
    if (this.#player.playing) this.#tick();
  }

  #tick() {
    if (this.#ticking) return;
    this.#ticking = true;
    this.#nextFrame((milliseconds) => {
      this.#ticking = false;
      if (!this.#player.playing) return;
      this.#player.tick(milliseconds / 1000);
      this.#listener.moved();
      if (this.#player.playing) this.#tick();
      else this.#listener.ended();
    });
  }
}

/** The time at which the last motion of an answer ends, seconds; 0 without one. */
export function durationOf(answer) {
  const stops = (answer?.unplanned ?? []).map(({ actions }) => actions?.at(-1)?.t_end ?? 0);
  return Math.max(0, ...(answer?.plans ?? []).map(({ cost }) => cost), ...stops);
}

/** The starts and ends of all actions of some tracks, ascending, seconds. */
export function eventTimes(tracks) {
  const times = [];
  for (const { actions } of tracks) for (const { t_start, t_end } of actions) times.push(t_start, t_end);
  times.sort((a, b) => a - b);
  return times.filter((time, at) => at === 0 || time - times[at - 1] > SAME);
}

/** The first of these times after t, or the last before it (direction -1); t itself if there is none. */
export function nextEvent(times, t, direction) {
  const found =
    direction > 0 ? times.find((time) => time > t + SAME) : times.findLast((time) => time < t - SAME);
  return found ?? t;
}
