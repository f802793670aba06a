// Requests generated from the schemas of the document, and realistic fleets.

import fc from "fast-check";

const LARGEST_LIST = 4;

/** Numbers of the schema's range: with few digits, arbitrary ones, and the ends of the range. */
function numbers(schema) {
  const least = schema.minimum ?? -Number.MAX_VALUE;
  const most = schema.maximum ?? Number.MAX_VALUE;
  const inside = (value) => Math.min(Math.max(value, least), most);
  return fc.oneof(
    { weight: 4, arbitrary: fc.integer({ min: -100, max: 100 }).map((value) => inside(value / 4)) },
    { weight: 1, arbitrary: fc.double({ min: least, max: most, noNaN: true }) },
    { weight: 1, arbitrary: fc.constantFrom(least, most, inside(0)) },
  );
}

/** Whole numbers as BigInt, because JavaScript's numbers cannot represent the ends of the ranges. */
function integers(schema) {
  const whole = (value) =>
    value === 18446744073709551615 ? 2n ** 64n - 1n : value === 2 ** 63 ? 2n ** 63n - 1n : BigInt(value);
  const least = whole(schema.minimum);
  const most = whole(schema.maximum);
  return fc.oneof(
    fc.bigInt({ min: least, max: 20n }),
    fc.bigInt({ min: least, max: most }),
    fc.constantFrom(least, most),
  );
}

function objects(document, schema, overrides) {
  const members = Object.entries(schema.properties ?? {}).map(([key, member]) => [
    key,
    valuesOf(document, member, overrides),
  ]);
  return fc.record(Object.fromEntries(members), {
    requiredKeys: schema.required ?? [],
    noNullPrototype: true,
  });
}

function valuesOfType(document, schema, type, overrides) {
  switch (type) {
    case "null":
      return fc.constant(null);
    case "boolean":
      return fc.boolean();
    case "integer":
      return integers(schema);
    case "number":
      return numbers(schema);
    case "string":
      if (schema.pattern) return fc.stringMatching(new RegExp(schema.pattern));
      return fc.string({ minLength: schema.minLength ?? 0, maxLength: 12, unit: "grapheme" });
    case "array":
      if (schema.prefixItems)
        return fc.tuple(...schema.prefixItems.map((item) => valuesOf(document, item, overrides)));
      return fc.array(valuesOf(document, schema.items, overrides), {
        minLength: schema.minItems ?? 0,
        maxLength: LARGEST_LIST,
      });
    case "object":
      return objects(document, schema, overrides);
    default:
      throw new Error(`cannot generate values of type ${type}`);
  }
}

/**
 * Values that fit a schema of the document, without its conditions (`allOf`). `overrides` replaces the arbitraries of
 * components, by name.
 */
export function valuesOf(document, schema, overrides = {}) {
  if (schema.$ref !== undefined) {
    const name = schema.$ref.split("/").at(-1);
    return overrides[name] ?? valuesOf(document, document.root.components.schemas[name], overrides);
  }
  if (schema.enum !== undefined) return fc.constantFrom(...schema.enum);
  if (schema.const !== undefined) return fc.constant(schema.const);
  if (schema.type === undefined && schema.oneOf !== undefined)
    return fc.oneof(...schema.oneOf.map((one) => valuesOf(document, one, overrides)));
  if (schema.type === undefined) return fc.jsonValue({ maxDepth: 3 });
  const types = [schema.type].flat();
  return fc.oneof(...types.map((type) => valuesOfType(document, schema, type, overrides)));
}

/** Values of a component's schema. */
export function valuesOfComponent(document, name, overrides = {}) {
  return valuesOf(document, document.root.components.schemas[name], overrides);
}

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

function freeCells(rows) {
  return rows.flatMap((row, line) =>
    [...row].flatMap((cell, column) =>
      ".G".includes(cell) ? [{ column, row: rows.length - 1 - line }] : [],
    ),
  );
}

const mostly = (usual, any) => fc.oneof({ weight: 7, arbitrary: usual }, { weight: 1, arbitrary: any });

/** Robots on distinct cells, most of them small enough to fit and with usual speeds. */
function fleets(document, map, free) {
  const { resolution = 1, origin = { x: 0, y: 0 } } = map;
  const of = (name) => valuesOfComponent(document, name);
  const within = (least, most) => fc.double({ min: least, max: most, noNaN: true });
  const near = mostly(fc.constant(0.5), within(0.3, 0.7));
  const poses = fc.record({ dx: near, dy: near, theta: fc.option(of("Heading"), { nil: undefined }) });
  const traits = fc.record(
    {
      radius: mostly(within(0.05, 0.5), within(0.5, 1.5)).map((share) => share * resolution),
      linear_speed: mostly(within(0.2, 3), of("LinearSpeed")),
      angular_speed: mostly(within(0.5, 6), of("AngularSpeed")),
    },
    { noNullPrototype: true },
  );
  const place = ({ column, row }, { dx, dy, theta }) => ({
    x: origin.x + (column + dx) * resolution,
    y: origin.y + (row + dy) * resolution,
    ...(theta === undefined ? {} : { theta }),
  });
  const robot = fc.record({ start: poses, goal: fc.option(poses), own: fc.option(traits) });
  const most = Math.min(6, free.length);
  return fc
    .record({
      robots: fc.array(robot, { minLength: 1, maxLength: most }),
      starts: fc.shuffledSubarray(free, { minLength: most, maxLength: most }),
      goals: fc.shuffledSubarray(free, { minLength: most, maxLength: most }),
      robot_defaults: traits,
      ids: fc.uniqueArray(fc.string({ minLength: 1, unit: "grapheme" }), {
        minLength: most,
        maxLength: most,
      }),
    })
    .map(({ robots, starts, goals, robot_defaults, ids }) => ({
      robot_defaults,
      robots: robots.map(({ start, goal, own }, index) => ({
        id: ids[index],
        ...own,
        start: place(starts[index], start),
        ...(goal ? { goal: place(goals[index], goal) } : {}),
      })),
    }));
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

/** Realistic requests to plan, with any options that the schema allows and short budgets. */
export function plausibleRequests(document) {
  const options = valuesOfComponent(document, "PlanOptions").map((made) => ({
    ...made,
    time_budget_ms: 1 + ((made.time_budget_ms ?? 0) % 40),
  }));
  const sizes = fc.constantFrom(1, 0.5, 0.05, 25, 1e-3, 1e4);
  const maps = fc.record(
    {
      rows: ROWS,
      resolution: sizes,
      origin: fc.record({ x: fc.constantFrom(0, -7.5, 1e4), y: fc.constantFrom(0, 3) }),
    },
    { requiredKeys: ["rows"], noNullPrototype: true },
  );
  return maps
    .filter(({ rows }) => freeCells(rows).length > 0)
    .chain((map) =>
      fc.record({
        map: fc.constant(map),
        kind: fc.nat({ max: 5 }),
        fleet: fleets(document, map, freeCells(map.rows)),
        options,
      }),
    )
    .map(({ map, kind, fleet, options: chosen }) => ({ map: asKind(kind, map), ...fleet, options: chosen }));
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
