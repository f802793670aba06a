import assert from "node:assert/strict";
import { test } from "node:test";

import { cellAt, cellsAlong, cellsBetween, centreOf } from "../../../web/model/cells.js";
import {
  faultOfSize,
  newMap,
  resize,
  setCells,
  setOrigin,
  setResolution,
} from "../../../web/model/edit_map.js";
import { readScene } from "../../../web/model/scene.js";

const REQUEST = {
  map: { rows: ["#..", ".GT"], resolution: 0.5, origin: { x: 10, y: -2 } },
  robots: [{ id: "a", start: { x: 10.75, y: -1.75 } }],
};
const gridOf = (request) => readScene(request).grid;
const GRID = gridOf({ map: { rows: Array(10).fill(".".repeat(10)) } });
const names = (cells) => cells.map(({ column, row }) => `${column},${row}`);

test("a cell's middle lies in the cell, the top row first", () => {
  const grid = gridOf(REQUEST);
  assert.deepEqual(centreOf(grid, { column: 0, row: 0 }), { x: 10.25, y: -1.25 });
  assert.deepEqual(cellAt(grid, { x: 10.25, y: -1.25 }), { column: 0, row: 0 });
  assert.deepEqual(cellAt(grid, { x: 11.4, y: -1.9 }), { column: 2, row: 1 });
});

test("a cell's middle has no digits that only doubles would add", () => {
  const grid = gridOf({ map: { rows: ["...."], resolution: 0.1 } });
  assert.deepEqual(centreOf(grid, { column: 3, row: 0 }), { x: 0.35, y: 0.05 });
});

test("a line covers all cells that it passes, without a gap", () => {
  const cells = names(cellsAlong(GRID, { x: 0.5, y: 9.5 }, { x: 2.5, y: 8.4 }));
  assert.deepEqual(cells, ["0,0", "1,0", "1,1", "2,1"]);
  const steep = names(cellsAlong(GRID, { x: 2.2, y: 6.1 }, { x: 1.9, y: 9.9 }));
  assert.deepEqual(steep, ["2,3", "2,2", "2,1", "1,1", "1,0"]);
});

test("a line in any direction ends in the cell that it leads to", () => {
  const ends = [
    [9.5, 9.5],
    [0.5, 9.3],
    [9.9, 0.1],
    [4.5, 9.9],
    [0.2, 0.3],
    [9.7, 5.5],
    [5.5, 5.5],
  ];
  for (const [x, y] of ends) {
    const to = { x, y };
    const cells = cellsAlong(GRID, { x: 5.5, y: 5.5 }, to);
    assert.deepEqual(cells.at(-1), cellAt(GRID, to));
    cells.slice(1).forEach((cell, at) => {
      assert.equal(Math.abs(cell.column - cells[at].column) + Math.abs(cell.row - cells[at].row), 1);
    });
  }
});

test("cells outside the map are left out of lines and rectangles", () => {
  assert.deepEqual(names(cellsAlong(GRID, { x: -2.5, y: 0.5 }, { x: 1.5, y: 0.5 })), ["0,9", "1,9"]);
  const corner = cellsBetween(GRID, { column: 1, row: 10 }, { column: -1, row: 8 });
  assert.deepEqual(names(corner), ["0,8", "1,8", "0,9", "1,9"]);
});

test("cells are blocked and freed, and keep their letter if they are so already", () => {
  const all = cellsBetween(gridOf(REQUEST), { column: 0, row: 0 }, { column: 2, row: 1 });
  assert.deepEqual(setCells(REQUEST, all.slice(0, 4), true).map.rows, ["###", "#GT"]);
  assert.deepEqual(setCells(REQUEST, all, true).map.rows, ["###", "##T"]);
  assert.deepEqual(setCells(REQUEST, all, false).map.rows, ["...", ".G."]);
});

test("an edit shares what it does not change and never changes in place", () => {
  const before = structuredClone(REQUEST);
  const edited = setCells(REQUEST, [{ column: 1, row: 0 }], true);
  assert.deepEqual(REQUEST, before);
  assert.equal(edited.robots, REQUEST.robots);
  assert.equal(edited.map.origin, REQUEST.map.origin);
  const blockedOrOutside = [
    { column: 0, row: 0 },
    { column: 7, row: 7 },
  ];
  assert.equal(setCells(REQUEST, blockedOrOutside, true), REQUEST);
});

test("a cell that a short row lacks is drawn as wall and can be freed", () => {
  const request = { map: { rows: [".....", "."] } };
  assert.deepEqual(setCells(request, [{ column: 3, row: 1 }], false).map.rows, [".....", ".##."]);
});

test("a map grows and is cut on each side while all else stays where it is", () => {
  const place = (request, letter) => {
    const grid = gridOf(request);
    const row = grid.lines.findIndex((line) => line.includes(letter));
    return centreOf(grid, { column: grid.lines[row].indexOf(letter), row });
  };
  for (const sides of [
    { left: 2 },
    { right: 1 },
    { top: 3 },
    { bottom: 2 },
    { left: 1, bottom: 1, top: -1 },
  ]) {
    const resized = resize(REQUEST, sides);
    assert.deepEqual(place(resized, "G"), place(REQUEST, "G"), JSON.stringify(sides));
    assert.equal(resized.robots, REQUEST.robots);
  }
  assert.deepEqual(resize(REQUEST, { left: 1, top: 1 }).map.rows, ["....", ".#..", "..GT"]);
  assert.deepEqual(resize(REQUEST, { right: -1, bottom: -1 }).map.rows, ["#."]);
  assert.deepEqual(resize(REQUEST, { left: 1, bottom: 2 }).map.origin, { x: 9.5, y: -3 });
});

test("growing and cutting the same side leads back", () => {
  let request = { map: { rows: ["...."], resolution: 0.1 } };
  for (let time = 0; time < 3; time += 1) request = resize(request, { left: 1, bottom: 1 });
  assert.deepEqual(request.map.origin, { x: -0.3, y: -0.3 });
  for (let time = 0; time < 3; time += 1) request = resize(request, { left: -1, bottom: -1 });
  assert.deepEqual(request.map, { rows: ["...."], resolution: 0.1, origin: { x: 0, y: 0 } });
});

test("a map is never cut to nothing, and without a map there is nothing to resize", () => {
  assert.equal(resize(REQUEST, { right: -3 }), REQUEST);
  assert.equal(resize(REQUEST, { top: -1, bottom: -1 }), REQUEST);
  assert.equal(resize({ robots: [] }, { left: 1 }).map, undefined);
});

test("resolution and origin are set or left to their defaults", () => {
  assert.equal(setResolution(REQUEST, 0.2).map.resolution, 0.2);
  assert.ok(!("resolution" in setResolution(REQUEST, undefined).map));
  assert.deepEqual(setOrigin(REQUEST, "x", undefined).map.origin, { y: -2 });
  assert.ok(!("origin" in setOrigin(setOrigin(REQUEST, "x", undefined), "y", undefined).map));
  assert.deepEqual(setOrigin(null, "y", 3), { map: { origin: { y: 3 } } });
});

test("a new map is open or walled, of any size", () => {
  const rows = (columns, count, walled) => newMap({ columns, rows: count, resolution: 1, walled }).map.rows;
  assert.deepEqual(rows(4, 3, true), ["####", "#..#", "####"]);
  assert.deepEqual(rows(4, 2, false), ["....", "...."]);
  assert.deepEqual(rows(2, 3, true), ["##", "##", "##"]);
  assert.deepEqual(rows(1, 1, true), ["#"]);
});

test("a size that cannot be is told in words", () => {
  assert.equal(faultOfSize(40, 30, {}), null);
  assert.match(faultOfSize(0, 30, {}), /at least one/);
  assert.match(faultOfSize(2.5, 30, {}), /Whole numbers/);
  assert.match(faultOfSize(11, 10, { max_cells: 100 }), /up to 100 cells/);
});
