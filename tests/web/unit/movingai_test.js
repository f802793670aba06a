import assert from "node:assert/strict";
import { test } from "node:test";

import {
  checkMapOf,
  readMovingAiMap,
  readMovingAiScenario,
  scenarioRequest,
} from "../../../web/files/movingai.js";

const MAP_TEXT = "type octile\nheight 3\nwidth 5\nmap\n.G@OT\nWS#..\n.....\n";

test("a MovingAI map becomes the rows of a request, top row first, a metre a cell", () => {
  assert.deepEqual(readMovingAiMap(MAP_TEXT), { rows: [".G@OT", "W.#..", "....."], resolution: 1 });
});

test("line endings and trailing blank lines are ignored", () => {
  const expected = readMovingAiMap(MAP_TEXT);
  assert.deepEqual(readMovingAiMap(MAP_TEXT.replaceAll("\n", "\r\n")), expected);
  assert.deepEqual(readMovingAiMap(`${MAP_TEXT}\n\n`), expected);
  assert.deepEqual(readMovingAiMap(MAP_TEXT.trimEnd()), expected);
});

test("header fields may be in any order, but are required", () => {
  assert.deepEqual(readMovingAiMap("width 2\ntype octile\nheight 1\nmap\n..").rows, [".."]);
  assert.throws(() => readMovingAiMap("type octile\nwidth 2\nmap\n..\n"), /names no height.*"height …"/);
  assert.throws(
    () => readMovingAiMap("type octile\nheight x\nwidth 2\nmap\n.."),
    /^FileError: Line 2 is "height x"/,
  );
  assert.throws(() => readMovingAiMap("type octile\nheight 0\nwidth 2\nmap\n"), /Line 2 is "height 0"/);
  assert.throws(() => readMovingAiMap("type octile\nheight 1\nwidth\nmap\n"), /Line 3 is "width"/);
  assert.throws(() => readMovingAiMap("....\n....\n"), /Line 1 is "\.\.\.\.".*"type octile"/);
  assert.throws(() => readMovingAiMap("type octile\nheight 1\nwidth 2"), /no line "map"/);
  assert.throws(() => readMovingAiMap(""), /Line 1 is ""/);
});

test("an unknown character is reported with its line and column", () => {
  assert.throws(
    () => readMovingAiMap(MAP_TEXT.replace("W", "x")),
    /Line 6 has "x" in column 1; free cells are/,
  );
});

test("a map whose size differs from its header is rejected with the line", () => {
  assert.throws(() => readMovingAiMap(MAP_TEXT.replace("WS#..", "WS#.")), /Line 6 has 4 cells.*width 5/);
  assert.throws(
    () => readMovingAiMap(MAP_TEXT.replace("height 3", "height 4")),
    /height 4, but 3 rows follow/,
  );
  assert.throws(
    () => readMovingAiMap(MAP_TEXT.replace("height 3", "height 2")),
    /height 2, but 3 rows follow/,
  );
});

const DEFAULTS = { radius: 0.4, linear_speed: 1, angular_speed: 3 };
const MAP = {
  rows: [
    "......", //
    ".@....",
    "......",
    "......",
  ],
  resolution: 1,
};

const line = (start, goal) => ["0", "maps/a.map", 6, 4, ...start, ...goal, "1.41421356"].join("\t");
const scenario = (...pairs) =>
  ["version 1", ...pairs.map(([start, goal]) => line(start, goal)), ""].join("\n");
const request = (entries, count, defaults = DEFAULTS, map = MAP) =>
  scenarioRequest(map, readMovingAiScenario(entries), count, defaults);

test("a scenario lists starts and goals as cells from the top left, and its map without the folder", () => {
  const expected = [
    { map: "a.map", width: 6, height: 4, start: { column: 5, row: 0 }, goal: { column: 0, row: 3 } },
  ];
  const text = scenario([
    [5, 0],
    [0, 3],
  ]);
  assert.deepEqual(readMovingAiScenario(text), expected);
  assert.deepEqual(readMovingAiScenario(text.replaceAll("\t", "  ").replaceAll("\n", "\r\n")), expected);
  assert.deepEqual(readMovingAiScenario(text.replace("version 1\n", "")), expected);
});

test("a map name may contain spaces", () => {
  assert.equal(readMovingAiScenario("version 1\n0\tmy map.map\t6\t4\t1\t2\t3\t3\t2\n")[0].map, "my map.map");
});

test("a faulty line of a scenario is reported with the expected format", () => {
  const text = scenario([
    [0, 0],
    [1, 3],
  ]);
  assert.throws(() => readMovingAiScenario(`${text}0\ta.map\t6\t4\t1\n`), /Line 3 is .*start x and y/);
  assert.throws(() => readMovingAiScenario("version 1\n"), /no start and goal/);
  assert.throws(() => readMovingAiScenario(line([0, 0], [6, 0])), /Line 1 has its goal at column 6, row 0/);
  assert.throws(() => readMovingAiScenario(text + text.replace("a.map", "b.map")), /Line 3 is "version 1"/);
  const other = line([0, 0], [1, 3]).replace("a.map", "b.map");
  assert.throws(() => readMovingAiScenario(text + other), /two maps, a.map and b.map/);
});

test("poses are the centres of cells, y up", () => {
  const entries = scenario([
    [5, 0],
    [0, 3],
  ]);
  assert.deepEqual(request(entries, 1).request, {
    map: MAP,
    robot_defaults: DEFAULTS,
    robots: [{ id: "r1", start: { x: 5.5, y: 3.5, theta: 0 }, goal: { x: 0.5, y: 0.5 } }],
  });
  const moved = { ...MAP, resolution: 0.5, origin: { x: 10, y: -2 } };
  const { robots } = request(entries, 1, { ...DEFAULTS, radius: 0.2 }, moved).request;
  assert.deepEqual([robots[0].start.x, robots[0].start.y, robots[0].goal.x], [12.75, -0.25, 10.25]);
  const fine = { ...MAP, resolution: 0.05, origin: { x: -1.1, y: 2 } };
  const [small] = request(entries, 1, { ...DEFAULTS, radius: 0.02 }, fine).request.robots;
  assert.deepEqual([small.start.x, small.start.y], [-0.825, 2.175]); // as decimals, not as sums of doubles
});

test("the first entries are used, in their order", () => {
  const entries = scenario(
    [
      [0, 0],
      [1, 3],
    ],
    [
      [2, 0],
      [3, 3],
    ],
    [
      [4, 0],
      [5, 3],
    ],
  );
  const { robots } = request(entries, 2).request;
  assert.deepEqual(
    robots.map(({ id, start }) => [id, start.x]),
    [
      ["r1", 0.5],
      ["r2", 2.5],
    ],
  );
  assert.equal(request(entries, 9).request.robots.length, 3);
});

test("an entry that overlaps an earlier one is skipped; contact is not overlap", () => {
  const entries = scenario(
    [
      [0, 0],
      [0, 3],
    ],
    [
      [1, 0],
      [4, 3],
    ],
    [
      [0, 0],
      [5, 3],
    ],
    [
      [4, 0],
      [0, 3],
    ],
  );
  const touching = request(entries, 9, { ...DEFAULTS, radius: 0.5 });
  assert.deepEqual(touching.passedOver, { walls: 0, overlaps: 2 });
  assert.deepEqual(
    touching.request.robots.map(({ start }) => start.x),
    [0.5, 1.5],
  );
});

test("an entry that does not fit between walls and edges is skipped", () => {
  const onWall = scenario([
    [1, 1],
    [5, 3],
  ]);
  assert.deepEqual(request(onWall, 1).passedOver, { walls: 1, overlaps: 0 });
  const atEdge = scenario([
    [5, 0],
    [3, 2],
  ]);
  const wide = { ...DEFAULTS, radius: 0.6 };
  assert.deepEqual(request(atEdge, 1, wide).passedOver, { walls: 1, overlaps: 0 });
  const besideCorner = scenario([
    [2, 2],
    [4, 2],
  ]); // sqrt(0.5) from the wall's corner
  assert.equal(request(besideCorner, 1, { ...DEFAULTS, radius: 0.7 }).request.robots.length, 1);
  assert.equal(request(besideCorner, 1, { ...DEFAULTS, radius: 0.71 }).request.robots.length, 0);
  assert.equal(request(besideCorner, 1, { ...DEFAULTS, radius: 1e9 }).request.robots.length, 0);
});

test("a map of another size is rejected with both sizes", () => {
  const text = scenario([
    [0, 0],
    [1, 3],
  ]);
  const entries = readMovingAiScenario(text);
  assert.throws(
    () => checkMapOf(entries, { rows: ["...."] }),
    /for a.map of 6 x 4 cells, but the map has 4 x 1/,
  );
  assert.doesNotThrow(() => checkMapOf(entries, { rows: Array(4).fill("......") }));
  assert.throws(
    () => checkMapOf([...entries, { ...entries[0], width: 7 }], { rows: Array(4).fill("......") }),
    /of 7 x 4/,
  );
});
