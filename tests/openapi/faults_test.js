// Provokes every fault code: 422 with the code and a pointer to the faulty place.

import assert from "node:assert/strict";
import { test } from "node:test";

import { misplaced } from "./support/pointer.js";
import { openSession } from "./support/session.js";

const { document, client } = await openSession(["--max-robots", "3", "--max-cells", "100"]);
const seen = new Set();

const POSE = { x: 0.5, y: 0.5, theta: 0 };
const WAIT = { type: "wait", t_start: 0, t_end: 1, from: POSE, to: POSE };

/** A valid request, modified by `change`. */
function request(change) {
  const good = {
    map: { rows: ["....#", "....."], resolution: 1, origin: { x: 0, y: 0 } },
    robot_defaults: { radius: 0.3, linear_speed: 1, angular_speed: 2 },
    robots: [
      { id: "a", start: { x: 0.5, y: 0.5 }, goal: { x: 3.5, y: 0.5 } },
      { id: "b", start: { x: 0.5, y: 1.5 }, goal: { x: 3.5, y: 1.5, theta: 1 } },
    ],
    options: { mode: "first" },
  };
  change(good);
  return good;
}

/** A request with a plan: robot "a" stays where it is for a second. */
function execution(change) {
  const good = request((r) => {
    r.robots = [r.robots[0]];
    r.robots[0].goal = { x: 0.5, y: 0.5 };
    r.plans = [{ robot: "a", actions: [WAIT] }];
    change(r);
  });
  return good;
}

/** By name: path, request, and the expected pairs of pointer and code. */
const CASES = {
  "dependencies of a plan that begins late": [
    "/v1/dependencies",
    execution((r) => (r.plans[0].actions[0] = { ...WAIT, t_start: 0.5 })),
    [["/plans/0/actions/0", "invalid_plan"]],
  ],
  "a dependency of other plans": [
    "/v1/export/vda5050",
    {
      version: "2.1.0",
      manufacturer: "acme",
      timestamp: "2026-01-31T12:00:00Z",
      ...execution((r) => {
        r.robots.push({ id: "b", start: { x: 3.5, y: 1.5 } });
        r.dependencies = [
          { gate: { robot: "a", action: 0, progress: 1 }, until: { robot: "b", action: 0, progress: 0 } },
        ];
      }),
    },
    [["/dependencies/0/until/action", "dependency"]],
  ],
  "a document that is not an object": ["/v1/plan", [], [["", "wrong_type"]]],
  "an empty object": [
    "/v1/plan",
    {},
    [
      ["/map", "missing"],
      ["/robots", "missing"],
    ],
  ],
  "a number that is a string": [
    "/v1/plan",
    request((r) => (r.robots[1].start.x = "1")),
    [["/robots/1/start/x", "wrong_type"]],
  ],
  "null instead of an object": [
    "/v1/plan",
    request((r) => (r.robots[0].goal = null)),
    [["/robots/0/goal", "wrong_type"]],
  ],
  "a robot without start": [
    "/v1/plan",
    request((r) => delete r.robots[0].start),
    [["/robots/0/start", "missing"]],
  ],
  "a speed missing from robot and defaults": [
    "/v1/plan",
    request((r) => delete r.robot_defaults.linear_speed),
    [
      ["/robots/0/linear_speed", "missing"],
      ["/robots/1/linear_speed", "missing"],
    ],
  ],
  "keys that need escapes in a pointer": [
    "/v1/plan",
    request((r) => Object.assign(r.options, { "a/b~c": 1, "": 2, "\u{1f916}": 3 })),
    [
      ["/options/a~1b~0c", "unknown_key"],
      ["/options/", "unknown_key"],
      ["/options/\u{1f916}", "unknown_key"],
    ],
  ],
  "an unknown mode": [
    "/v1/plan",
    request((r) => (r.options.mode = "frist")),
    [["/options/mode", "unknown_value"]],
  ],
  "a radius of 0": [
    "/v1/plan",
    request((r) => (r.robots[0].radius = 0)),
    [["/robots/0/radius", "out_of_range"]],
  ],
  "a connectivity of 5": [
    "/v1/plan",
    request((r) => (r.options.connectivity = 5)),
    [["/options/connectivity", "out_of_range"]],
  ],
  "more robots than the service accepts": [
    "/v1/plan",
    request((r) => r.robots.push(...["c", "d"].map((id) => ({ ...r.robots[0], id })))),
    [["/robots", "out_of_range"]],
  ],
  "more cells than the service accepts": [
    "/v1/plan",
    request((r) => (r.map.rows = Array(21).fill("....."))),
    [["/map/rows", "out_of_range"]],
  ],
  "no robots": ["/v1/plan", request((r) => (r.robots = [])), [["/robots", "empty"]]],
  "an empty id": ["/v1/plan", request((r) => (r.robots[1].id = "")), [["/robots/1/id", "empty"]]],
  "a row without cells": ["/v1/plan", request((r) => (r.map.rows[1] = "")), [["/map/rows/1", "empty"]]],
  "a row of another length": [
    "/v1/plan",
    request((r) => (r.map.rows[1] = "....")),
    [["/map/rows/1", "bad_map_row"]],
  ],
  "an unknown kind of cell": [
    "/v1/plan",
    request((r) => (r.map.rows[0] = "..?.#")),
    [["/map/rows/0", "bad_map_row"]],
  ],
  "an image that is cut off": [
    "/v1/plan",
    request((r) => (r.map = { image: { pgm: "UDUgOSA5IDI1NQo=", resolution: 1 } })), // a header only
    [["/map/image/pgm", "bad_image"]],
  ],
  "a text that is not a MovingAI map": [
    "/v1/plan",
    request((r) => (r.map = { movingai: "....#" })),
    [["/map/movingai", "bad_movingai"]],
  ],
  "a zone whose border crosses itself": [
    "/v1/plan",
    request((r) => {
      const polygon = [{ x: 0, y: 3 }, { x: 2, y: 4 }, { x: 2, y: 3 }, { x: 0, y: 4 }];
      r.zones = [{ id: "z", type: "blocked", polygon }];
    }),
    [["/zones/0/polygon", "bad_polygon"]],
  ],
  "a committed action that is too fast for a zone": [
    "/v1/plan",
    request((r) => {
      const from = { x: 0.5, y: 1.5, theta: 0 };
      r.robots[1].committed = [{ type: "translate", t_start: 0, t_end: 2, from, to: { ...from, x: 2.5 } }];
      const polygon = [{ x: 1, y: 1 }, { x: 2, y: 1 }, { x: 2, y: 2 }, { x: 1, y: 2 }];
      r.zones = [{ id: "z", type: "speed", linear_speed: 0.5, polygon }];
    }),
    [["/robots/1/committed/0", "committed_in_zone"]],
  ],
  "an occupancy grid with too few cells": [
    "/v1/plan",
    request((r) => (r.map = { occupancy_grid: { info: { resolution: 1, width: 5, height: 2 }, data: [0] } })),
    [["/map/occupancy_grid/data", "wrong_size"]],
  ],
  "a map of two kinds": ["/v1/plan", request((r) => (r.map.movingai = "")), [["/map/movingai", "duplicate"]]],
  "two robots with one id": [
    "/v1/plan",
    request((r) => (r.robots[1].id = "a")),
    [["/robots/1/id", "duplicate"]],
  ],
  "a repeated key": [
    "/v1/plan",
    JSON.stringify(request(() => {})).replace('"mode"', '"mode":"first","mode"'),
    [["/options/mode", "duplicate"]],
  ],
  "a start in a wall": [
    "/v1/plan",
    request((r) => (r.robots[0].start = { x: 4.5, y: 1.5 })),
    [["/robots/0/start", "start_in_obstacle"]],
  ],
  "a goal off the map": [
    "/v1/plan",
    request((r) => (r.robots[0].goal.y = -1)),
    [["/robots/0/goal", "goal_in_obstacle"]],
  ],
  "starts that overlap": [
    "/v1/plan",
    request((r) => (r.robots[1].start.y = 1)),
    [["/robots/1/start", "starts_overlap"]],
  ],
  "goals that overlap": [
    "/v1/plan",
    request((r) => (r.robots[1].goal.y = 1)),
    [["/robots/1/goal", "goals_overlap"]],
  ],
  "goal and goals": [
    "/v1/plan",
    request((r) => (r.robots[0].goals = [])),
    [["/robots/0/goals", "duplicate"]],
  ],
  "committed actions with a gap in time": [
    "/v1/plan",
    request((r) => (r.robots[0].committed = [WAIT, { ...WAIT, t_start: 2, t_end: 3 }])),
    [["/robots/0/committed/1/t_start", "discontinuity"]],
  ],
  "a committed action that is too fast": [
    "/v1/plan",
    request((r) => (r.robots[0].committed = [{ ...WAIT, type: "translate", to: { ...POSE, x: 2.5 } }])),
    [["/robots/0/committed/0", "speed"]],
  ],
  "a committed action whose profile covers less": [
    "/v1/plan",
    request((r) => {
      r.robots[0].linear_acceleration = 1;
      const profile = { start: 0, cruise: 0.1, end: 0 };
      r.robots[0].committed = [{ ...WAIT, type: "translate", to: { ...POSE, x: POSE.x + 0.5 }, profile }];
    }),
    [["/robots/0/committed/0/profile", "profile"]],
  ],
  "committed motion into a wall": [
    "/v1/plan",
    request((r) => {
      const from = { x: 0.5, y: 1.5, theta: 0 };
      r.robots[1].committed = [{ type: "translate", t_start: 0, t_end: 4, from, to: { ...from, x: 4.5 } }];
    }),
    [["/robots/1/committed/0", "committed_collision"]],
  ],
  "an obstacle whose times do not ascend": [
    "/v1/plan",
    request((r) => {
      const motion = [2, 1].map((t) => ({ t, x: 0.5, y: 0.5 }));
      r.obstacles = [{ id: "person", radius: 0.3, motion }];
    }),
    [["/obstacles/0/motion/1/t", "out_of_range"]],
  ],
  "an unavoidable collision with an unknown obstacle": [
    "/v1/validate",
    request((r) => Object.assign(r, { plans: [], unavoidable: [{ robot: "a", obstacle: "x", t: 0 }] })),
    [["/unavoidable/0/obstacle", "unknown_obstacle"]],
  ],
  "a plan for an unknown robot": [
    "/v1/validate",
    request((r) => (r.plans = [{ robot: "z", actions: [] }])),
    [["/plans/0/robot", "unknown_robot"]],
  ],
  "two plans for one robot": [
    "/v1/validate",
    request((r) => (r.plans = ["a", "a"].map((robot) => ({ robot, actions: [WAIT] })))),
    [["/plans/1/robot", "duplicate"]],
  ],
  "an action of an unknown type without t_end": [
    "/v1/validate",
    request(
      (r) => (r.plans = [{ robot: "a", actions: [{ type: "fly", t_start: 0, from: POSE, to: POSE }] }]),
    ),
    [
      ["/plans/0/actions/0/type", "unknown_value"],
      ["/plans/0/actions/0/t_end", "missing"],
    ],
  ],
  "a tolerance below 0": [
    "/v1/validate",
    request((r) => Object.assign(r, { plans: [], tolerance: -1 })),
    [["/tolerance", "out_of_range"]],
  ],
};

for (const [name, [path, body, expected]] of Object.entries(CASES)) {
  test(`${name} is reported at its place`, async () => {
    const { status, json } = await client.post(path, body);
    assert.equal(status, 422);
    assert.deepEqual(
      json.errors.map(({ pointer, code }) => [pointer, code]),
      expected,
    );
    const sent = typeof body === "string" ? JSON.parse(body) : body;
    for (const fault of json.errors) {
      assert.equal(misplaced(fault, sent), undefined);
      seen.add(fault.code);
    }
  });
}

test("every documented fault code was provoked", () => {
  assert.deepEqual([...seen].sort(), [...document.root.components.schemas.Fault.properties.code.enum].sort());
});
