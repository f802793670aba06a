import assert from "node:assert/strict";
import { test } from "node:test";

import { readMovingAiMap } from "../../../web/files/movingai_map.js";

const MAP = "type octile\nheight 3\nwidth 5\nmap\n.G@OT\nWS#..\n.....\n";

test("a MovingAI map becomes the rows of a request, top row first, a metre a cell", () => {
  assert.deepEqual(readMovingAiMap(MAP), { rows: [".G@OT", "W.#..", "....."], resolution: 1 });
});

test("the ends of lines and what follows the last row do not matter", () => {
  const expected = readMovingAiMap(MAP);
  assert.deepEqual(readMovingAiMap(MAP.replaceAll("\n", "\r\n")), expected);
  assert.deepEqual(readMovingAiMap(`${MAP}\n\n`), expected);
  assert.deepEqual(readMovingAiMap(MAP.trimEnd()), expected);
});

test("the header may come in another order, but has to be there", () => {
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

test("a character of no meaning is named with its line and column", () => {
  assert.throws(() => readMovingAiMap(MAP.replace("W", "x")), /Line 6 has "x" in column 1; free cells are/);
});

test("a map that is not of the size its header says is refused with the line", () => {
  assert.throws(() => readMovingAiMap(MAP.replace("WS#..", "WS#.")), /Line 6 has 4 cells.*width 5/);
  assert.throws(() => readMovingAiMap(MAP.replace("height 3", "height 4")), /height 4, but 3 rows follow/);
  assert.throws(() => readMovingAiMap(MAP.replace("height 3", "height 2")), /height 2, but 3 rows follow/);
});
