import assert from "node:assert/strict";
import { test } from "node:test";

import {
  clampScroll,
  orderRows,
  rowAt,
  rowsSeen,
  scrollToRow,
  timeAt,
  xOf,
  yOf,
} from "../../../web/model/gantt.js";

const LAYOUT = {
  left: 100,
  width: 400,
  top: 50,
  height: 95,
  rowHeight: 20,
  scroll: 30,
  rows: 12,
  range: { from: 2, to: 10 },
};

test("a moment and its pixel lead to each other", () => {
  assert.equal(xOf(LAYOUT, 2), 100);
  assert.equal(xOf(LAYOUT, 10), 500);
  assert.equal(timeAt(LAYOUT, 300), 6);
  assert.equal(timeAt(LAYOUT, xOf(LAYOUT, 3.25)), 3.25);
  assert.equal(timeAt(LAYOUT, 0), 0);
});

test("a plan that takes no time has its one moment at the left", () => {
  assert.equal(xOf({ ...LAYOUT, range: { from: 0, to: 0 } }, 0), 100);
});

test("a pixel is on the row drawn there, and on none beside and below the rows", () => {
  assert.equal(yOf(LAYOUT, 1), 40);
  assert.equal(rowAt(LAYOUT, 50), 1);
  assert.equal(rowAt(LAYOUT, 59.9), 1);
  assert.equal(rowAt(LAYOUT, 60), 2);
  assert.equal(rowAt(LAYOUT, 49), -1);
  assert.equal(rowAt(LAYOUT, 145), -1);
  assert.equal(rowAt({ ...LAYOUT, rows: 3 }, 85), -1);
});

test("the rows seen include those cut at both ends", () => {
  assert.deepEqual(rowsSeen(LAYOUT), { first: 1, end: 7 });
  assert.deepEqual(rowsSeen({ ...LAYOUT, scroll: 0, rows: 2 }), { first: 0, end: 2 });
});

test("rows scroll no further than there are rows", () => {
  assert.equal(clampScroll(LAYOUT, -5), 0);
  assert.equal(clampScroll(LAYOUT, 999), 12 * 20 - 95);
  assert.equal(clampScroll({ ...LAYOUT, rows: 2 }, 10), 0);
});

test("scrolling to a row moves as little as it takes", () => {
  assert.equal(scrollToRow(LAYOUT, 3), 30);
  assert.equal(scrollToRow(LAYOUT, 1), 20);
  assert.equal(scrollToRow(LAYOUT, 6), 45);
  assert.equal(scrollToRow(LAYOUT, 11), 145);
});

test("rows are sorted by what is asked for, and as listed where that is equal or unknown", () => {
  const track = (cost, lowerBound, start) => ({
    cost,
    lowerBound,
    actions:
      start === null
        ? []
        : [
            { type: "wait", t_start: 0 },
            { type: "translate", t_start: start },
          ],
  });
  const tracks = new Map([
    ["a", track(5, 4, 2)],
    ["b", track(null, null, null)],
    ["c", track(9, 9, 1)],
    ["d", track(5, 2, 1)],
    ["e", track(7, null, 3)],
  ]);
  const robots = [...tracks.keys()].map((id) => ({ id }));
  const sorted = (by) => orderRows(robots, tracks, by).join("");
  assert.equal(sorted("listed"), "abcde");
  assert.equal(sorted("start"), "cdaeb");
  assert.equal(sorted("cost"), "ceadb");
  assert.equal(sorted("delay"), "dacbe");
});
