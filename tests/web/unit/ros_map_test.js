import assert from "node:assert/strict";
import { test } from "node:test";

import {
  classifyPixels,
  countCells,
  FREE,
  mapOfGrid,
  mergeCells,
  OCCUPIED,
  readRosYaml,
  smallestFactor,
  trimUnknown,
  UNKNOWN,
} from "../../../web/files/ros_map.js";

const YAML = `image: lab.pgm
resolution: 0.050000
origin: [-10.1, -5.0, 0.0]
negate: 0
occupied_thresh: 0.65
free_thresh: 0.196
`;

const LETTERS = [".", "#", "?"];
const drawn = ({ columns, rows, cells }) =>
  Array.from({ length: rows }, (_, row) =>
    [...cells.subarray(row * columns, (row + 1) * columns)].map((cell) => LETTERS[cell]).join(""),
  );
const grid = (lines, resolution = 0.05, origin = { x: -10.1, y: -5 }) => ({
  columns: lines[0].length,
  rows: lines.length,
  cells: Uint8Array.from([...lines.join("")].map((letter) => LETTERS.indexOf(letter))),
  resolution,
  origin,
});
const classify = (yaml, values, { largest = 255, channels = 1 } = {}) => [
  ...classifyPixels(readRosYaml(yaml), {
    width: values.length / channels,
    height: 1,
    channels,
    largest,
    values: Uint16Array.from(values),
  }).cells,
];

test("a map.yaml is read, with trinary as the default mode", () => {
  assert.deepEqual(readRosYaml(YAML), {
    image: "lab.pgm",
    resolution: 0.05,
    origin: { x: -10.1, y: -5 },
    quarterTurns: 0,
    negate: false,
    occupiedThresh: 0.65,
    freeThresh: 0.196,
    mode: "trinary",
    warnings: [],
  });
  assert.equal(readRosYaml(YAML.replace("negate: 0", "negate: true")).negate, true);
  assert.equal(readRosYaml(`${YAML}mode: scale\n`).mode, "scale");
});

test("a map that is turned by no whole number of quarters is refused", () => {
  for (const yaw of [0.3, -0.01, 1.5]) {
    const read = () => readRosYaml(YAML.replace("0.0]", `${yaw}]`));
    assert.throws(read, { message: new RegExp(`turned by ${yaw} rad .* no quarter turn.*set the yaw to 0`) });
  }
});

test("a map that is turned by quarters is turned, about its lower-left corner", () => {
  const of = (yaw) => {
    const described = readRosYaml(YAML.replace("0.0]", `${yaw}]`).replace("0.050000", "1"));
    const values = Uint16Array.from([0, 254, 254, 205, 254, 254]); // two rows
    return [described, classifyPixels(described, { width: 3, height: 2, channels: 1, largest: 255, values })];
  };
  const expected = new Map([
    [1.5708, [["..", "..", "#?"], { x: -12.1, y: -5 }]],
    [-3.1416, [["..?", "..#"], { x: -13.1, y: -7 }]],
    [4.7124, [["?#", "..", ".."], { x: -10.1, y: -8 }]],
    [1e-9, [["#..", "?.."], { x: -10.1, y: -5 }]],
    [6.2832, [["#..", "?.."], { x: -10.1, y: -5 }]],
  ]);
  for (const [yaw, [lines, origin]] of expected) {
    const [described, made] = of(yaw);
    assert.deepEqual([drawn(made), made.origin, described.warnings], [lines, origin, []], `${yaw}`);
  }
});

test("missing thresholds default to map_server's, with a warning", () => {
  const described = readRosYaml(YAML.replace(/occupied.*\n/, "").replace(/free.*\n/, ""));
  assert.deepEqual([described.occupiedThresh, described.freeThresh], [0.65, 0.196]);
  assert.equal(described.warnings.length, 2);
});

test("missing and wrong members of a map.yaml are reported", () => {
  const refused = [
    [YAML.replace(/image.*\n/, ""), /names no image/],
    [YAML.replace(/resolution.*\n/, ""), /resolution is missing/],
    [YAML.replace("0.050000", "0"), /resolution is 0; it must be/],
    [YAML.replace("0.050000", "fine"), /resolution is fine; it must be a number/],
    [YAML.replace(/origin.*\n/, ""), /origin must be a list/],
    [YAML.replace("-5.0", "south"), /origin must be a list/],
    [YAML.replace("0.65", "65"), /occupied_thresh is 65; it must be from 0 to 1/],
    [YAML.replace("0.196", "0.9"), /free_thresh is above/],
    [`${YAML}mode: binary\n`, /mode is binary; map_server knows trinary, scale, raw/],
  ];
  for (const [text, message] of refused) assert.throws(() => readRosYaml(text), message, text);
});

test("pixels are free, occupied or unknown as in map_server", () => {
  // (255 - v) / 255 against 0.65 and 0.196: 89 gives 0.651, 90 gives 0.647, 205 gives 0.19608, 206 gives 0.192
  assert.deepEqual(classify(YAML, [0, 89, 90, 205, 206, 255]), [
    OCCUPIED,
    OCCUPIED,
    UNKNOWN,
    UNKNOWN,
    FREE,
    FREE,
  ]);
  const negated = YAML.replace("negate: 0", "negate: 1");
  assert.deepEqual(classify(negated, [0, 49, 50, 165, 166, 255]), [
    FREE,
    FREE,
    UNKNOWN,
    UNKNOWN,
    OCCUPIED,
    OCCUPIED,
  ]);
});

test("a pixel that is exactly at a threshold is occupied or free", () => {
  const edges = YAML.replace("0.65", "1.0").replace("0.196", "0.0");
  assert.deepEqual(classify(edges, [255, 0, 128]), [FREE, OCCUPIED, UNKNOWN]);
});

test("gray levels are relative to the maximum of the image", () => {
  assert.deepEqual(classify(YAML, [0, 30000, 65535], { largest: 65535 }), [OCCUPIED, UNKNOWN, FREE]);
});

test("in scale mode, shades between the thresholds are percentages, and pixels that are not opaque unknown", () => {
  const scale = `${YAML.replace("0.65", "1.0").replace("0.196", "0.0")}mode: scale`;
  // 100 (1 - gray / 255), rounded: 90 gives 65, 91 gives 64; 190 gives 25, 189 gives 26
  assert.deepEqual(classify(scale, [0, 90, 91, 189, 190, 255]), [
    OCCUPIED,
    OCCUPIED,
    UNKNOWN,
    UNKNOWN,
    FREE,
    FREE,
  ]);
  const pixels = [0, 255, 255, 255, 0, 254, 255, 0]; // gray and alpha
  assert.deepEqual(classify(`${YAML}mode: scale`, pixels, { channels: 2 }), [
    OCCUPIED,
    FREE,
    UNKNOWN,
    UNKNOWN,
  ]);
});

test("pixels that are not opaque are unknown in every mode", () => {
  for (const mode of ["trinary", "scale", "raw"]) {
    const cells = classify(`${YAML}mode: ${mode}`, [0, 0, 0, 254, 255, 128], { channels: 2 });
    assert.deepEqual(cells, [UNKNOWN, UNKNOWN, UNKNOWN], mode);
  }
});

test("the shade of a colour is its luminance, and 205 is unknown in every form", () => {
  // 29, 150 and 225 of 255
  const colours = [0, 0, 255, 0, 255, 0, 255, 255, 0];
  assert.deepEqual(classify(YAML, colours, { channels: 3 }), [OCCUPIED, UNKNOWN, FREE]);
  for (const pixel of [[205], [205, 255], [205, 205, 205], [205, 205, 205, 255]])
    assert.deepEqual(classify(YAML, pixel, { channels: pixel.length }), [UNKNOWN], `${pixel}`);
});

test("in raw mode, the gray level is the occupancy in percent, whatever the thresholds", () => {
  const raw = `${YAML.replace("negate: 0", "negate: 1")}mode: raw`;
  assert.deepEqual(classify(raw, [0, 25, 26, 64, 65, 100, 101, 255]), [
    FREE,
    FREE,
    UNKNOWN,
    UNKNOWN,
    OCCUPIED,
    OCCUPIED,
    UNKNOWN,
    UNKNOWN,
  ]);
});

test("cells are counted by kind", () => {
  assert.deepEqual(countCells(grid(["?.#", "??."])), [2, 1, 3]);
});

test("trimming removes the unknown margin and moves the origin exactly", () => {
  const trimmed = trimUnknown(grid(["?????", "??.#?", "?????", "??.??", "?????", "?????"]));
  assert.deepEqual(drawn(trimmed), [".#", "??", ".?"]);
  assert.deepEqual(trimmed.origin, { x: -10, y: -4.9 });
  assert.equal(trimmed.resolution, 0.05);
});

test("a map without a margin, or all unknown, stays as it is when trimmed", () => {
  const full = grid(["?#", ".?"]);
  assert.deepEqual(trimUnknown(full), full);
  const unknown = grid(["??", "??"]);
  assert.deepEqual(trimUnknown(unknown), unknown);
});

test("merged cells are blocked if any of them is, and the lower-left corner stays", () => {
  const merged = mergeCells(grid(["....", "..#.", "....", "...."]), 2);
  assert.deepEqual(drawn(merged), [".#", ".."]);
  assert.deepEqual([merged.columns, merged.rows, merged.resolution], [2, 2, 0.1]);
  assert.deepEqual(merged.origin, { x: -10.1, y: -5 });
  assert.equal(mergeCells(grid(["..."]), 3).resolution, 0.15);
});

test("merged cells are unknown if any of them is and none is occupied", () => {
  assert.deepEqual(drawn(mergeCells(grid([".??#", "..#."]), 2)), ["?#"]);
  const same = grid([".?#"]);
  assert.deepEqual(drawn(mergeCells(same, 1)), drawn(same));
});

test("merged cells that reach beyond the map are blocked", () => {
  assert.deepEqual(drawn(mergeCells(grid([".....", ".....", "....."]), 2)), ["###", "..#"]);
  assert.deepEqual(drawn(mergeCells(grid(["#....", "....."]), 2)), ["#.#"]);
});

test("merging never frees what was blocked", () => {
  let seed = 7;
  const random = (below) => (seed = (seed * 48271) % 2147483647) % below;
  for (let round = 0; round < 50; round += 1) {
    const columns = 1 + random(9);
    const rows = 1 + random(9);
    const factor = 1 + random(4);
    const lines = Array.from({ length: rows }, () =>
      Array.from({ length: columns }, () => LETTERS[random(8) < 6 ? 0 : 1 + random(2)]).join(""),
    );
    const merged = mergeCells(grid(lines), factor);
    for (let row = 0; row < merged.rows; row += 1) {
      for (let column = 0; column < merged.columns; column += 1) {
        let free = true; // rows counted from the bottom
        for (let y = row * factor; y < (row + 1) * factor; y += 1)
          for (let x = column * factor; x < (column + 1) * factor; x += 1)
            free &&= lines[rows - 1 - y]?.[x] === ".";
        const cell = merged.cells[(merged.rows - 1 - row) * merged.columns + column];
        assert.equal(cell === FREE, free, `${lines.join("\n")} by ${factor} at ${column}, ${row}`);
      }
    }
  }
});

test("the smallest factor makes the map fit, the next smaller one does not", () => {
  assert.equal(smallestFactor({ columns: 2000, rows: 2000 }, 4_000_000), 1);
  assert.equal(smallestFactor({ columns: 2001, rows: 2000 }, 4_000_000), 2);
  assert.equal(smallestFactor({ columns: 10_000, rows: 10_000 }, 4_000_000), 5);
  assert.equal(smallestFactor({ columns: 7, rows: 3 }, 1), 7);
});

test("a grid becomes the map of a request, its unknown cells blocked or free", () => {
  const whole = grid([".#", "?."]);
  const map = { rows: [".#", "#."], resolution: 0.05, origin: { x: -10.1, y: -5 } };
  assert.deepEqual(mapOfGrid(whole, false), map);
  assert.deepEqual(mapOfGrid(whole, true), { ...map, rows: [".#", ".."] });
});
