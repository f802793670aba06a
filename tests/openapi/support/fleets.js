// Realistic fleets on maps of every kind, and requests to plan for them.

import fc from "fast-check";

import { LARGEST_LIST, mostly, valuesOfComponent, within } from "./arbitraries.js";

const CELLS = fc.oneof(
  { weight: 8, arbitrary: fc.constantFrom(".", "G") },
  { weight: 1, arbitrary: fc.constantFrom("#", "@", "O", "T", "W") },
);

/** Rows of equal length. */
const ROWS = fc
  .record({ columns: fc.integer({ min: 1, max: 12 }), rows: fc.integer({ min: 1, max: 10 }) })
  .chain(({ columns, rows }) => {
    const row = fc.array(CELLS, { minLength: columns, maxLength: columns }).map((cells) => cells.join(""));
    return fc.array(row, { minLength: rows, maxLength: rows });
  });

const MAPS = fc
  .record(
    {
      rows: ROWS,
      resolution: mostly(fc.constantFrom(1, 0.5, 0.05), fc.constantFrom(25, 1e-3, 1e4)),
      origin: fc.record({ x: fc.constantFrom(0, -7.5, 1e4), y: fc.constantFrom(0, 3) }),
    },
    { requiredKeys: ["rows"], noNullPrototype: true },
  )
  .filter(({ rows }) => freeCells(rows).length > 0);

function freeCells(rows) {
  return rows.flatMap((row, line) =>
    [...row].flatMap((cell, column) =>
      ".G".includes(cell) ? [{ column, row: rows.length - 1 - line }] : [],
    ),
  );
}

/** The point of a map so many cells right of its lower left corner and above it. */
function pointOf({ resolution = 1, origin = { x: 0, y: 0 } }, column, row) {
  return { x: origin.x + column * resolution, y: origin.y + row * resolution };
}

/** Records of arbitraries, of which only `required` are always there. */
const members = (required, model) => fc.record(model, { requiredKeys: required, noNullPrototype: true });

const METADATA = fc.dictionary(fc.string(), fc.jsonValue({ maxDepth: 2 }), {
  maxKeys: 3,
  noNullPrototype: true,
});

/** Radii and speeds, most of them small enough to fit and usual. */
function traitsOf(document, { resolution = 1 }) {
  const of = (name) => valuesOfComponent(document, name);
  return members(["radius", "linear_speed", "angular_speed"], {
    radius: mostly(within(0.05, 0.5), within(0.5, 1.5)).map((share) => share * resolution),
    linear_speed: mostly(within(0.2, 3), of("LinearSpeed")),
    angular_speed: mostly(within(0.5, 6), of("AngularSpeed")),
    vicinity: mostly(fc.constant(0), within(0, 0.2)).map((share) => share * resolution),
    stop_distance: mostly(fc.constant(0), within(0, 3)).map((share) => share * resolution),
    may_reverse: of("MayReverse"),
  });
}

/** What a robot does at a goal. Few robots have loads. */
function errandsOf({ resolution = 1 }) {
  const radius = within(0.05, 0.5).map((share) => share * resolution);
  const stays = members([], { service: within(0, 5), not_before: within(0, 20), metadata: METADATA });
  const loads = members([], { service: within(0, 5), radius_after: radius, linear_speed_after: within(0.2, 3) });
  return mostly(mostly(fc.constant({}), stays), loads);
}

/** Robots on distinct cells, with last goals on distinct cells. */
function fleets(document, map, free) {
  const near = mostly(fc.constant(0.5), within(0.3, 0.7));
  const heading = valuesOfComponent(document, "Heading");
  const poses = fc.record({ dx: near, dy: near, theta: fc.option(heading, { nil: undefined }) });
  const traits = traitsOf(document, map);
  const goals = fc.record({ pose: poses, errand: errandsOf(map), cell: fc.nat({ max: free.length - 1 }) });
  const place = ({ column, row }, { dx, dy, theta }) => ({
    ...pointOf(map, column + dx, row + dy),
    ...(theta === undefined ? {} : { theta }),
  });
  const robot = fc.record({
    start: poses,
    goal: fc.option(goals),
    before: mostly(fc.constant([]), fc.array(goals, { maxLength: LARGEST_LIST })),
    own: fc.option(traits),
    age: members([], { goal_age: within(0, 100) }),
  });
  const most = Math.min(6, free.length);
  const cells = fc.shuffledSubarray(free, { minLength: most, maxLength: most });
  return fc
    .record({
      robots: fc.array(robot, { minLength: 1, maxLength: most, size: "max" }),
      starts: cells,
      ends: cells,
      robot_defaults: traits,
      ids: fc.uniqueArray(fc.string({ minLength: 1, unit: "grapheme" }), {
        minLength: most,
        maxLength: most,
      }),
    })
    .map(({ robots, starts, ends, robot_defaults, ids }) => ({
      robot_defaults,
      robots: robots.map(({ start, goal, before, own, age }, index) => {
        const one = { id: ids[index], ...own, ...age, start: place(starts[index], start) };
        if (!goal) return one;
        const end = place(ends[index], goal.pose);
        const last = { ...end, ...goal.errand };
        if (before.length === 0) return { ...one, goal: last };
        const passed = before.map(({ pose, errand, cell }, k) => {
          const at = place(free[cell], pose);
          // Some goals may be served at the last one, too.
          const anywhere = cell % 3 === 0 && k > 0;
          const near = cell % 3 === 1 ? { ...at, tolerance: 0.25 } : at;
          return { ...(anywhere ? { any_of: [{ ...at, bias: k }, end] } : near), ...errand };
        });
        return { ...one, goals: [...passed, last] };
      }),
    }));
}

/** A point anywhere on the map, the border included. */
function pointsOn(map) {
  const { rows } = map;
  const shares = fc.record({ x: within(0, 1), y: within(0, 1) });
  return shares.map(({ x, y }) => pointOf(map, x * rows[0].length, y * rows.length));
}

/** Rectangles with rules, most of which leave robots a way. */
function zonesOn(map, ids) {
  const corners = fc.uniqueArray(pointsOn(map), { minLength: 2, maxLength: 2, selector: ({ x }) => x });
  const polygon = corners
    .filter(([a, b]) => a.y !== b.y)
    .map(([a, b]) => [a, { x: b.x, y: a.y }, b, { x: a.x, y: b.y }]);
  const rules = fc.oneof(
    fc.record({ type: fc.constant("speed"), linear_speed: within(0.1, 2), angular_speed: within(0.3, 4) }),
    fc.record({ type: fc.constant("one_way"), heading: within(-4, 4), half_angle: within(1, 3.1) }),
    fc.record({ type: fc.constant("blocked"), robots: fc.constantFrom(...ids).map((id) => [id]) }),
    fc.record({ type: fc.constant("blocked"), enter: fc.constant(false) }),
  );
  return fc
    .array(fc.record({ polygon, rules }), { maxLength: 2 })
    .map((zones) =>
      zones.map(({ polygon: shape, rules: rule }, id) => ({ id: `${id}`, ...rule, polygon: shape })),
    );
}

/** Disks that move across the map, not too fast for its size. */
function obstaclesOn(map) {
  const { resolution = 1 } = map;
  const slow = Math.max(1, resolution);
  const entries = fc.array(fc.record({ point: pointsOn(map), pause: within(0.5, 20) }), {
    minLength: 1,
    maxLength: LARGEST_LIST,
  });
  const obstacle = fc.record({
    radius: within(0.05, 0.4).map((share) => share * resolution),
    after: fc.constantFrom("leaves", "stays"),
    motion: entries.map((all) => {
      let t = -5;
      return all.map(({ point, pause }) => ({ t: (t += pause * slow), ...point }));
    }),
  });
  return fc
    .array(obstacle, { maxLength: 2 })
    .map((all) => all.map((one, number) => ({ id: `obstacle ${number}`, ...one })));
}

const GRAYS = { ".": 254, G: 254 };

/** A raw graymap of rows, in base64. */
function graymap(rows) {
  const header = Buffer.from(`P5\n${rows[0].length} ${rows.length}\n255\n`);
  return Buffer.concat([header, Buffer.from([...rows.join("")].map((cell) => GRAYS[cell] ?? 0))]).toString(
    "base64",
  );
}

/** The same map as one of every kind, by the kind's number. */
function asKind(kind, { rows, resolution, origin }) {
  const frame = { ...(resolution && { resolution }), ...(origin && { origin }) };
  const { x, y } = origin ?? { x: 0, y: 0 };
  const [width, height] = [rows[0].length, rows.length];
  const percents = [...rows].reverse().flatMap((row) => [...row].map((cell) => (GRAYS[cell] ? 0 : 100)));
  switch (kind) {
    case 0:
      return { movingai: `type octile\nheight ${height}\nwidth ${width}\nmap\n${rows.join("\n")}`, ...frame };
    case 1:
      return { image: { pgm: graymap(rows), resolution: resolution ?? 1, origin: [x, y, 0] } };
    case 2:
      return {
        occupancy_grid: {
          info: { resolution: resolution ?? 1, width, height, origin: { position: { x, y } } },
          data: percents,
        },
      };
    default:
      return { rows, ...frame };
  }
}

/** Any options that the schema allows, with short budgets. */
function anyOptions(document) {
  return valuesOfComponent(document, "PlanOptions").map((made) => ({
    ...made,
    time_budget_ms: 1 + ((made.time_budget_ms ?? 0) % 40),
  }));
}

/** Options with which most fleets can be planned, dependencies included. Numbers survive JSON.parse. */
function usualOptions(document, { resolution = 1 }) {
  const seldom = (most) => mostly(fc.constant(0), within(0, most));
  const distance = seldom(0.05).map((share) => share * resolution);
  const usual = fc.record({
    seed: fc.nat(),
    max_iterations: fc.option(fc.nat()),
    start_safe_interval: within(0, 4),
    inflation: distance,
    wait_before_move: seldom(2),
    interval_margin: seldom(1),
    start_overlap: distance,
    goal_overlap: distance,
    execution_margin: distance,
    dependency_slack: within(0.001, 0.5),
    horizon: mostly(fc.constant(null), within(1, 60)),
    lattice_spacing: fc.constant(null),
    dependencies: fc.constant(true),
  });
  return fc.record({ any: anyOptions(document), usual }).map(({ any, usual: tame }) => ({ ...any, ...tame }));
}

/** `optionsOf`: a map's. */
function requestsWith(document, optionsOf) {
  return MAPS.chain((map) =>
    fleets(document, map, freeCells(map.rows)).chain((fleet) =>
      fc.record({
        map: fc.constant(map),
        kind: fc.nat({ max: 5 }),
        fleet: fc.constant(fleet),
        rest: members(["options"], {
          zones: zonesOn(
            map,
            fleet.robots.map(({ id }) => id),
          ),
          obstacles: obstaclesOn(map),
          metadata: METADATA,
          options: optionsOf(document, map),
        }),
      }),
    ),
  ).map(({ map, kind, fleet, rest }) => ({ map: asKind(kind, map), ...fleet, ...rest }));
}

/** Realistic requests to plan, with usual options. */
export const usualRequests = (document) => requestsWith(document, usualOptions);

/** Realistic requests to plan, with usual options or any that the schema allows. */
export function plausibleRequests(document) {
  return fc.oneof(requestsWith(document, anyOptions), usualRequests(document));
}

/** Requests to validate: realistic fleets with plans generated from the schema, most for robots of the request. */
export function plausiblePlans(document) {
  return plausibleRequests(document).chain((request) => {
    const robot = mostly(fc.constantFrom(...request.robots.map(({ id }) => id)), fc.string({ minLength: 1 }));
    const plan = valuesOfComponent(document, "GivenPlan");
    const named = fc.record({ plan, robot }).map(({ plan: made, robot: id }) => ({ ...made, robot: id }));
    const rest = valuesOfComponent(document, "ValidateRequest").map(
      ({ map, robots, robot_defaults, obstacles, zones, options, plans, unavoidable, ...further }) => further,
    );
    return fc
      .record({
        plans: fc.uniqueArray(named, { maxLength: LARGEST_LIST, selector: (one) => one.robot }),
        rest,
      })
      .map(({ plans, rest: further }) => ({ ...further, ...request, plans }));
  });
}
