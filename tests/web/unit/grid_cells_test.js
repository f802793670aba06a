import assert from "node:assert/strict";
import { test } from "node:test";

import { prepareCells, preparedCells } from "../../../web/model/grid_cells.js";
import { readGrid } from "../../../web/model/scene.js";

const large = (letters) => Array.from({ length: 1000 }, () => letters.repeat(250));

test("a large map is read in pieces before it is drawn, as it would be read at once", async () => {
  const rows = large(".#G@");
  let tasks = 0;
  await prepareCells(rows, async () => (tasks += 1));
  assert.ok(tasks >= 3, `${tasks} tasks`);
  const cells = preparedCells(rows);
  assert.deepEqual(readGrid({ rows: [...rows] }, null).blocked, cells);
  assert.equal(readGrid({ rows }, null).blocked, cells);
});

test("small and faulty maps are not prepared", async () => {
  const nextTask = () => assert.fail("there is no second task");
  const ragged = [...large("."), ".#"];
  for (const rows of [[], ["..#"], ragged, [...large("."), 7]]) {
    await prepareCells(rows, nextTask);
    assert.equal(preparedCells(rows), null);
  }
});
