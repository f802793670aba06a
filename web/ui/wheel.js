// How far a wheel was turned, as scrolling and as zooming. CSS pixels.

const LINE = 16; // pixels
const MOST = 240; // pixels of one event of the wheel that zoom

/** How far an event of the wheel scrolls: {across, down}. */
export function wheelTravel({ deltaX, deltaY, deltaMode }) {
  const unit = deltaMode === WheelEvent.DOM_DELTA_LINE ? LINE : 1;
  return { across: deltaX * unit, down: deltaY * unit };
}

/** The factor that an event of the wheel zooms by, above 1 to show less. `gain`: what a pixel adds to its logarithm. */
export function wheelFactor(event, gain) {
  const { down } = wheelTravel(event);
  return Math.exp(-Math.max(-MOST, Math.min(MOST, down)) * gain);
}
