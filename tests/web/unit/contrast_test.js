// What the theme promises to eyes: the contrast ratios of WCAG 2.2, 1.4.3 (text) and 1.4.11 (controls, graphics).

import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { test } from "node:test";

const TEXT = 4.5;
const SHAPE = 3;
const STEP = 1.12; // between neighbours in an order of colours: without hues, they are told apart by lightness

const TEXTS = [
  ["ink", "panel"],
  ["muted", "panel"],
  ["muted", "raised"],
  ["muted", "ground"],
  ["muted", "danger-wash"],
  ["accent", "panel"],
  ["accent", "accent-wash"],
  ["on-accent", "accent"],
  ["on-accent", "accent-hover"],
  ["good", "good-wash"],
  ["fair", "fair-wash"],
  ["danger", "danger-wash"],
  ["danger", "panel"],
];
const SHAPES = [
  ["control-line", "panel"],
  ["accent", "panel"],
  ["scene-wall", "scene-floor"],
  ["scene-danger", "scene-floor"],
  ["scene-accent", "scene-floor"],
  ...["moving", "turning", "waiting", "arrived", "parked", "ready", "unplanned"].map((state) => [
    `state-${state}`,
    "scene-floor",
  ]),
];

/** Custom properties that are colours: {light, dark}, each name -> [red, green, blue]. */
async function themes() {
  const css = await readFile(new URL("../../../web/styles/theme.css", import.meta.url), "utf8");
  const [first, second] = css.split("@media (prefers-color-scheme: dark)").map((part) => {
    return Object.fromEntries(
      [...part.matchAll(/--([\w-]+): #([0-9a-f]{6})/g)].map(([, name, hex]) => [name, hex]),
    );
  });
  return { light: first, dark: { ...first, ...second } };
}

/** Relative luminance of a colour as "rrggbb", [0, 1]. */
function luminance(hex) {
  const [red, green, blue] = [0, 2, 4].map((at) => {
    const part = parseInt(hex.slice(at, at + 2), 16) / 255;
    return part <= 0.04045 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4;
  });
  return 0.2126 * red + 0.7152 * green + 0.0722 * blue;
}

function contrast(one, other) {
  const [brighter, darker] = [luminance(one), luminance(other)].sort((a, b) => b - a);
  return (brighter + 0.05) / (darker + 0.05);
}

test("black on white has the highest contrast there is", () => {
  assert.ok(Math.abs(contrast("000000", "ffffff") - 21) < 1e-9);
});

for (const scheme of ["light", "dark"]) {
  for (const [pairs, least, what] of [
    [TEXTS, TEXT, "texts"],
    [SHAPES, SHAPE, "controls and marks"],
  ]) {
    test(`${what} stand out in the ${scheme} theme`, async () => {
      const theme = (await themes())[scheme];
      for (const [front, back] of pairs) {
        const ratio = contrast(theme[front], theme[back]);
        assert.ok(ratio >= least, `--${front} on --${back}: ${ratio.toFixed(2)}`);
      }
    });
  }
}

for (const scheme of ["light", "dark"]) {
  test(`the colours of travel times get darker step by step in the ${scheme} theme`, async () => {
    const theme = (await themes())[scheme];
    const shades = Array.from({ length: 7 }, (_, shade) => theme[`travel-${shade}`]);
    shades.slice(1).forEach((shade, before) => {
      const ratio = contrast(shades[before], shade);
      assert.ok(luminance(shade) < luminance(shades[before]), `--travel-${before + 1} is darker`);
      assert.ok(ratio >= STEP, `--travel-${before + 1} on --travel-${before}: ${ratio.toFixed(2)}`);
    });
  });
}
