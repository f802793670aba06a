// Two fingers on a chart, told as zooming along its x axis. Pixels within the chart.

const NEAREST = 16; // pixels: fingers that are nearer than that, above one another, zoom nothing

/**
 * Watches an element. `told(x, factor)`: what is at x stays there and the rest gets larger by the factor, so that
 * under both fingers stays what they took.
 */
export function watchPinching(element, told) {
  const fingers = new Map(); // pointer id -> last x
  const within = (event) => event.clientX - element.getBoundingClientRect().left;

  element.addEventListener("pointerdown", (event) => {
    if (event.pointerType === "touch") fingers.set(event.pointerId, within(event));
  });
  element.addEventListener("pointermove", (event) => {
    const before = fingers.get(event.pointerId);
    if (before === undefined) return;
    const now = within(event);
    fingers.set(event.pointerId, now);
    if (fingers.size !== 2) return;
    const [resting] = [...fingers].filter(([id]) => id !== event.pointerId).map(([, x]) => x);
    const apart = (x) => Math.max(NEAREST, Math.abs(x - resting));
    told(resting, apart(now) / apart(before));
  });
  for (const end of ["pointerup", "pointercancel"]) {
    element.addEventListener(end, (event) => fingers.delete(event.pointerId));
  }
}
