// The scale bar of the scene.

import { lengthInWords, scaleBar } from "../model/scale.js";

const MAX = 110; // pixels
const MARGIN = 14;
const TICK = 6;

/** Shows the scale in the lower left corner of the scene. */
export function showScale(stage) {
  stage.addOverlay((context, { scale, viewport, theme }) => {
    const { length, pixels } = scaleBar(scale, MAX);
    const base = viewport.height - MARGIN;
    context.save();
    context.strokeStyle = theme.ink;
    context.lineWidth = 1.5;
    context.beginPath();
    context.moveTo(MARGIN, base - TICK);
    context.lineTo(MARGIN, base);
    context.lineTo(MARGIN + pixels, base);
    context.lineTo(MARGIN + pixels, base - TICK);
    context.stroke();
    context.font = `600 ${11.5 * theme.zoom}px ${theme.font}`;
    context.textBaseline = "alphabetic";
    context.textAlign = "left";
    context.lineWidth = 3;
    context.lineJoin = "round";
    context.strokeStyle = theme.void;
    context.strokeText(lengthInWords(length), MARGIN + pixels + 7, base + 1);
    context.fillStyle = theme.ink;
    context.fillText(lengthInWords(length), MARGIN + pixels + 7, base + 1);
    context.restore();
  });
}
