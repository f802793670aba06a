import assert from "node:assert/strict";
import { test } from "node:test";

import {
  clampScroll,
  orderRows,
  panTime,
  revealTime,
  rowAt,
  rowsSeen,
  scrollToRow,
  thinned,
  ticks,
  timeAt,
  xOf,
  yOf,
  zoomTime,
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

test("a time maps to a pixel and back", () => {
  assert.equal(xOf(LAYOUT, 2), 100);
  assert.equal(xOf(LAYOUT, 10), 500);
  assert.equal(timeAt(LAYOUT, 300), 6);
  assert.equal(timeAt(LAYOUT, xOf(LAYOUT, 3.25)), 3.25);
  assert.equal(timeAt(LAYOUT, 0), 0);
});

test("a plan without duration shows its only moment at the left", () => {
  assert.equal(xOf({ ...LAYOUT, range: { from: 0, to: 0 } }, 0), 100);
});

test("a pixel maps to the row drawn there, and to none outside the rows", () => {
  assert.equal(yOf(LAYOUT, 1), 40);
  assert.equal(rowAt(LAYOUT, 50), 1);
  assert.equal(rowAt(LAYOUT, 59.9), 1);
  assert.equal(rowAt(LAYOUT, 60), 2);
  assert.equal(rowAt(LAYOUT, 49), -1);
  assert.equal(rowAt(LAYOUT, 145), -1);
  assert.equal(rowAt({ ...LAYOUT, rows: 3 }, 85), -1);
});

test("the visible rows include partly visible ones", () => {
  assert.deepEqual(rowsSeen(LAYOUT), { first: 1, end: 7 });
  assert.deepEqual(rowsSeen({ ...LAYOUT, scroll: 0, rows: 2 }), { first: 0, end: 2 });
});

test("rows scroll no further than there are rows", () => {
  assert.equal(clampScroll(LAYOUT, -5), 0);
  assert.equal(clampScroll(LAYOUT, 999), 12 * 20 - 95);
  assert.equal(clampScroll({ ...LAYOUT, rows: 2 }, 10), 0);
});

test("scrolling to a row moves as little as possible", () => {
  assert.equal(scrollToRow(LAYOUT, 3), 30);
  assert.equal(scrollToRow(LAYOUT, 1), 20);
  assert.equal(scrollToRow(LAYOUT, 6), 45);
  assert.equal(scrollToRow(LAYOUT, 11), 145);
});

test("rows are sorted by the chosen key; equal and unknown values keep the listed order", () => {
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

test("zooming keeps the time under the pointer in place", () => {
  assert.deepEqual(zoomTime({ from: 0, to: 8 }, 8, 2, 2), { from: 1, to: 5 });
  assert.deepEqual(zoomTime({ from: 1, to: 5 }, 8, 2, 0.5), { from: 0, to: 8 });
});

test("zooming is limited to the duration of the plan and to the shortest range", () => {
  assert.deepEqual(zoomTime({ from: 6, to: 8 }, 8, 8, 0.01), { from: 0, to: 8 });
  const closest = zoomTime({ from: 0, to: 8 }, 8, 4, 1e9);
  assert.ok(Math.abs(closest.to - closest.from - 0.05) < 1e-12);
  assert.deepEqual(zoomTime({ from: 0, to: 0 }, 0, 0, 2), { from: 0, to: 0 });
});

test("panning stops at both ends", () => {
  assert.deepEqual(panTime({ from: 2, to: 4 }, 10, 3), { from: 5, to: 7 });
  assert.deepEqual(panTime({ from: 2, to: 4 }, 10, 30), { from: 8, to: 10 });
  assert.deepEqual(panTime({ from: 2, to: 4 }, 10, -3), { from: 0, to: 2 });
});

test("revealing a time moves the range only if the time is not visible", () => {
  const range = { from: 2, to: 4 };
  assert.equal(revealTime(range, 10, 4), range);
  const later = revealTime(range, 10, 5);
  assert.ok(later.from < 5 && later.to > 5 && later.from > 2);
  const sooner = revealTime(range, 10, 1);
  assert.ok(sooner.from < 1 && sooner.to > 1);
  assert.deepEqual(revealTime(range, 10, 10), { from: 8, to: 10 });
});

test("ticks are round numbers and fit the available space", () => {
  assert.deepEqual(ticks({ from: 0, to: 44.1 }, 10), { step: 5, times: [0, 5, 10, 15, 20, 25, 30, 35, 40] });
  assert.deepEqual(ticks({ from: 3, to: 7 }, 4).times, [3, 4, 5, 6, 7]);
  assert.equal(ticks({ from: 1.03, to: 1.08 }, 6).step, 0.01);
  assert.deepEqual(ticks({ from: 0, to: 0 }, 5).times, [0]);
});

const curve = (...points) => ({ t: points.map(([t]) => t), gap: points.map(([, gap]) => gap) });

test("the lowest point in each pixel is kept", () => {
  const points = curve([0, 5], [0.4, 1], [0.9, 3], [1.2, 7], [1.6, 8], [3.5, 2]);
  assert.deepEqual(thinned(points, { from: 0, to: 4 }, 4), [1, 3, 5]);
  assert.deepEqual(thinned(points, { from: 0, to: 4 }, 400), [0, 1, 2, 3, 4, 5]);
});

test("the nearest point on each side of the range is kept, so that lines reach its edges", () => {
  const points = curve([0, 5], [1, 4], [2, 3], [3, 2], [4, 1], [5, 0]);
  assert.deepEqual(thinned(points, { from: 1.5, to: 3.5 }, 10), [1, 2, 3, 4]);
  assert.deepEqual(thinned(points, { from: 2, to: 3 }, 10), [1, 2, 3, 4]);
});

test("a plan that takes no time has one point", () => {
  assert.deepEqual(thinned(curve([0, 5]), { from: 0, to: 0 }, 100), [0]);
});
