import assert from "node:assert/strict";
import { test } from "node:test";

import { clearanceOf } from "../../../web/model/clearance.js";
import { FleetMotion } from "../../../web/model/fleet_motion.js";
import { ProblemError } from "../../../web/model/problem.js";
import { readScene, readTracks } from "../../../web/model/scene.js";
import { Signals } from "../../../web/model/signals.js";

const REQUEST = {
  map: { rows: ["....."] },
  robot_defaults: { radius: 0.25 },
  robots: [
    { id: "far", start: { x: 50, y: 0.5 } },
    { id: "mover", start: { x: 0.5, y: 0.5 }, goal: { x: 3.5, y: 0.5 } },
    { id: "stayer", start: { x: 4.5, y: 0.5 } },
  ],
};
const ACTIONS = [
  { type: "translate", t_start: 0, t_end: 3, from: { x: 0.5, y: 0.5 }, to: { x: 3.5, y: 0.5 } },
];

/** As much of a session as the fleet's motion asks for. */
class FakeSession extends Signals {
  scene = readScene(REQUEST);
  tracks = readTracks(this.scene, null);
  answer = null;

  adopt(answer) {
    this.answer = answer;
    this.tracks = readTracks(this.scene, answer);
    this.emit("answer");
  }
}

test("the nearest pair is reported by ids, at any time and for the current answer", () => {
  const session = new FakeSession();
  const fleet = new FleetMotion(session, () => new Promise(() => {}));
  assert.deepEqual(fleet.nearestAt(3), { ids: ["mover", "stayer"], gap: 3.5 });
  session.adopt({ plans: [{ robot: "mover", cost: 3, actions: ACTIONS }] });
  assert.deepEqual(fleet.nearestAt(3), { ids: ["mover", "stayer"], gap: 0.5 });
  assert.deepEqual(fleet.nearestAt(1), { ids: ["mover", "stayer"], gap: 2.5 });
});

/** Lets what waits for settled promises run. */
const settled = () => new Promise((resolve) => setImmediate(resolve));

test("listeners get a computed curve, unless the answer has been replaced", async () => {
  const session = new FakeSession();
  const replies = [];
  const compute = (motions) => new Promise((done) => replies.push(() => done(clearanceOf(motions))));
  const fleet = new FleetMotion(session, compute);
  let changes = 0;
  fleet.onCurve(() => (changes += 1));
  session.adopt({ plans: [] });
  session.adopt({ plans: [{ robot: "mover", cost: 3, actions: ACTIONS }] });
  assert.equal(changes, 2);
  replies[0]();
  await settled();
  assert.equal(fleet.least, null);
  assert.equal(changes, 2);
  replies[1]();
  await settled();
  assert.deepEqual(fleet.least, { t: 3, gap: 0.5, ids: ["mover", "stayer"] });
  assert.equal(changes, 3);
  session.adopt(null);
  assert.equal(fleet.least, null);
  assert.equal(replies.length, 2);
});

test("a curve that cannot be computed is a problem that can be tried again", async () => {
  const session = new FakeSession();
  const problems = [];
  session.fail = ({ problem }, again) => problems.push({ ...problem, again });
  let broken = true;
  const compute = async (motions) => {
    if (broken) throw new ProblemError({ title: "Broken" });
    return clearanceOf(motions);
  };
  const fleet = new FleetMotion(session, compute);
  session.adopt({ plans: [] });
  await settled();
  assert.deepEqual([problems.length, problems[0].title, fleet.least], [1, "Broken", null]);
  broken = false;
  problems[0].again();
  await settled();
  assert.equal(fleet.least.gap, 3.5);
});

test("gaps beyond vicinities count what robots keep free", async () => {
  const session = new FakeSession();
  const robots = REQUEST.robots.map((robot, at) => ({ ...robot, vicinity: [9, 0.125, undefined][at] }));
  session.scene = readScene({ ...REQUEST, robot_defaults: { radius: 0.25, vicinity: 0.25 }, robots });
  const fleet = new FleetMotion(session, async (motions) => clearanceOf(motions));
  session.adopt({ plans: [{ robot: "mover", cost: 3, actions: ACTIONS }] });
  await settled();
  assert.deepEqual(fleet.least, { t: 3, gap: 0.5, ids: ["mover", "stayer"] });
  fleet.beyondVicinity = true;
  assert.equal(fleet.least, null);
  await settled();
  assert.deepEqual(fleet.least, { t: 3, gap: 0.125, ids: ["mover", "stayer"] });
  assert.deepEqual(fleet.nearestAt(3), { ids: ["mover", "stayer"], gap: 0.125 });
  assert.equal(fleet.byId.get("mover").radius, 0.25);
  assert.deepEqual(
    [...fleet.keptFree].map(([id, { radius }]) => [id, radius]),
    [
      ["far", 9.25],
      ["mover", 0.375],
      ["stayer", 0.5],
    ],
  );
  session.adopt({ plans: [] });
  assert.equal(fleet.keptFree.get("mover").knots.length, 3);
  const others = readTracks(session.scene, { plans: [] });
  assert.deepEqual(fleet.nearestAt(3, others), { ids: ["mover", "stayer"], gap: 3.125 });
});
