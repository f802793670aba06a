import assert from "node:assert/strict";
import { test } from "node:test";

import { readYaml } from "../../../web/files/yaml.js";

test("a mapping of scalars is read with their types", () => {
  const text = `
    text: maps/lab 1.pgm
    whole: -3
    part: 0.050000
    power: 1.5e-2
    point: 5.
    yes: true
    no: no
    nothing: ~
    infinite: -.inf
    address: http://a.b/c#d
  `.replaceAll("    ", "");
  assert.deepEqual(readYaml(text), {
    text: "maps/lab 1.pgm",
    whole: -3,
    part: 0.05,
    power: 0.015,
    point: 5,
    yes: true,
    no: false,
    nothing: null,
    infinite: -Infinity,
    address: "http://a.b/c#d",
  });
});

test("comments, blank lines, document marks and any ends of lines are left out", () => {
  const text = "%YAML 1.1\r\n---\r\n# map\r\na: 1 # one\r\n\r\n  # two\r\nb: x#y\r\n...\r\n";
  assert.deepEqual(readYaml(text), { a: 1, b: "x#y" });
});

test("quoted text is kept unchanged", () => {
  const text = `a: "x # y: [z]" # comment\nb: 'it''s'\n"c d": "\\u00e9\\""\n'e': '1'\n`;
  assert.deepEqual(readYaml(text), { a: "x # y: [z]", b: "it's", "c d": 'é"', e: "1" });
});

test("an apostrophe within a word is no quote", () => {
  assert.deepEqual(readYaml("a: it's # that's\nb: x\n"), { a: "it's", b: "x" });
});

test("lists come in brackets, on one line or several, or with dashes", () => {
  const text = `a: [1, -2.5, "x, y", z]\nb: [1,  # one\n  2,\n  3]\nc:\n- 1\n- two\nd:\n  - 3\ne: []\n`;
  assert.deepEqual(readYaml(text), { a: [1, -2.5, "x, y", "z"], b: [1, 2, 3], c: [1, "two"], d: [3], e: [] });
});

test("unsupported YAML is rejected with its line", () => {
  const refused = [
    ["a: 1\nnonsense\n", /Line 2 is "nonsense", where "key: value"/],
    ["a: {b: 1}\n", /Line 1: "{b: 1}" is not understood/],
    ["a: [1, [2]]\n", /Line 1: the list/],
    ["a: [1] 2\n", /Line 1: the list/],
    ["a: |\n  text\n", /Line 1: "|" is not understood/],
    ["a: &x 1\n", /Line 1/],
    ["a: b: c\n", /Line 1/],
    ["a: 1\na: 2\n", /Line 2 has "a" a second time/],
    ["\n\na: [1,\n2\n", /list that begins on line 3 is not closed/],
    ["- 1\n", /Line 1 is "- 1"/],
    ['a: "x\n', /Line 1/],
    ['a: "\\q"\n', /Line 1: the quoted text/],
    ["a: 1\n- 2\n", /Line 2/],
  ];
  for (const [text, message] of refused) assert.throws(() => readYaml(text), message, text);
});
