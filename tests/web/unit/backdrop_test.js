import assert from "node:assert/strict";
import { test } from "node:test";

import { Backdrop } from "../../../web/scene/backdrop.js";

const PARTS = 5;
const MS_OF_PART = 1; // of the clock

let clock = 0;
let painted = []; // the cameras whose parts were painted

/** A test on that clock, with canvases. */
function pictureTest(name, steps) {
  test(name, (context) => {
    painted = [];
    context.mock.method(performance, "now", () => clock);
    const createElement = () => {
      const canvas = { getContext: () => ({ canvas }) };
      return canvas;
    };
    globalThis.document = /** @type {any} */ ({ createElement });
    try {
      steps();
    } finally {
      Reflect.deleteProperty(globalThis, "document");
    }
  });
}

function* paintOf(camera) {
  for (let part = 0; part < PARTS; part += 1) {
    painted.push(camera.x);
    clock += MS_OF_PART;
    yield;
  }
}

/** Draws the view of a camera at x; returns where the picture was put, and how many parts were painted for it. */
function draw(backdrop, x, moving) {
  const camera = { x, y: 0, scale: 1 };
  const view = { camera, viewport: null, ratio: 1, width: 100, height: 80 };
  const before = painted.length;
  let place = null;
  const context = { fillRect() {}, drawImage: (_, left) => (place = left) };
  backdrop.draw(context, view, { moving, background: "", paint: () => paintOf(camera) });
  return { place, parts: painted.length - before };
}

pictureTest("at rest, the picture is painted at once, and once for each camera", () => {
  const backdrop = new Backdrop();
  assert.deepEqual(draw(backdrop, 0, false), { place: 0, parts: PARTS });
  assert.deepEqual(draw(backdrop, 0, false), { place: 0, parts: 0 });
  assert.deepEqual(draw(backdrop, 7, false), { place: 0, parts: PARTS });
});

pictureTest("while the camera moves, the last picture is moved, and another one painted in parts", () => {
  const backdrop = new Backdrop();
  draw(backdrop, 0, true);
  assert.deepEqual(draw(backdrop, 10, true), { place: -10, parts: 0 }, "the picture is new enough");
  clock += 1000;
  const frames = [11, 12, 13].map((x) => draw(backdrop, x, true));
  assert.ok(
    frames.every(({ parts }) => parts > 0 && parts < PARTS),
    "no frame paints all of it",
  );
  assert.deepEqual(
    frames.map(({ place }) => place),
    [-11, -12, -2],
    "the last one moves the picture of the first",
  );
});

pictureTest("at rest, a picture in parts is given up for that of the camera", () => {
  const backdrop = new Backdrop();
  draw(backdrop, 0, true);
  clock += 1000;
  draw(backdrop, 11, true);
  assert.deepEqual(draw(backdrop, 20, false), { place: 0, parts: PARTS });
  assert.deepEqual(draw(backdrop, 21, true), { place: -1, parts: 0 });
});

pictureTest("another scene is painted at once, also while the camera moves", () => {
  const backdrop = new Backdrop();
  draw(backdrop, 0, true);
  backdrop.drop();
  assert.deepEqual(draw(backdrop, 1, true), { place: 0, parts: PARTS });
});
