// A player that is driven by the screen's frames, one asked for at a time, while it plays.

export class Playback {
  #player;
  #nextFrame;
  #told;
  #ticking = false; // a frame is on its way

  /** `nextFrame` calls back with the wall clock, milliseconds; `told` has moved() and ended(). */
  constructor(player, nextFrame, told) {
    this.#player = player;
    this.#nextFrame = nextFrame;
    this.#told = told;
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
      this.#told.moved();
      if (this.#player.playing) this.#tick();
      else this.#told.ended();
    });
  }
}
