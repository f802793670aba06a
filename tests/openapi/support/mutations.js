// Requests that are invalid at one place.

import fc from "fast-check";

import { Members, Raw, textOf } from "./text.js";

const TOO_DEEP = 40;

/** Values that are invalid almost everywhere. */
const UNUSUAL = [
  null,
  true,
  "",
  "x",
  "NaN",
  [],
  {},
  [[[]]],
  0,
  -1,
  0.5,
  1e-320,
  1e308,
  -0,
  2n ** 70n,
  -(2n ** 63n),
  new Raw("1e999"),
  new Raw("-1e999"),
  new Raw("0e0"),
  "\u0000",
  "\u202e\u{1f916}e\u0301\ufeff",
  "#".repeat(5000),
];

/** Texts that are not JSON. */
const NO_JSON = [
  "NaN",
  "-Infinity",
  "-",
  "01",
  "1.",
  "+1",
  "0x1",
  "'a'",
  "tru",
  "",
  '"\\x"',
  '"\u0001"',
  "1/*2*/",
]
  .concat(['"\\ud800"', "{,}", "[1,]", '{"a"}', '"open'])
  .map((text) => new Raw(text));

const ODD_KEYS = ["", "a/b~c", "__proto__", "constructor", "Map", "theta ", "\u{1f916}", "robots"];

/** All places of a value as steps from the root; the root itself is first. */
function placesOf(value, steps = []) {
  if (value === null || typeof value !== "object" || value instanceof Raw) return [steps];
  return [steps, ...Object.entries(value).flatMap(([key, member]) => placesOf(member, [...steps, key]))];
}

/** A copy with the value at the steps replaced by change(value); left out if that is undefined. */
function changed(value, [step, ...rest], change) {
  if (step === undefined) return change(value);
  const inner = changed(value[step], rest, change);
  if (Array.isArray(value)) {
    return value.flatMap((item, index) => {
      if (String(index) !== step) return [item];
      return inner === undefined ? [] : [inner];
    });
  }
  const pairs = Object.entries(value).map(([key, member]) => (key === step ? [key, inner] : [key, member]));
  return new Members(pairs.filter(([, member]) => member !== undefined));
}

const isObject = (value) => value !== null && typeof value === "object" && !Array.isArray(value);

const CHANGES = {
  drop: () => undefined,
  replace: (value, pick) => pick(UNUSUAL),
  "no JSON": (value, pick) => pick(NO_JSON),
  wrap: (value, pick) => pick([[value], { value }]),
  deepen: (value, pick) => new Raw(pick(["[", '{"a":']).repeat(TOO_DEEP)),
  nest: (value) => new Raw("[".repeat(TOO_DEEP) + "]".repeat(TOO_DEEP)),
  add: (value, pick) =>
    isObject(value)
      ? new Members([...Object.entries(value), [pick(ODD_KEYS), pick(UNUSUAL)]])
      : pick(UNUSUAL),
  twice: (value, pick) => {
    const pairs = isObject(value) ? Object.entries(value) : [];
    return pairs.length > 0 ? new Members([...pairs, pick(pairs)]) : pick(UNUSUAL);
  },
  scale: (value, pick) =>
    typeof value === "number" ? value * pick([-1, 1e-12, 1e12, 1e300]) : pick(UNUSUAL),
};

/** The bytes of a request changed at one place of its tree. */
export function mutatedValues(requests) {
  return fc
    .record({
      request: requests,
      place: fc.nat(),
      how: fc.constantFrom(...Object.keys(CHANGES)),
      choice: fc.nat(),
    })
    .map(({ request, place, how, choice }) => {
      const places = placesOf(request);
      const pick = (list) => list[choice % list.length];
      const mutated = changed(request, places[place % places.length], (value) => CHANGES[how](value, pick));
      return Buffer.from(textOf(mutated === undefined ? null : mutated));
    });
}

/** The bytes of a request, truncated, or with some of them overwritten or inserted. */
export function mutatedBytes(requests) {
  const part = fc.uint8Array({ minLength: 0, maxLength: 3 });
  return fc
    .record({ request: requests, place: fc.nat(), part, length: fc.constantFrom(0, 1, 3, Infinity) })
    .map(({ request, place, part: put, length }) => {
      const bytes = Buffer.from(textOf(request));
      const at = place % bytes.length;
      return Buffer.concat([bytes.subarray(0, at), put, bytes.subarray(Math.min(at + length, bytes.length))]);
    });
}
