// Maps of the MovingAI benchmarks (movingai.com/benchmarks): a header, then a character a cell.

import { FileError, linesOf, quoted } from "./file_text.js";

const FREE = ".GS"; // ground, and swamp, which can be entered from ground; a request knows no swamp
const BLOCKED = "@OTW#"; // out of bounds twice, trees, water; and walls as a request draws them
const HEADER = { type: /^\S+$/, height: /^[1-9]\d{0,8}$/, width: /^[1-9]\d{0,8}$/ };

/** The map of a request that a `.map` text draws, a metre a cell: {rows, resolution}. Throws FileError. */
export function readMovingAiMap(text) {
  const lines = linesOf(text);
  const { width, height, first } = readHeader(lines);
  const drawn = lines.slice(first);
  while (drawn.at(-1)?.trim() === "") drawn.pop();
  if (drawn.length !== height) {
    throw new FileError(
      `The header says height ${height}, but ${drawn.length} rows follow "map". ` +
        "Correct the height, or fetch the map again: it may be cut short.",
    );
  }
  return { rows: drawn.map((line, row) => readRow(line, first + row + 1, width)), resolution: 1 };
}

/** {width, height, first}: `first` is the index of the line that draws the top row. */
function readHeader(lines) {
  const header = {};
  for (const [index, line] of lines.entries()) {
    const [, key, value] = /^\s*(\w+)(?:\s+(\S+))?\s*$/.exec(line) ?? [];
    if (key === "map" && value === undefined) return { ...sizesIn(header), first: index + 1 };
    if (!Object.hasOwn(HEADER, key) || !HEADER[key].test(value)) {
      throw new FileError(
        `Line ${index + 1} is ${quoted(line)}, where the header of a MovingAI map is expected: ` +
          '"type octile", "height" and "width" with a whole number each, then "map".',
      );
    }
    header[key] = Number(value);
  }
  throw new FileError('There is no line "map" that ends the header of a MovingAI map.');
}

function sizesIn({ width, height }) {
  const missing = Object.entries({ width, height }).find(([, size]) => size === undefined);
  if (missing)
    throw new FileError(
      `The header names no ${missing[0]}: add a line "${missing[0]} …" before the line "map".`,
    );
  return { width, height };
}

function readRow(line, number, width) {
  for (let column = 0; column < line.length; column += 1) {
    if (FREE.includes(line[column]) || BLOCKED.includes(line[column])) continue;
    throw new FileError(
      `Line ${number} has ${quoted(line[column])} in column ${column + 1}; free cells are . G and S, ` +
        "blocked ones @ O T W and #.",
    );
  }
  if (line.length !== width) {
    throw new FileError(
      `Line ${number} has ${line.length} cells, but the header says width ${width}; ` +
        "all rows must be of that length.",
    );
  }
  return line.replaceAll("S", ".");
}
