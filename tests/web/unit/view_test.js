import assert from "node:assert/strict";
import { test } from "node:test";

import { fit, keepInSight, panBy, scaleLimits, toScreen, toWorld, zoomAt } from "../../../web/scene/view.js";

const VIEWPORT = { width: 800, height: 600 };
const CAMERA = { x: 10, y: 20, scale: 40 };
const LIMITS = { min: 1, max: 1000 };
const INSETS = { left: 20, top: 60, right: 20, bottom: 40 };
const nearPoint = (actual, x, y) => {
  assert.ok(Math.hypot(actual.x - x, actual.y - y) < 1e-9, `(${actual.x}, ${actual.y}) is not (${x}, ${y})`);
};

test("the camera's point is in the middle, x goes right and y goes up", () => {
  nearPoint(toScreen(CAMERA, VIEWPORT, { x: 10, y: 20 }), 400, 300);
  nearPoint(toScreen(CAMERA, VIEWPORT, { x: 11, y: 20 }), 440, 300);
  nearPoint(toScreen(CAMERA, VIEWPORT, { x: 10, y: 21 }), 400, 260);
});

test("world and screen are inverse to each other", () => {
  for (const pixel of [
    { x: 0, y: 0 },
    { x: 800, y: 600 },
    { x: 123.25, y: 456.75 },
  ]) {
    const back = toScreen(CAMERA, VIEWPORT, toWorld(CAMERA, VIEWPORT, pixel));
    nearPoint(back, pixel.x, pixel.y);
  }
});

test("a fitted map touches two opposite insets and lies within all of them", () => {
  for (const bounds of [
    { left: -3, bottom: 5, right: 97, top: 15 },
    { left: 100, bottom: -50, right: 110, top: 350 },
  ]) {
    const camera = fit(bounds, VIEWPORT, INSETS);
    const upper = toScreen(camera, VIEWPORT, { x: bounds.left, y: bounds.top });
    const lower = toScreen(camera, VIEWPORT, { x: bounds.right, y: bounds.bottom });
    const spare = [upper.x - 20, upper.y - 60, 780 - lower.x, 560 - lower.y];
    assert.ok(
      spare.every((pixels) => pixels > -1e-9),
      String(spare),
    );
    assert.ok(Math.abs(spare[0] - spare[2]) < 1e-9 && Math.abs(spare[1] - spare[3]) < 1e-9, String(spare));
    assert.ok(Math.min(spare[0], spare[1]) < 1e-9, String(spare));
  }
});

test("zooming keeps the world point under the pointer", () => {
  const pixel = { x: 650, y: 130 };
  const before = toWorld(CAMERA, VIEWPORT, pixel);
  for (const factor of [0.25, 1.5, 8]) {
    const zoomed = zoomAt(CAMERA, VIEWPORT, pixel, factor, LIMITS);
    assert.equal(zoomed.scale, 40 * factor);
    nearPoint(toWorld(zoomed, VIEWPORT, pixel), before.x, before.y);
  }
});

test("zooming stops at the limits", () => {
  assert.equal(zoomAt(CAMERA, VIEWPORT, { x: 0, y: 0 }, 1e6, LIMITS).scale, 1000);
  assert.equal(zoomAt(CAMERA, VIEWPORT, { x: 0, y: 0 }, 1e-6, LIMITS).scale, 1);
});

test("the limits always admit the fitted scale", () => {
  const bounds = { left: 0, bottom: 0, right: 0.5, top: 0.5 };
  const { scale } = fit(bounds, VIEWPORT, INSETS);
  const { min, max } = scaleLimits(scale, 0.5);
  assert.ok(min < scale && scale <= max);
});

test("panning moves what is seen by as many pixels", () => {
  const moved = panBy(CAMERA, 30, -12);
  nearPoint(toScreen(moved, VIEWPORT, { x: 10, y: 20 }), 430, 288);
});

test("the map cannot be moved out of view", () => {
  const bounds = { left: 0, bottom: 0, right: 8, top: 6 };
  assert.deepEqual(keepInSight({ x: -5, y: 99, scale: 2 }, bounds), { x: 0, y: 6, scale: 2 });
  assert.deepEqual(keepInSight({ x: 3, y: 4, scale: 2 }, bounds), { x: 3, y: 4, scale: 2 });
});
