// What deploy/image/make-root puts into the image: the program with its hardening, the page, licences, and the bill of
// materials. Needs no container engine.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readdirSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { after, before, test } from "node:test";

import { pathOf, outputOf, textOf } from "./support/files.js";

const BUILD = join(dirname(process.env.FLEETPLAN_BIN), "..");
const NOTICE = textOf("NOTICE");
/** The packages that NOTICE lists, with their licences. */
const NOTICED = new Map(
  [...NOTICE.matchAll(/^ {2}\S+ +(\S+) +(lib\S+|nlohmann\S+) /gm)].map(([, licence, name]) => [
    name,
    licence,
  ]),
);

let root;
before(() => {
  root = mkdtempSync(join(tmpdir(), "image-root-"));
  execFileSync(pathOf("deploy/image/make-root"), [BUILD, root], { stdio: ["ignore", "ignore", "inherit"] });
});
after(() => rmSync(root, { recursive: true, force: true }));

const inRoot = (path) => readFileSync(join(root, path), "utf8");
const documentOf = (path) => inRoot(join("usr/share/doc", path));
const sbom = () => JSON.parse(documentOf("fleetplan/sbom.cdx.json"));
const readelf = (...flags) =>
  execFileSync("readelf", ["--wide", ...flags, join(root, "usr/local/bin/fleetplan")], { encoding: "utf8" });

test("the program is a position-independent executable", () => {
  assert.match(readelf("--file-header"), /Type: +DYN/);
  assert.match(readelf("--dynamic"), /FLAGS_1\) .*\bPIE\b/);
});

test("the program is linked with full RELRO and a stack that is not executable", () => {
  const segments = readelf("--program-headers");
  assert.match(segments, /GNU_RELRO/);
  assert.match(segments, /GNU_STACK .* RW +0x/);
  assert.match(readelf("--dynamic"), /\bBIND_NOW\b|FLAGS_1\) .*\bNOW\b/);
});

test("the program has a stack protector and checked functions of libc", () => {
  const symbols = readelf("--dyn-syms");
  assert.match(symbols, /__stack_chk_fail/);
  assert.match(symbols, /UND __(?!stack_)\w+_chk\b/);
});

test("the page is a bundle", () => {
  const names = readdirSync(join(root, "usr/local/share/fleetplan/web")).filter(
    (name) => !name.endsWith(".map"),
  );
  const [index, ...others] = names.sort((a, b) =>
    a === "index.html" ? -1 : b === "index.html" ? 1 : a.localeCompare(b),
  );
  assert.equal(index, "index.html");
  assert.ok(others.length >= 4 && others.length <= 16, others.join(" "));
  for (const name of others) assert.match(name, /-[A-Z2-7]{8}\.\w+$/);
});

test("licence and notices of the program are in the image", () => {
  assert.equal(documentOf("fleetplan/LICENSE"), textOf("LICENSE"));
  assert.equal(documentOf("fleetplan/NOTICE"), NOTICE);
});

test("the licence of every component is in the image, and so are the texts it refers to", () => {
  for (const { name } of sbom().components) {
    const copyright = documentOf(`${name}/copyright`);
    for (const [path] of copyright.matchAll(/\/usr\/share\/common-licenses\/[\w.-]*\w/g)) inRoot(path);
  }
});

test("the bill of materials lists the libraries of NOTICE and every shared library", () => {
  const { bomFormat, specVersion, metadata, components } = sbom();
  assert.deepEqual([bomFormat, specVersion], ["CycloneDX", "1.5"]);
  assert.equal(`${metadata.component.name} ${metadata.component.version}`, outputOf("--version").trim());
  assert.deepEqual(metadata.component.licenses, [{ license: { id: "Apache-2.0" } }]);
  const linked = (linkage) =>
    components
      .filter(({ properties }) => properties.some(({ value }) => value === linkage))
      .map(({ name }) => name);
  assert.deepEqual(linked("compiled in").sort(), [...NOTICED.keys()].sort());
  assert.deepEqual(linked("shared library").sort(), readdirSync(join(root, "var/lib/dpkg/status.d")).sort());
  for (const { name, version, licenses, purl } of components) {
    assert.ok(version && purl.startsWith(`pkg:deb/debian/${name}@`), name);
    const [{ license }] = licenses;
    assert.ok(license.id ?? license.name, name);
    if (license.id && NOTICED.has(name)) assert.equal(license.id, NOTICED.get(name));
  }
});
