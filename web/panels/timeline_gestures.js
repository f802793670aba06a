// Gestures on the timeline, by mouse or finger: press, drag and hover to seek, two fingers to zoom.

const TAP_SLACK = 6; // pixels
const NEAREST = 16; // pixels: the least horizontal distance of two fingers that counts

/**
 * Watches the scrolling box of a chart. `chart` has timeAt(x) and robotAt(y), in pixels within the box; they are null
 * where there is none. It also has over(y or null), which is called with the position of the pointer.
 */
export function watchScrubbing(box, session, chart) {
  let pressed = null; // {x, resume, moved} of the current press
  const within = (event) => {
    const { left, top } = box.getBoundingClientRect();
    return { x: event.clientX - left - box.clientLeft, y: event.clientY - top - box.clientTop };
  };

  const seek = (x) => {
    const time = chart.timeAt(x);
    if (time !== null) session.seek(time);
  };

  const point = ({ x, y }) => {
    const id = chart.robotAt(y);
    if (id !== null) session.select(id);
    seek(x);
  };

  box.addEventListener("pointerdown", (event) => {
    if (!event.isPrimary) return release();
    const place = within(event);
    if (event.button !== 0 || place.x >= box.clientWidth) return; // the browser handles the scroll bar
    pressed = { x: place.x, resume: session.player.playing, moved: false };
    if (event.pointerType === "touch") return; // it may become a scroll
    box.setPointerCapture(event.pointerId);
    session.pause();
    point(place);
  });

  box.addEventListener("pointermove", (event) => {
    const place = within(event);
    if (pressed === null) {
      if (event.pointerType === "touch") return;
      session.hover(chart.robotAt(place.y));
      chart.over(place.y);
      return;
    }
    pressed.moved ||= Math.abs(place.x - pressed.x) > TAP_SLACK;
    if (event.pointerType === "touch" && !pressed.moved) return;
    if (session.player.playing) session.pause();
    seek(Math.max(place.x, 0));
  });

  box.addEventListener("pointerup", (event) => {
    if (pressed === null) return;
    if (event.pointerType === "touch" && !pressed.moved) point(within(event));
    release();
  });

  const release = () => {
    const resume = pressed?.resume && session.player.time < session.player.duration;
    pressed = null;
    if (resume) session.play();
  };
  box.addEventListener("pointercancel", release);
  box.addEventListener("pointerleave", () => {
    session.hover(null);
    chart.over(null);
  });
}

/**
 * Watches an element for two fingers. `zoom(x, factor)` scales by the factor around x, so that both fingers
 * stay over the same times.
 */
export function watchPinching(element, zoom) {
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
    zoom(resting, apart(now) / apart(before));
  });
  for (const end of ["pointerup", "pointercancel"]) {
    element.addEventListener(end, (event) => fingers.delete(event.pointerId));
  }
}
