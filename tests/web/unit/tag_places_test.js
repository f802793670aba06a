import assert from "node:assert/strict";
import { test } from "node:test";

import { TagPlaces } from "../../../web/scene/tag_places.js";

test("a name is above its disk; below or beside it where another name is", () => {
  const places = new TagPlaces();
  const at = { x: 100, y: 100 };
  assert.deepEqual(places.place(at, 20, 60), { x: 100, y: 80 });
  assert.deepEqual(places.place({ x: 130, y: 100 }, 20, 60), { x: 130, y: 120 });
  assert.deepEqual(places.place(at, 20, 60), { x: 50, y: 100 });
  assert.deepEqual(places.place({ x: 300, y: 100 }, 20, 60), { x: 300, y: 80 });
  assert.deepEqual(new TagPlaces().place(at, 20, 60), { x: 100, y: 80 });
});
