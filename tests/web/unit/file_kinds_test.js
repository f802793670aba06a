import assert from "node:assert/strict";
import { test } from "node:test";

import { ACCEPT, imageNamed, kindOf, sortFiles } from "../../../web/files/file_kinds.js";

const file = (name, head = "") => ({ name, head: new TextEncoder().encode(head) });
const PNG = Uint8Array.from([137, 80, 78, 71, 13, 10, 26, 10, 0, 0, 0, 13]);

test("the extension of a file determines its kind", () => {
  const kinds = [
    "a.json",
    "A.JSON",
    "b.plan.json",
    "c.map",
    "d.map.scen",
    "e.yaml",
    "e.yml",
    "f.pgm",
    "f.png",
  ];
  assert.deepEqual(
    kinds.map((name) => kindOf(file(name))),
    ["json", "json", "json", "map", "scenario", "yaml", "yaml", "image", "image"],
  );
});

test("without a known extension, the content determines the kind", () => {
  const known = [
    ['\uFEFF  {"map": 1}', "json"],
    ["type octile\r\nheight 3\r\n", "map"],
    ["version 1.0\n0\tmaps/a.map\t6\t4\t0\t0\t1\t1\t2\n", "scenario"],
    ["P5\n# by hand\n", "image"],
    ["P2 3 4", "image"],
    ["# map\nimage: lab.pgm\n", "yaml"],
    ["Dear all,\n", null],
    ["", null],
    ["{\0", null],
  ];
  for (const [head, kind] of known) assert.equal(kindOf(file("request.txt", head)), kind, head);
  assert.equal(kindOf(file("noending", "{}")), "json");
  assert.equal(kindOf({ name: "download", head: PNG }), "image");
});

test("valid combinations of files are recognised", () => {
  const [json, answer, map, scenario, yaml, pgm, png] = [
    ..."a.json a.plan.json b.map b.scen c.yaml c.pgm c.png".split(" ").map((name) => file(name)),
  ];
  assert.deepEqual(sortFiles([json]), { kind: "json", files: [json] });
  assert.deepEqual(sortFiles([json, answer]), { kind: "json", files: [json, answer] });
  assert.deepEqual(sortFiles([map]), { kind: "map", map });
  assert.deepEqual(sortFiles([scenario]), { kind: "scenario", scenario, map: null });
  assert.deepEqual(sortFiles([scenario, map]), { kind: "scenario", scenario, map });
  assert.deepEqual(sortFiles([yaml]), { kind: "ros", yaml, images: [] });
  assert.deepEqual(sortFiles([pgm, yaml, png]), { kind: "ros", yaml, images: [pgm, png] });
});

test("other combinations of files are rejected with the kind of each", () => {
  const refused = [
    "a.json b.json c.json",
    "a.map b.map",
    "a.map a.scen b.scen",
    "a.json a.map",
    "a.yaml b.yaml a.pgm",
  ];
  for (const names of refused) {
    const files = names.split(" ").map((name) => file(name));
    assert.throws(
      () => sortFiles(files),
      /^FileError: These files cannot be opened together: a\.\w+ is a.*Open a request/,
      names,
    );
  }
  assert.throws(
    () => sortFiles([file("a.json"), file("a.map")]),
    /a.json is a request or a plan, a.map is a MovingAI/,
  );
  assert.throws(() => sortFiles([file("notes.docx", "PK")]), /notes.docx is not a supported file: requests/);
  assert.throws(() => sortFiles([file("lab.pgm")]), /lab.pgm is only the image.*together with its map.yaml/);
});

test("a map.yaml finds its image among the files, regardless of folders", () => {
  const images = [file("lab.pgm"), file("other.png")];
  assert.equal(imageNamed("../maps/lab.pgm", images, "map.yaml"), images[0]);
  assert.equal(imageNamed("maps\\other.png", images, "map.yaml"), images[1]);
  assert.throws(
    () => imageNamed("hall.pgm", [], "map.yaml"),
    /map.yaml names the image hall.pgm: open both together/,
  );
  assert.throws(
    () => imageNamed("hall.pgm", images, "map.yaml"),
    /hall.pgm, not lab.pgm or other.png: open both/,
  );
});

test("the file input accepts all extensions", () => {
  for (const ending of [".json", ".map", ".scen", ".yaml", ".yml", ".pgm", ".png"])
    assert.ok(ACCEPT.split(",").includes(ending), ending);
});
