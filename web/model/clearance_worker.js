// Works the clearance out beside the page, which so never stutters: takes motions, answers clearanceOf them.

import { clearanceOf } from "./clearance.js";

addEventListener("message", ({ data }) => {
  const curve = clearanceOf(data);
  const buffers = curve ? [curve.t, curve.gap, curve.first, curve.second].map(({ buffer }) => buffer) : [];
  postMessage(curve, { transfer: buffers });
});
