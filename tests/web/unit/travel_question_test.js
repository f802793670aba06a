import assert from "node:assert/strict";
import { test } from "node:test";

import { readScene } from "../../../web/model/scene.js";
import { TravelQuestion } from "../../../web/model/travel_question.js";

const MAP = { rows: ["....", "...."] };
const ROBOT = {
  id: "a",
  linear_speed: 2,
  start: { x: 0.5, y: 0.5, theta: 1 },
  goal: { x: 3.5, y: 0.5 },
  weight: 2,
};
const REQUEST = {
  map: MAP,
  robot_defaults: { radius: 0.3, linear_speed: 1, angular_speed: 3, vicinity: 0.2 },
  robots: [{ ...ROBOT, id: "b" }, ROBOT],
  options: { mode: "first", connectivity: 8 },
};
const PLACES = [{ x: 2.5, y: 1.5 }];

const asked = (request) => new TravelQuestion(request, readScene(request).robots[1]);
const bodyOf = (request) => JSON.parse(asked(request).body(PLACES, 900));
const blocked = (more) => ({
  id: "z",
  type: "blocked",
  polygon: [
    { x: 2, y: 0 },
    { x: 3, y: 0 },
    { x: 3, y: 1 },
  ],
  ...more,
});

test("the body has the map, what the robot can do, the options that count, and the ways back", () => {
  assert.deepEqual(bodyOf(REQUEST), {
    map: MAP,
    robot: { id: "a", radius: 0.3, linear_speed: 2, angular_speed: 3 },
    options: { connectivity: 8, time_budget_ms: 900 },
    from: PLACES,
    to: [{ x: 0.5, y: 0.5, theta: 1 - Math.PI }],
  });
  assert.deepEqual(asked(REQUEST).secondsOf({ seconds: [[1], [null], [3]] }), [1, null, 3]);
});

test("where ways back take another time, the ways there are asked for", () => {
  const [accelerates, brakes] = [{ linear_acceleration: 1 }, { linear_deceleration: 2 }];
  const changed = (members) => ({
    ...REQUEST,
    robots: [REQUEST.robots[0], { ...ROBOT, ...members }],
  });
  for (const request of [
    changed({ ...accelerates, ...brakes }),
    { ...REQUEST, options: { inflation: 0.1 } },
    { ...REQUEST, zones: [blocked({ enter: false })] },
    { ...REQUEST, zones: [blocked({ type: "one_way", heading: 0, robots: ["a"] })] },
  ]) {
    const { from, to } = bodyOf(request);
    assert.deepEqual([from, to], [[{ x: 0.5, y: 0.5, theta: 1 }], PLACES]);
    assert.deepEqual(asked(request).secondsOf({ seconds: [[1, null, 3]] }), [1, null, 3]);
  }
  for (const request of [
    changed(accelerates),
    changed({ ...accelerates, linear_deceleration: 1 }),
    { ...REQUEST, zones: [blocked({}), blocked({ type: "one_way", heading: 0, robots: ["b"] })] },
  ]) {
    assert.ok(asked(request).isBack);
  }
});

test("a question is the same as long as nothing changes that its answers depend on", () => {
  const question = asked(REQUEST);
  const same = (request) => question.isSameAs(asked(request));
  const [other, robot] = REQUEST.robots;
  assert.ok(
    same({
      ...REQUEST,
      robots: [
        { ...other, start: { x: 3.5, y: 1.5 } },
        { ...robot, goal: PLACES[0] },
      ],
    }),
  );
  assert.ok(same({ ...REQUEST, options: { ...REQUEST.options, mode: "anytime" } }));
  assert.equal(same({ ...REQUEST, map: { ...MAP } }), false);
  assert.equal(same({ ...REQUEST, zones: [blocked({})] }), false);
  assert.equal(same({ ...REQUEST, robots: [other, { ...robot, start: PLACES[0] }] }), false);
  assert.equal(same({ ...REQUEST, robot_defaults: { ...REQUEST.robot_defaults, radius: 0.2 } }), false);
  assert.equal(question.isSameAs(null), false);
});

test("faults are told at their places in the request", () => {
  const at = (request, pointer) => asked(request).atItsPlace({ pointer, detail: "" }).pointer;
  assert.equal(at(REQUEST, "/robot/radius"), "/robots/1/radius");
  assert.equal(at(REQUEST, "/robot"), "/robots/1");
  assert.equal(at(REQUEST, "/to/0"), "/robots/1/start");
  assert.equal(at(REQUEST, "/options/inflation"), "/options/inflation");
  assert.equal(at({ ...REQUEST, options: { inflation: 0.1 } }, "/from/0/theta"), "/robots/1/start/theta");
});
