import assert from "node:assert/strict";
import { test } from "node:test";

import { heatOf } from "../../../web/model/heat.js";
import { overviewOf } from "../../../web/model/overview.js";
import { readGrid } from "../../../web/model/scene.js";

const at = (x, y) => ({ x, y, theta: 0 });
const wait = (t_start, t_end, where, goal) => ({
  type: "wait",
  t_start,
  t_end,
  from: where,
  to: where,
  goal,
});
const drive = (t_start, t_end, from, to) => ({ type: "translate", t_start, t_end, from, to });
const GRID = readGrid({ rows: ["....", "...."], resolution: 1, origin: { x: 10, y: 0 } }, null);

test("waits are summed in the square where robots wait, without services", () => {
  const here = at(11.5, 1.5);
  const tracks = [
    { actions: [wait(0, 2, here), wait(2, 9, here, 0)] },
    { actions: [drive(0, 1, at(10.5, 0.5), here), wait(1, 1.5, here)] },
  ];
  const { columns, rows, values, most } = heatOf(GRID, tracks, "waiting");
  assert.deepEqual([columns, rows, most], [4, 2, 2.5]);
  assert.deepEqual([...values], [0, 2.5, 0, 0, 0, 0, 0, 0]);
});

test("each robot counts once in every square that it passes", () => {
  const there = [drive(0, 3, at(10.5, 0.5), at(13.5, 0.5)), drive(3, 6, at(13.5, 0.5), at(10.5, 0.5))];
  const tracks = [{ actions: there }, { actions: [drive(0, 1, at(12.5, 0.5), at(12.5, 1.5))] }];
  assert.deepEqual([...heatOf(GRID, tracks, "passage").values], [0, 0, 1, 0, 1, 1, 2, 1]);
});

test("large maps have larger squares, and what is off the map does not count", () => {
  const large = readGrid({ rows: Array(2000).fill(".".repeat(1000)), resolution: 0.05 }, null);
  const { columns, rows, size, most } = heatOf(large, [{ actions: [wait(0, 1, at(-1, 0))] }], "waiting");
  assert.deepEqual([columns, rows, most], [90, 180, 0]);
  assert.ok(Math.abs(size - 100 / 180) < 1e-9);
});

test("an overview has what robots do on average in each part of the plan", () => {
  const tracks = [
    { actions: [wait(0, 1, at(0, 0)), drive(1, 4, at(0, 0), at(3, 0))] },
    { actions: [drive(0, 2, at(0, 1), at(2, 1))] },
  ];
  const { moving, waiting, turning } = overviewOf(tracks, 4, 2);
  assert.deepEqual(
    [[...moving], [...waiting], [...turning]],
    [
      [1.5, 1],
      [0.5, 0],
      [0, 0],
    ],
  );
  assert.equal(overviewOf(tracks, 0, 3).moving.length, 3);
});
