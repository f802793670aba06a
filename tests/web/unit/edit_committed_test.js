import assert from "node:assert/strict";
import { test } from "node:test";

import { committable, committedOf, readCommitted, setCommitted } from "../../../web/model/edit_committed.js";

const at = (x) => ({ x, y: 0.5, theta: 0 });
const drive = (from) => ({
  type: "translate",
  t_start: from,
  t_end: from + 1,
  from: at(from),
  to: at(from + 1),
});
const PLAN = [drive(0), drive(1), drive(2)];
const request = (committed) => ({ robots: [{ id: "a" }, { id: "b", ...(committed && { committed }) }] });

test("the first actions of a plan that begins with the committed ones can be committed", () => {
  assert.deepEqual(committable({}, PLAN), PLAN);
  assert.deepEqual(committable({ committed: [drive(0)] }, PLAN), PLAN);
  assert.deepEqual(committable({ committed: [drive(1)] }, PLAN), [drive(1)], "another plan's");
  assert.deepEqual(committable({ committed: PLAN }, [drive(0)]), PLAN, "it is longer than the plan");
  assert.deepEqual(committable({ committed: "soon" }, []), []);
});

test("committed actions are set for one robot, and removed with the last one", () => {
  const committed = setCommitted(request(), 1, PLAN.slice(0, 2));
  assert.deepEqual(committed, request(PLAN.slice(0, 2)));
  assert.deepEqual(committedOf(committed.robots[1]), PLAN.slice(0, 2));
  assert.deepEqual(setCommitted(committed, 1, []), request());
});

test("committed actions are read from JSON; an empty text is none", () => {
  assert.deepEqual(readCommitted(JSON.stringify(PLAN)), PLAN);
  assert.deepEqual(readCommitted(" \n"), []);
  for (const text of ["{}", "3", "[1", "null"]) assert.throws(() => readCommitted(text), SyntaxError);
});
