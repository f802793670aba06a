// The colour of each robot under the present theme, told again when light and dark change.

import { Signals } from "../model/signal.js";
import { readTheme, robotColour } from "./palette.js";

export class RobotColours {
  #signals = new Signals();
  #theme = readTheme();

  constructor() {
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
      this.#theme = readTheme();
      this.#signals.emit("change");
    });
  }

  /** What the canvas paints with, see readTheme. */
  get theme() {
    return this.#theme;
  }

  /** The colour of the robot at an index of the request. */
  of(index) {
    return robotColour(index, this.#theme.robotLightness);
  }

  onChange(listener) {
    this.#signals.on("change", listener);
  }
}
