// The modules of the page import in one direction: each folder only itself and the folders listed for it.

import assert from "node:assert/strict";
import { readdir, readFile } from "node:fs/promises";
import { dirname, join, relative } from "node:path";
import { test } from "node:test";
import { fileURLToPath } from "node:url";

const ROOT = fileURLToPath(new URL("../../../web", import.meta.url));

const ALLOWED = {
  ui: [],
  model: [],
  service: ["model"],
  scene: ["model", "ui"],
  edit: ["model", "ui", "scene"],
  panels: ["model", "ui", "scene"],
  files: ["model", "ui", "scene"],
  share: ["model", "ui", "scene", "panels", "files"],
  analysis: ["model", "ui", "scene", "panels"],
};

/** The folder of a path in the page; "" for main.js and hook.js. */
const folderOf = (path) => (path.includes("/") ? path.split("/")[0] : "");

/** What each module imports: path -> paths, relative to the root of the page. */
async function importsByModule() {
  const entries = await readdir(ROOT, { recursive: true });
  const modules = entries.filter((path) => path.endsWith(".js"));
  return new Map(
    await Promise.all(
      modules.map(async (path) => {
        const text = await readFile(join(ROOT, path), "utf8");
        const specifiers = [...text.matchAll(/(?:\bfrom|\bimport|new URL\()\s*\(?"([^"]+\.js)"/g)];
        return [path, specifiers.map(([, name]) => relative(ROOT, join(ROOT, dirname(path), name)))];
      }),
    ),
  );
}

const imports = await importsByModule();

test("every folder of modules has its rule", () => {
  const folders = new Set([...imports.keys()].map(folderOf).filter((folder) => folder !== ""));
  assert.deepEqual([...folders].sort(), Object.keys(ALLOWED).sort());
});

for (const [folder, allowed] of Object.entries(ALLOWED)) {
  test(`${folder} imports ${allowed.length > 0 ? `only ${allowed.join(", ")}` : "no other folder"}`, () => {
    const wrong = [];
    for (const [path, imported] of imports) {
      if (folderOf(path) !== folder) continue;
      for (const other of imported) {
        if (folderOf(other) !== folder && !allowed.includes(folderOf(other))) wrong.push(`${path}: ${other}`);
      }
    }
    assert.deepEqual(wrong, []);
  });
}

test("no module imports itself through others", () => {
  const done = new Set();
  const visit = (path, above) => {
    assert.ok(!above.includes(path), `${[...above, path].join(" -> ")}`);
    if (done.has(path)) return;
    for (const other of imports.get(path) ?? []) visit(other, [...above, path]);
    done.add(path);
  };
  for (const path of imports.keys()) visit(path, []);
});

test("index.html loads every module", () => {
  const reached = new Set();
  const visit = (path) => {
    if (reached.has(path)) return;
    reached.add(path);
    (imports.get(path) ?? []).forEach(visit);
  };
  ["start.js", "main.js"].forEach(visit);
  assert.deepEqual(
    [...imports.keys()].filter((path) => !reached.has(path)),
    [],
  );
});
