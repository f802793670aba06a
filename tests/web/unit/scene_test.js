import assert from "node:assert/strict";
import { test } from "node:test";

import { readScene, readTracks, robotPoseAt, robotRadiusAt, robotStateAt } from "../../../web/model/scene.js";

const REQUEST = {
  map: { rows: ["#.", ".G", "@T"], resolution: 0.5, origin: { x: 10, y: -2 } },
  robot_defaults: { radius: 0.2 },
  robots: [
    { id: "amr-1", start: { x: 10.25, y: -1.25, theta: 1 }, goal: { x: 10.75, y: -1.25 } },
    { id: "amr-2", radius: 0.1, start: { x: 10.75, y: -0.75 }, goal: { x: 10.25, y: -1.25, theta: 0 } },
    { id: "amr-30", start: { x: 10.75, y: -1.25 } },
  ],
};

test("the first row is the top of the map", () => {
  const { grid } = readScene(REQUEST);
  assert.deepEqual([...grid.blocked], [1, 0, 0, 0, 1, 1]);
  assert.deepEqual(grid.bounds, { left: 10, bottom: -2, right: 11, top: -0.5 });
});

test("a robot uses the defaults for members it does not set", () => {
  const { robots } = readScene(REQUEST);
  assert.deepEqual(
    robots.map(({ radius }) => radius),
    [0.2, 0.1, 0.2],
  );
  assert.deepEqual(
    robots.map(({ start }) => start.theta),
    [1, 0, 0],
  );
  assert.deepEqual(
    robots.map(({ goal }) => goal?.theta),
    [null, 0, undefined],
  );
});

test("a robot has another radius after a goal that changes it", () => {
  const goals = [
    { x: 0, y: 0, radius_after: 0.4 },
    { x: 1, y: 0 },
    { x: 2, y: 0, radius_after: 0.3 },
  ];
  const scene = readScene({ robots: [{ id: "a", radius: 0.2, start: { x: 0, y: 0 }, goals }] });
  const leaves = [4, 6, null];
  const visits = leaves.map((t_leave, goal) => ({ goal, t_arrive: 0, t_leave }));
  const tracks = readTracks(scene, { plans: [{ robot: "a", cost: 9, actions: [], visits }], unplanned: [] });
  const at = (t) => robotRadiusAt(scene.robots[0], tracks.get("a"), t);
  assert.deepEqual([at(0), at(3.9), at(4), at(8.9), at(9)], [0.2, 0.2, 0.4, 0.4, 0.3]);
  const left = visits.map((visit) => (visit.goal === 2 ? { ...visit, t_arrive: null } : visit));
  const stopped = readTracks(scene, {
    plans: [{ robot: "a", cost: 9, actions: [], visits: left }],
    unplanned: [],
  });
  assert.equal(robotRadiusAt(scene.robots[0], stopped.get("a"), 9), 0.4, "beyond the horizon");
});

test("a track tells at which goals its robot is late", () => {
  const scene = readScene(REQUEST);
  const visits = [
    { goal: 0, t_arrive: 3, late_by: 0 },
    { goal: 1, t_arrive: 9, late_by: 2.5 },
    { goal: 2, t_arrive: 12 },
    { goal: 3, t_arrive: null, late_by: null },
  ];
  const plan = { robot: "amr-1", actions: [], visits };
  assert.deepEqual(readTracks(scene, { plans: [plan] }).get("amr-1").late, [{ goal: 1, seconds: 2.5 }]);
  assert.deepEqual(readTracks(scene, null).get("amr-1").late, []);
});

test("robots that make way are told from those that stay", () => {
  const robots = ["stay", "yield", "return", undefined].map((idle, at) => ({
    ...REQUEST.robots[0],
    id: `amr-${at}`,
    idle,
  }));
  const { robots: read } = readScene({ ...REQUEST, robots });
  assert.deepEqual(
    read.map(({ makesWay }) => makesWay),
    [false, true, true, false],
  );
});

test("a goal at one of several poses is the one that the plan has chosen", () => {
  const docks = [
    { x: 10.25, y: -1.25 },
    { x: 10.75, y: -0.75, theta: 1, bias: 5 },
  ];
  const goals = [{ any_of: docks }, { x: 10.25, y: -0.75 }, { any_of: docks }];
  const scene = readScene({ ...REQUEST, robots: [{ ...REQUEST.robots[0], goal: undefined, goals }] });
  const [{ alternatives, via, goal }] = scene.robots;
  const poses = [
    { x: 10.25, y: -1.25, theta: null },
    { x: 10.75, y: -0.75, theta: 1 },
  ];
  assert.deepEqual(alternatives, [poses, [], poses]);
  assert.deepEqual([...via, goal], [null, { x: 10.25, y: -0.75, theta: null }, null]);
  assert.equal(readTracks(scene, null).get("amr-1").status, "ready");
  const visits = [
    { goal: 0, choice: 1 },
    { goal: 1, t_arrive: 2 },
    { goal: 2, choice: null }, // beyond the horizon
  ];
  const plan = { robot: "amr-1", actions: [], visits };
  const { chosen } = readTracks(scene, { plans: [plan] }).get("amr-1");
  assert.deepEqual(chosen, [poses[1], null, null]);
});

test("labels omit the common prefix of all ids but never split a number", () => {
  const labels = (...ids) =>
    readScene({ robots: ids.map((id) => ({ id, radius: 1, start: { x: 0, y: 0 } })) }).robots.map(
      ({ label }) => label,
    );
  assert.deepEqual(labels("amr-1", "amr-2", "amr-30"), ["1", "2", "30"]);
  assert.deepEqual(labels("r10", "r11"), ["10", "11"]);
  assert.deepEqual(labels("east", "west"), ["east", "west"]);
  assert.deepEqual(labels("solo"), ["solo"]);
});

test("a faulty request is read as far as it makes sense", () => {
  assert.equal(readScene(null).grid, null);
  assert.equal(readScene({ map: { rows: "..." } }).grid, null);
  assert.equal(readScene({ map: { rows: [] }, robots: {} }).robots.length, 0);
  const odd = {
    map: { rows: ["..", 7, "."], resolution: -1 },
    robots: [null, { id: "a" }, REQUEST.robots[1]],
  };
  const scene = readScene(odd);
  assert.deepEqual([scene.grid.columns, scene.grid.rows, scene.grid.resolution], [2, 2, 1]);
  assert.deepEqual(
    scene.robots.map(({ id, index }) => [id, index]),
    [["amr-2", 2]],
  );
});

test("before an answer robots are ready or parked where they start", () => {
  const scene = readScene(REQUEST);
  const tracks = readTracks(scene, null);
  assert.deepEqual(
    scene.robots.map(({ id }) => robotStateAt(tracks.get(id), 0)),
    ["ready", "ready", "parked"],
  );
  assert.deepEqual(robotPoseAt(scene.robots[0], tracks.get("amr-1"), 5), { x: 10.25, y: -1.25, theta: 1 });
});

test("an answer determines which robots move, stay or have no plan", () => {
  const from = { x: 10.25, y: -1.25, theta: 0 };
  const to = { x: 10.75, y: -1.25, theta: 0 };
  const move = { type: "translate", t_start: 0, t_end: 1, from, to };
  const answer = {
    plans: [
      { robot: "amr-1", cost: 1, actions: [move] },
      { robot: "amr-30", cost: 0, actions: [] },
    ],
    unplanned: [{ robot: "amr-2", reason: "goal_blocked", detail: "", blocked_by: [] }],
  };
  const scene = readScene(REQUEST);
  const tracks = readTracks(scene, answer);
  const states = (t) => scene.robots.map(({ id }) => robotStateAt(tracks.get(id), t));
  assert.deepEqual(states(0.5), ["moving", "unplanned", "parked"]);
  assert.deepEqual(states(1), ["arrived", "unplanned", "parked"]);
  assert.deepEqual(tracks.get("amr-1").path.length, 2);
});
