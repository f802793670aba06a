import assert from "node:assert/strict";
import { test } from "node:test";

import { opacityOfHeat } from "../../../web/scene/heat_map.js";
import { pathLine } from "../../../web/scene/draw.js";

test("the paths of more than a hundred robots are fainter, the more the fainter, and never invisible", () => {
  assert.equal(pathLine(100).alpha, pathLine(1).alpha);
  assert.ok(pathLine(200).alpha < pathLine(101).alpha);
  assert.ok(pathLine(1e6).alpha >= 0.05);
});

test("heat is the stronger the more there is, and nothing where there is none", () => {
  assert.equal(opacityOfHeat(0, 5), 0);
  assert.ok(opacityOfHeat(0.1, 5) > 0.1);
  assert.ok(opacityOfHeat(5, 5) > opacityOfHeat(2, 5));
});
