// Pointer, wheel and pinch on the scene, as camera movements. Positions in CSS pixels within the element.

import { wheelFactor } from "../ui/input.js";

const CLICK_SLACK = 4; // pixels: a press that moved less is a click
const TOUCH_SLACK = 10; // pixels, likewise: a second finger may follow to pinch
const WHEEL_GAIN = 0.002; // see wheelFactor
const PINCH_GAIN = 0.01; // likewise, of two fingers on a touchpad, which come with ctrlKey

const slackOf = ({ pointerType }) => (pointerType === "touch" ? TOUCH_SLACK : CLICK_SLACK);

/**
 * Watches an element. `handlers` has: pan(dx, dy, whether one finger swipes), zoom(pixel, factor), hover(pixel or null), click(pixel);
 * and for presses that are not about the camera: press(pixel, event), which returns whether to capture the
 * pointer, then drag(pixel, event) once it has moved too far for a click, and release(pixel, event), or
 * abort() when a second finger makes it a pinch. The middle button is always about the camera.
 */
export function watchGestures(element, handlers) {
  const pressed = new Map(); // pointer id -> last position
  let travelled = 0;
  let held = null; // the id of the pointer that is not about the camera

  const within = (event) => {
    const box = element.getBoundingClientRect();
    return { x: event.clientX - box.left, y: event.clientY - box.top };
  };

  element.addEventListener("pointerdown", (event) => {
    if (event.button > 1) return;
    element.setPointerCapture(event.pointerId);
    if (held !== null) {
      held = null;
      handlers.abort();
    }
    if (pressed.size === 0) {
      travelled = 0;
      if (event.button === 0 && handlers.press(within(event), event)) held = event.pointerId;
    }
    pressed.set(event.pointerId, within(event));
  });

  element.addEventListener("pointermove", (event) => {
    const now = within(event);
    const before = pressed.get(event.pointerId);
    if (!before) {
      if (event.pointerType === "mouse") handlers.hover(now);
      return;
    }
    travelled += Math.hypot(now.x - before.x, now.y - before.y);
    if (held === event.pointerId) {
      pressed.set(event.pointerId, now);
      if (travelled > slackOf(event)) handlers.drag(now, event);
      return;
    }
    if (pressed.size === 1) {
      const isSwipe = event.pointerType === "touch";
      if (travelled > slackOf(event)) handlers.pan(now.x - before.x, now.y - before.y, isSwipe);
    } else if (pressed.size === 2) {
      const [other] = [...pressed].filter(([id]) => id !== event.pointerId).map(([, position]) => position);
      pinch(other, before, now);
    }
    pressed.set(event.pointerId, now);
  });

  /** One finger rests at `other`, one moved: half of the motion pans, the change of the distance zooms. */
  function pinch(other, before, now) {
    handlers.pan((now.x - before.x) / 2, (now.y - before.y) / 2);
    const apart = Math.hypot(before.x - other.x, before.y - other.y);
    if (apart < 1) return;
    const middle = { x: (now.x + other.x) / 2, y: (now.y + other.y) / 2 };
    handlers.zoom(middle, Math.hypot(now.x - other.x, now.y - other.y) / apart);
  }

  element.addEventListener("pointerup", (event) => {
    const known = pressed.delete(event.pointerId);
    if (held === event.pointerId) {
      held = null;
      handlers.release(within(event), event);
    } else if (known && event.button === 0 && pressed.size === 0 && travelled <= slackOf(event)) {
      handlers.click(within(event), event);
    }
  });
  element.addEventListener("pointercancel", (event) => {
    pressed.delete(event.pointerId);
    if (held !== event.pointerId) return;
    held = null;
    handlers.abort();
  });
  element.addEventListener("pointerleave", ({ pointerType }) => {
    if (pointerType === "mouse") handlers.hover(null); // fingers leave after each touch
  });
  element.addEventListener("touchend", (event) => {
    if (!event.cancelable) return; // the page scrolls
    event.preventDefault(); // the browser's click would meet what has moved under the finger since
    if (element.tabIndex >= 0) element.focus({ preventScroll: true });
  });
  element.addEventListener("mousedown", (event) => {
    if (event.button === 1) event.preventDefault(); // browsers would begin to scroll
  });

  const onWheel = (event) => {
    event.preventDefault();
    handlers.zoom(within(event), wheelFactor(event, event.ctrlKey ? PINCH_GAIN : WHEEL_GAIN));
  };
  element.addEventListener("wheel", onWheel, { passive: false });
}
