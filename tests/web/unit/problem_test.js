import assert from "node:assert/strict";
import { test } from "node:test";

import { mapRowOf, partsOf, robotIndexOf } from "../../../web/model/problem.js";

test("a pointer is split and unescaped", () => {
  assert.deepEqual(partsOf("/a~1b/c~0d/~01"), ["a/b", "c~d", "~1"]);
  assert.deepEqual(partsOf(""), []);
});

test("pointers to a robot and into it name its index", () => {
  assert.equal(robotIndexOf("/robots/12"), 12);
  assert.equal(robotIndexOf("/robots/0/start/x"), 0);
  for (const other of ["", "/robots", "/robots/-", "/map/rows/3", "/options"])
    assert.equal(robotIndexOf(other), null);
});

test("pointers to a row of the map name it", () => {
  assert.equal(mapRowOf("/map/rows/7"), 7);
  for (const other of ["", "/map", "/map/rows", "/map/resolution", "/robots/1"])
    assert.equal(mapRowOf(other), null);
});
