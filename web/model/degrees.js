// Angles as people type them. Pure.

import { tidy } from "./cells.js";

/** Radians as round degrees; what is no number stays. */
export const degreesOf = (radians) =>
  typeof radians === "number" ? tidy((radians * 180) / Math.PI) : radians;

/** Degrees as radians, not rounded, so that degreesOf them is what was typed; undefined stays. */
export const radiansOf = (degrees) => (degrees === undefined ? degrees : (degrees * Math.PI) / 180);
