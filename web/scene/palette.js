// Colours. The canvas uses the style sheet's custom properties, so that light and dark are decided in one place. Robots
// get hues of equal strength that are readable on both.

import { Signals } from "../model/signals.js";

// Degrees in OKLCH, ordered so that neighbours differ most; red is reserved for errors.
const HUES = [256, 62, 150, 325, 200, 98, 290, 175, 46, 232, 128, 345];
const GOLDEN_ANGLE = 137.508;
const USUAL_FONT = 16; // pixels: the browser's font size that texts of canvases are designed for
const TRAVEL_SHADES = 7; // see shadeOf
const NAMES = ["void", "floor", "wall", "grid", "edge", "ink", "muted", "danger", "accent"];

/** The colour of the robot at an index, as a CSS colour; `lightness` in [0, 1]. */
export function robotColour(index, lightness) {
  const round = Math.floor(index / HUES.length);
  const hue = round === 0 ? HUES[index] : (HUES[index % HUES.length] + round * GOLDEN_ANGLE) % 360;
  const shade = lightness + [0, -0.09, 0.08][round % 3];
  return `oklch(${shade.toFixed(3)} 0.145 ${hue.toFixed(1)})`;
}

/** The states of robots, see robotStateAt, as texts of a legend. */
export const STATES_IN_WORDS = {
  moving: "moving: an arrow",
  turning: "turning: an arc",
  waiting: "waiting: two bars",
  arrived: "arrived: a tick",
  parked: "parked: a square",
  ready: "not planned yet",
  outdated: "outdated by an edit",
  unplanned: "without a plan: a cross",
};

/**
 * The canvas's colours under the present theme; `states` are those of robots by state, `travel` those of travel times,
 * from short to long;
 * `zoom` is how much larger texts are than designed.
 */
export function readTheme() {
  const style = getComputedStyle(document.documentElement);
  const theme = { robotLightness: Number(style.getPropertyValue("--robot-lightness")) };
  for (const name of NAMES) theme[name] = style.getPropertyValue(`--scene-${name}`).trim();
  theme.states = {};
  for (const state of Object.keys(STATES_IN_WORDS))
    theme.states[state] = style.getPropertyValue(`--state-${state}`).trim();
  theme.travel = Array.from({ length: TRAVEL_SHADES }, (_, shade) =>
    style.getPropertyValue(`--travel-${shade}`).trim(),
  );
  theme.font = getComputedStyle(document.body).fontFamily;
  theme.zoom = parseFloat(getComputedStyle(document.documentElement).fontSize) / USUAL_FONT;
  return theme;
}

export class RobotColours {
  #signals = new Signals();
  #theme = readTheme();

  constructor() {
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
      this.#theme = readTheme();
      this.#signals.emit("change");
    });
  }

  /** The colours of the canvas, see readTheme. */
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
