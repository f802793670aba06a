import assert from "node:assert/strict";
import { test } from "node:test";

import { cornerFor } from "../../../web/panels/inspector.js";

const CARD = { width: 300, height: 200 };
const SCENE = { width: 1000, height: 600 };
const MARGIN = { top: 60, side: 10, bottom: 10 };
const corner = (...points) =>
  cornerFor(
    CARD,
    SCENE,
    MARGIN,
    points.map(([x, y]) => ({ x, y })),
  );

test("a card is placed at the upper right, unless it hides something there", () => {
  assert.equal(corner(), "top-right");
  assert.equal(corner([500, 300], [995, 100], [900, 40], [900, 270]), "top-right");
  assert.equal(corner([900, 100]), "bottom-right");
  assert.equal(corner([900, 100], [900, 500]), "bottom-left");
});

test("if every corner hides something, the one that hides least is used", () => {
  assert.equal(corner([900, 100], [900, 500], [100, 500]), "top-right");
  assert.equal(corner([900, 100], [900, 120], [900, 500], [100, 500], [100, 520]), "bottom-right");
});
