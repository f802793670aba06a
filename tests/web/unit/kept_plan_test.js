import assert from "node:assert/strict";
import { test } from "node:test";

import { brokenBy, changedRobots, fileToCheck, watchKeptPlan } from "../../../web/model/kept_plan.js";
import { ConnectionLost } from "../../../web/model/problem.js";
import { Signals } from "../../../web/model/signals.js";

const robot = (id, more = {}) => ({ id, start: { x: 1, y: 1 }, goal: { x: 2, y: 1 }, ...more });
const plan = (id) => ({ robot: id, cost: 0, actions: [] });
const REQUEST = { map: { rows: ["..."] }, robots: ["a", "b", "c"].map((id) => robot(id)) };
const ANSWER = { plans: ["a", "b"].map(plan), unplanned: [{ robot: "c", reason: "goal_blocked" }] };
const collision = (...robots) => ({ kind: "robot_collision", robots, t: 1 });

test("robots that were edited, renamed or deleted are changed; others are not", () => {
  const [a, b, c] = REQUEST.robots;
  const changed = (robots) => [...changedRobots(ANSWER, REQUEST, { ...REQUEST, robots })];
  assert.deepEqual(changed([a, b, c]), []);
  assert.deepEqual(changed([{ ...a, goal: { x: 2, y: 2 } }, b, c]), ["a"]);
  assert.deepEqual(changed([{ ...a, id: "z" }, b]), ["a", "c"]);
  assert.deepEqual(changed([structuredClone(a), b, c]), [], "moved there and back");
  assert.deepEqual(changed([robot("new"), a, b, c]), []);
});

test("plans of robots that are not outdated are checked", () => {
  assert.deepEqual(fileToCheck(REQUEST, ANSWER, new Set(["a"])), { ...REQUEST, plans: [plan("b")] });
});

test("a violation breaks the plans of its robots", () => {
  const file = fileToCheck(REQUEST, ANSWER, new Set());
  const wall = { kind: "obstacle_collision", robots: ["b"], t: 1 };
  assert.deepEqual([...brokenBy([wall], file)], ["b"]);
  assert.deepEqual([...brokenBy([collision("a", "b")], file)], ["a", "b"]);
  assert.deepEqual([...brokenBy([{ kind: "moving_obstacle", robots: ["a", "cart"], t: 1 }], file)], ["a"]);
});

test("a robot without a plan breaks the plan of another only if it has no goal, and stays", () => {
  const parked = { ...REQUEST, robots: [...REQUEST.robots, robot("post", { goal: undefined })] };
  const file = fileToCheck(parked, ANSWER, new Set());
  assert.deepEqual([...brokenBy([collision("a", "c")], file)], []);
  assert.deepEqual([...brokenBy([collision("a", "post")], file)], ["a"]);
});

/** As much of a session with an edited request as its watcher asks for. */
class FakeSession extends Signals {
  turn = 1;
  request = REQUEST;
  answer = ANSWER;
  outdated = new Set();

  outdate(ids) {
    this.outdated = new Set([...this.outdated, ...ids]);
  }
}

/** The robots outdated after an edit, if the checks of the service report these violations one after the other. */
async function outdatedAfter(checks) {
  const session = new FakeSession();
  const sent = [];
  await new Promise((done) => {
    const validate = async (text) => {
      sent.push(JSON.parse(text).plans.map((each) => each.robot));
      const check = checks[sent.length - 1];
      if (sent.length === checks.length) setImmediate(done);
      if (check === null) throw new ConnectionLost();
      return check;
    };
    watchKeptPlan(session, validate, 0);
    session.emit("request", { opened: false });
  });
  return { outdated: [...session.outdated], sent };
}

test("after an edit, the check tells which plans hold; again if it does not list all violations", async () => {
  const wall = (id) => ({ kind: "obstacle_collision", robots: [id], t: 1 });
  assert.deepEqual(
    await outdatedAfter([
      { violations: [wall("a")], violations_total: 5 },
      { violations: [wall("b")], violations_total: 1 },
    ]),
    { outdated: ["a", "b"], sent: [["a", "b"], ["b"]] },
  );
  assert.deepEqual(await outdatedAfter([{ violations: [], violations_total: 0 }]), {
    outdated: [],
    sent: [["a", "b"]],
  });
});

test("without a check, nothing more is outdated", async () => {
  assert.deepEqual(await outdatedAfter([null]), { outdated: [], sent: [["a", "b"]] });
});

test("planning begins before the check: the former plan is not checked any more", async () => {
  const session = new FakeSession();
  const sent = [];
  watchKeptPlan(session, async (text) => sent.push(text), 0);
  session.emit("request", { opened: false });
  Object.assign(session, { answer: null, outdated: null });
  session.emit("planning");
  await new Promise((done) => setTimeout(done, 5));
  assert.deepEqual(sent, []);
});
