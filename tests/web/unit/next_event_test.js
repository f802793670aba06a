import assert from "node:assert/strict";
import { test } from "node:test";

import { eventTimes, nextEvent } from "../../../web/model/next_event.js";

const action = (t_start, t_end) => ({ t_start, t_end });

test("the events of some tracks are the ends of all their actions, each once", () => {
  const tracks = [
    { actions: [action(0, 1), action(1, 3)] },
    { actions: [action(0, 2), action(2, 3 + 1e-9)] },
  ];
  assert.deepEqual(eventTimes(tracks), [0, 1, 2, 3]);
});

test("robots that do nothing have no events", () => {
  assert.deepEqual(eventTimes([{ actions: [] }]), []);
});

test("steps lead to the next event and the one before, and stay where there is none", () => {
  const times = [0, 1, 2.5];
  assert.equal(nextEvent(times, 0.4, 1), 1);
  assert.equal(nextEvent(times, 1, 1), 2.5);
  assert.equal(nextEvent(times, 1 - 1e-9, 1), 2.5);
  assert.equal(nextEvent(times, 2.5, 1), 2.5);
  assert.equal(nextEvent(times, 2.5, -1), 1);
  assert.equal(nextEvent(times, 0, -1), 0);
  assert.equal(nextEvent([], 3, 1), 3);
});
