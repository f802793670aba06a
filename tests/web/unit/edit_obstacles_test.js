import assert from "node:assert/strict";
import { test } from "node:test";

import * as edits from "../../../web/model/edit_obstacles.js";

const EMPTY = { robots: [{ id: "obstacle-1" }] };
const one = edits.addObstacle(EMPTY, { x: 2, y: 3 }, 0.3);

test("an obstacle is added with a fresh id, standing at a point for some time", () => {
  const motion = [
    { t: 0, x: 2, y: 3 },
    { t: 10, x: 2, y: 3 },
  ];
  assert.deepEqual(one.obstacles, [{ id: "obstacle-2", radius: 0.3, motion }]);
});

test("its motion is edited entry by entry, and keeps at least one", () => {
  const longer = edits.appendEntry(one, 0);
  assert.deepEqual(longer.obstacles[0].motion[2], { t: 15, x: 2, y: 3 });
  const moved = edits.setEntry(longer, 0, 1, { x: 7 });
  assert.deepEqual(moved.obstacles[0].motion[1], { t: 10, x: 7, y: 3 });
  const short = edits.removeEntry(edits.removeEntry(one, 0, 0), 0, 0);
  assert.deepEqual(short.obstacles[0].motion, [{ t: 10, x: 2, y: 3 }]);
});

test("members are set and removed, and without the last obstacle a request has none", () => {
  const staying = edits.setObstacle(one, 0, { after: "stays" });
  assert.equal(staying.obstacles[0].after, "stays");
  assert.deepEqual(edits.setObstacle(staying, 0, { after: undefined }), one);
  assert.deepEqual(edits.deleteObstacle(one, 0), EMPTY);
});
