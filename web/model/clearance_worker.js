// A worker that computes clearanceOf the motions it receives, to keep the page responsive.

import { clearanceOf } from "./clearance.js";

addEventListener("message", ({ data }) => {
  const curve = clearanceOf(data, undefined, false);
  const buffers = curve ? [curve.t, curve.gap, curve.first, curve.second].map(({ buffer }) => buffer) : [];
  postMessage(curve, { transfer: buffers });
});
