import assert from "node:assert/strict";
import { test } from "node:test";

import { standingAtGoals } from "../../../web/model/checks.js";
import { duplicateRobot, removeGoal, setPose, setRobot } from "../../../web/model/edit_request.js";
import { goalAt, lastGoalOf, lastGoalPlace } from "../../../web/model/goals.js";
import { actionInWords } from "../../../web/model/itinerary.js";
import { obstacleAt, readObstacles } from "../../../web/model/moving_obstacles.js";
import { planFile, readDocument } from "../../../web/model/plan_file.js";
import { readScene, readTracks, robotPoseAt, robotStateAt } from "../../../web/model/scene.js";

const FROM = { x: 0.5, y: 0.5, theta: 0 };
const TO = { x: 1.5, y: 0.5, theta: 0 };
const COMMITTED = [{ type: "translate", t_start: 0, t_end: 1, from: FROM, to: TO }];
const MOVING = {
  map: { rows: ["....", "...."] },
  robots: [
    {
      id: "a",
      radius: 0.3,
      start: FROM,
      committed: COMMITTED,
      previous: COMMITTED,
      goals: [
        { x: 3.5, y: 0.5, service: 2 },
        { x: 3.5, y: 1.5, theta: 1, not_before: 9 },
      ],
    },
    { id: "b", radius: 0.3, start: { x: 0.5, y: 1.5 }, goal: { x: 1.5, y: 1.5 } },
  ],
  obstacles: [
    {
      id: "person",
      radius: 0.25,
      motion: [
        { t: 2, x: 0, y: 1 },
        { t: 4, x: 4, y: 1 },
      ],
    },
  ],
  options: { replan: "where_needed", interval_margin: 0.5 },
};

test("the last of several goals is the one to edit, and the others stay", () => {
  const [a, b] = MOVING.robots;
  assert.equal(lastGoalOf(a), a.goals[1]);
  assert.equal(lastGoalPlace(a), "goals/1");
  assert.equal(lastGoalPlace(b), "goal");
  const moved = setPose(MOVING, 0, "goal", { x: 2.5 }).robots[0];
  assert.deepEqual(moved.goals, [a.goals[0], { x: 2.5, y: 1.5, theta: 1, not_before: 9 }]);
  assert.equal("goal" in moved, false);
  assert.deepEqual(setPose(MOVING, 1, "goal", { x: 2.5 }).robots[1].goal, { x: 2.5, y: 1.5 });
  const { goals: _, ...parked } = a;
  assert.deepEqual(removeGoal(MOVING, 0).robots[0], parked);
});

test("a pointer leads to one of several goals", () => {
  const [a, b] = MOVING.robots;
  assert.equal(goalAt(a, ["goals", "0", "x"]), a.goals[0]);
  assert.equal(goalAt(a, ["goals"]), a.goals[1]);
  assert.equal(goalAt(b, ["goal", "x"]), b.goal);
  assert.equal(goalAt(b, ["start"]), undefined);
});

test("an edit keeps what a robot does already, what it was planned to do, and the obstacles", () => {
  const edited = setRobot(setPose(MOVING, 0, "goal", { theta: 0 }), 1, "radius", 0.2);
  assert.equal(edited.robots[0].committed, COMMITTED);
  assert.equal(edited.robots[0].previous, COMMITTED);
  assert.equal(edited.obstacles, MOVING.obstacles);
  assert.equal(edited.options, MOVING.options);
});

test("a copy of a robot goes to its own last goal and begins anew", () => {
  const copy = duplicateRobot(MOVING, 0, { x: 0.5, y: 1.5 }, { x: 2.5, y: 1.5 }).robots[2];
  assert.equal(copy.committed, undefined);
  assert.equal(copy.previous, undefined);
  assert.deepEqual(copy.goals[1], { x: 2.5, y: 1.5, theta: 1, not_before: 9 });
});

test("the check of goals has the robots at rest at their last goals", () => {
  const { robots, obstacles } = standingAtGoals(MOVING);
  assert.equal(obstacles, undefined);
  assert.deepEqual(
    robots.map(({ start, goal }) => [start.x, start.y, goal === start]),
    [
      [3.5, 1.5, true],
      [1.5, 1.5, true],
    ],
  );
  assert.equal(robots[0].committed, undefined);
  assert.equal(robots[0].goals, undefined);
});

test("the scene has all goals, the committed path and the obstacles", () => {
  const { robots, obstacles } = readScene(MOVING);
  assert.deepEqual(robots[0].goal, { x: 3.5, y: 1.5, theta: 1 });
  assert.deepEqual(robots[0].via, [{ x: 3.5, y: 0.5, theta: null }]);
  assert.deepEqual(robots[0].committed, [
    { x: 0.5, y: 0.5 },
    { x: 1.5, y: 0.5 },
  ]);
  assert.deepEqual(robots[1].via, []);
  assert.equal(obstacles.length, 1);
});

test("faulty goals, actions and obstacles are left out of the scene", () => {
  const odd = {
    robots: [
      { id: "a", radius: 1, start: FROM, goals: [7, { x: 1, y: 1 }], committed: [null, { from: FROM }] },
    ],
    obstacles: [
      null,
      { radius: 1 },
      { radius: 1, motion: [{ t: 0 }] },
      { radius: 0, motion: [{ t: 0, x: 0, y: 0 }] },
    ],
  };
  const { robots, obstacles } = readScene(odd);
  assert.deepEqual(robots[0].via, [null]);
  assert.deepEqual(robots[0].committed, []);
  assert.deepEqual(obstacles, []);
  assert.equal(readScene({ robots: [{ radius: 1, start: FROM, goals: [] }] }).robots[0].goal, null);
});

test("an obstacle moves from entry to entry, and then leaves or stays", () => {
  const [person] = readObstacles(MOVING);
  assert.equal(obstacleAt(person, 1.99), null);
  assert.deepEqual(obstacleAt(person, 2), { x: 0, y: 1 });
  assert.deepEqual(obstacleAt(person, 3), { x: 2, y: 1 });
  assert.deepEqual(obstacleAt(person, 4), { x: 4, y: 1 });
  assert.equal(obstacleAt(person, 4.01), null);
  const [guest] = readObstacles({ obstacles: [{ ...MOVING.obstacles[0], after: "stays" }] });
  assert.deepEqual(obstacleAt(guest, 99), { x: 4, y: 1 });
});

test("a robot without a plan executes its committed actions", () => {
  const scene = readScene(MOVING);
  const failed = { robot: "a", reason: "blocked_by_robots", actions: COMMITTED };
  const tracks = readTracks(scene, /** @type {any} */ ({ plans: [], unplanned: [failed] }));
  assert.equal(robotStateAt(tracks.get("a"), 0.5), "unplanned");
  assert.equal(robotPoseAt(scene.robots[0], tracks.get("a"), 0.5).x, 1);
  assert.equal(robotPoseAt(scene.robots[0], tracks.get("a"), 5).x, 1.5);
});

test("a plan file keeps obstacles with the request and unavoidable collisions with the answer", () => {
  const answer = { plans: [], unplanned: [], unavoidable: [{ robot: "a", obstacle: "person", t: 2 }] };
  const read = readDocument(JSON.parse(JSON.stringify(planFile(MOVING, answer))));
  assert.deepEqual(read.request, MOVING);
  assert.deepEqual(read.answer.unavoidable, answer.unavoidable);
});

test("a service names its goal", () => {
  const wait = { type: "wait", t_start: 1, t_end: 3, from: TO, to: TO };
  assert.equal(actionInWords({ ...wait, goal: 0 }), "wait 2 s at goal 1");
  assert.equal(actionInWords(wait), "wait 2 s");
});
