// Requests about plans that the service made: to simulate, advance, retime and export them.

import assert from "node:assert/strict";
import fc from "fast-check";

import { mostly, valuesOfComponent, within } from "./arbitraries.js";
import { textOf } from "./text.js";

const moving = (plans) => plans.filter(({ actions }) => actions.length > 0);

/** Times until a little after one of the plans has ended. */
const momentsOf = (plans) =>
  fc
    .record({ plan: fc.constantFrom(...moving(plans)), share: within(0, 1.1) })
    .map(({ plan, share }) => share * plan.actions.at(-1).t_end);

/** Where a robot with these actions is at a time, seconds. */
function poseAt(actions, t) {
  const under = actions.find(({ t_end }) => t < t_end);
  if (under === undefined) return actions.at(-1).to;
  const { t_start, t_end, from, to } = under;
  const share = (t - t_start) / (t_end - t_start);
  const between = (axis) => from[axis] + share * (to[axis] - from[axis]);
  const turn = Math.atan2(Math.sin(to.theta - from.theta), Math.cos(to.theta - from.theta));
  return { x: between("x"), y: between("y"), theta: from.theta + share * turn };
}

const goalsOf = ({ goal, goals }) => goals ?? (goal ? [goal] : []);
/** The goals that have one pose. */
const placedGoalsOf = (robot) => goalsOf(robot).filter(({ any_of }) => any_of === undefined);

/** One value for some of the items. */
function ofSome(items, make) {
  return fc.tuple(...items.map((item) => fc.option(make(item)))).map((made) => made.filter(Boolean));
}

/** Some progress of each of some plans with actions. */
const progressOf = ({ robot, actions }) =>
  fc.record({
    robot: fc.constant(robot),
    action: fc.nat({ max: actions.length - 1 }),
    progress: mostly(within(0, 1), fc.constantFrom(0, 1)),
  });

/** Requests and the service's answers to them, {request, answer}, in which robots move. */
async function planned(client, requests) {
  const all = [];
  for (const request of requests) {
    const { status, json } = await client.post("/v1/plan", textOf(request));
    if (status === 200 && moving(json.plans).length > 0) all.push({ request, answer: json });
  }
  return all;
}

/**
 * Fleets and their plans, {request, answer}: `count` of `requests` that are planned at rest, and then once more in
 * motion, with committed and previous actions.
 */
export async function plannedFleets(client, requests, count, seed) {
  const first = await planned(client, fc.sample(requests, { numRuns: count, seed }));
  const inMotion = [];
  for (const { request, answer } of first) {
    const at = moving(answer.plans)[0].actions.at(-1).t_end / 3;
    const next = await client.post("/v1/advance", textOf({ request, plans: answer.plans, at }));
    if (next.status === 200) inMotion.push(next.json);
  }
  const all = [...first, ...(await planned(client, inMotion))];
  assert.ok(all.length >= count / 4, "too few fleets can be planned");
  return all;
}

/** A member of an object; undefined for what all objects have: robots may be called "toString". */
const ownOf = (object, key) => (Object.hasOwn(object, key) ? object[key] : undefined);

/** Arbitraries of requests about the planned fleets, which the service has to accept. */
export class Executions {
  #document;
  #fleets;

  constructor(document, fleets) {
    this.#document = document;
    this.#fleets = fc.constantFrom(...fleets);
  }

  /** Requests to plan, half of them of fleets in motion. */
  requests() {
    return this.#fleets.map(({ request }) => request);
  }

  /** Requests with their plans, as /v1/validate and /v1/dependencies take them. */
  checks() {
    const rest = fc.record({ tolerance: within(1e-6, 1e-3) }, { requiredKeys: [], noNullPrototype: true });
    return this.#fleets.chain((fleet) => rest.map((further) => ({ ...merged(fleet), ...further })));
  }

  /** Disturbances of real robots; some of them disturb nothing. */
  #disturbances() {
    const spread = (least, most) =>
      fc.tuple(within(least, most), within(least, most)).map(([a, b]) => ({
        min: Math.min(a, b),
        max: Math.max(a, b),
      }));
    const any = valuesOfComponent(this.#document, "Disturbance");
    const disturbance = fc.record({
      any,
      speed: spread(0.3, 1.2),
      turn: spread(0.3, 1.2),
      start_delay: spread(0, 3),
    });
    return disturbance.map(({ any: wild, ...tame }) => ({ ...wild, ...tame }));
  }

  simulations() {
    const disturbance = this.#disturbances();
    const runs = mostly(fc.integer({ min: 1, max: 30 }), fc.integer({ min: 1, max: 100_000 }));
    return this.#fleets.chain((fleet) => {
      const policies = ["open_loop", "absorb_waits", "clock_stop"];
      if (fleet.answer.dependencies) policies.push("dependencies");
      return fc
        .record({
          policy: fc.constantFrom(...policies),
          max_delay: within(0, 3),
          disturbance,
          runs,
          trace: fc.option(fc.nat()),
          seed: fc.nat(),
        })
        .map(({ trace, ...rest }) => ({
          ...merged(fleet),
          ...rest,
          ...(trace === null ? {} : { trace: trace % rest.runs }),
        }));
    });
  }

  /** Margins of requests, with few runs. */
  margins() {
    const rest = fc.record({
      policy: fc.constantFrom("open_loop", "absorb_waits", "dependencies", "clock_stop"),
      max_delay: within(0, 3),
      disturbance: this.#disturbances(),
      aim: fc.record({ collisions: within(0.2, 0.5), confidence: within(0.5, 0.95) }),
      runs: fc.integer({ min: 100, max: 400 }),
      seed: fc.nat(),
      try: fc.record({
        interval_margin: fc.constantFrom([0], [0, 1], [0.5, 2]),
        inflation: fc.constantFrom([0], [0, 0.01]),
      }),
    });
    return fc.record({ request: this.requests(), rest }).map(({ request, rest }) => ({ request, ...rest }));
  }

  /** Travel times of a robot from its start to its goals, as far as they are places for its smallest disk. */
  matrices() {
    return this.#fleets.chain(({ request, answer }) => {
      const { map, zones, options, robots, robot_defaults } = request;
      const pose = ({ x, y, theta }) => ({ x, y, ...(theta === undefined ? {} : { theta }) });
      const planned = answer.plans.map(({ robot }) => robot);
      const travellers = robots.filter((robot) => planned.includes(robot.id) && goalsOf(robot).length > 0);
      return fc
        .record({
          robot: fc.constantFrom(...travellers),
          rows: fc.integer({ min: 1, max: 3 }),
          with_zones: fc.boolean(),
        })
        .map(
          ({ robot: { start, goal, goals, committed, previous, goal_age, ...traits }, rows, with_zones }) => {
            const to = placedGoalsOf({ goal, goals });
            const radius = smallestRadius({ robots: [{ ...traits, goal, goals }], robot_defaults });
            return {
              map,
              ...(with_zones && zones ? { zones } : {}),
              ...(options ? { options } : {}),
              robot: { ...robot_defaults, ...traits, radius },
              from: Array(rows).fill(pose(start)),
              to: to.map(pose),
            };
          },
        );
    });
  }

  /** Tasks at goals that robots have, for some of the robots. */
  assignments() {
    return this.#fleets.chain(({ request }) => {
      const robot = fc.constantFrom(...request.robots.map(({ id }) => id));
      const goals = request.robots.flatMap(placedGoalsOf);
      const task = fc.record(
        {
          id: fc.uuid(),
          goals: fc.array(fc.constantFrom(...goals), { minLength: 1, maxLength: 3 }),
          robots: fc.uniqueArray(robot, { minLength: 1, maxLength: 3 }),
          weight: within(0.001, 1000),
          due: within(0, 1e8),
        },
        { requiredKeys: ["id", "goals"], noNullPrototype: true },
      );
      return fc.record({ request: fc.constant(request), tasks: fc.array(task, { maxLength: 6 }) });
    });
  }

  retimings() {
    return this.#fleets.chain(({ request, answer }) => {
      const { robots, robot_defaults, options } = request;
      const paces = fc.record(
        { speed_factor: mostly(within(0.3, 1.2), within(1e-3, 1e3)), held_s: within(0, 30) },
        { requiredKeys: [], noNullPrototype: true },
      );
      const state = (plan) =>
        fc.record({ at: progressOf(plan), pace: paces }).map(({ at, pace }) => ({ ...at, ...pace }));
      return fc.record({
        robots: fc.constant(robots),
        robot_defaults: fc.constant(robot_defaults),
        plans: fc.constant(answer.plans),
        dependencies: fc.constant(answer.dependencies ?? []),
        options: fc.constant(options),
        at: momentsOf(answer.plans),
        states: ofSome(moving(answer.plans), state),
      });
    });
  }

  orders() {
    const text = fc.string({ minLength: 1, maxLength: 20, unit: "grapheme" });
    const leaves = ({ actions }) => actions.some(({ type }) => type === "translate");
    const order = (plan) =>
      fc.record({
        order_id: fc.option(text),
        order_update_id: fc.nat(),
        last_released_sequence_id: leaves(plan) ? fc.constantFrom(0, 2) : fc.constant(0), // of a node that it has
      });
    return this.#fleets.chain(({ request, answer }) => {
      const { map, robots, robot_defaults, options } = request;
      const progress = (plan) =>
        fc
          .record({ at: progressOf(plan), order: fc.option(order(plan)) })
          .map(({ at, order: of }) => ({ ...at, ...of }));
      const ids = robots.map(({ id }) => id);
      return fc
        .record({
          version: fc.constantFrom("2.1.0", "3.0.0"),
          manufacturer: text,
          timestamp: fc
            .date({ min: new Date(0), max: new Date("9999-12-31"), noInvalidDate: true })
            .map((date) => date.toISOString()),
          map_id: text,
          manufacturers: ofSome(ids, (id) => text.map((make) => [id, make])).map(Object.fromEntries),
          serial_numbers: ofSome(ids, (id) => text.map((serial) => [id, serial])).map(Object.fromEntries),
          progress: ofSome(moving(answer.plans), progress),
        })
        .map((header) => ({
          ...header,
          map,
          robots,
          robot_defaults,
          options,
          plans: answer.plans,
          dependencies: answer.dependencies ?? [],
        }));
    });
  }

  /** What vehicles report that have got orders of the plans, and some orders that they had before. */
  reports() {
    const text = fc.string({ minLength: 1, maxLength: 20, unit: "grapheme" });
    const number = fc.nat({ max: 20 });
    return this.orders().chain((body) => {
      const serial = ({ id }) => ownOf(body.serial_numbers, id) ?? id;
      const serials = body.robots.map(serial);
      const vehicles = body.robots.filter((robot, k) => serials.indexOf(serial(robot)) === k);
      const message = (robot) =>
        fc.record({
          serialNumber: fc.constant(serial(robot)),
          manufacturer: fc.constant(ownOf(body.manufacturers, robot.id) ?? body.manufacturer),
          orderId: fc.oneof(text, fc.constant(""), fc.constant(orderOf(body, robot.id) ?? "")),
          orderUpdateId: number,
          lastNodeId: fc.constantFrom("n", "", null),
          lastNodeSequenceId: number,
          agvPosition: fc.constant({
            ...robot.start,
            theta: robot.start.theta ?? 0,
            mapId: "map",
            positionInitialized: true,
          }),
          actionStates: fc.array(
            fc.record({ actionId: text, actionStatus: fc.constantFrom("RUNNING", "FINISHED", "FAILED") }),
            { maxLength: 3 },
          ),
          operatingMode: fc.constantFrom("AUTOMATIC", "MANUAL", "INTERVENED", null, 7),
          paused: fc.constantFrom(false, true, null),
          nodeStates: fc.constantFrom([], [{ sequenceId: 2 }], null, {}),
        });
      const anything = fc.constantFrom(7, null, {}, { serialNumber: serials[0] }, { serialNumber: "nobody" });
      return fc
        .record({
          messages: fc
            .tuple(ofSome(vehicles, message), fc.array(anything, { maxLength: 2 }))
            .map((lists) => lists.flat()),
          allowed_deviation: within(0, 1),
          release_ahead: within(1e6, 1e8), // robots may be very slow
        })
        .map((further) => ({ ...body, ...further }));
    });
  }

  /**
   * Later moments of the plans. Robots are late together, by the same time. If each were late on its own, another robot
   * might have come to its place meanwhile, which is no fault of the service. Robots are measured, or report how far
   * they are. Starts may overlap by as much as poses are off the plans. New goals are goals that the robot has had.
   */
  moments() {
    return this.#fleets.chain(({ request, answer }) => {
      const { robots, options } = request;
      const keepsRadius = (robot) => goalsOf(robot).every(({ radius_after }) => radius_after === undefined);
      const again = (robot) => fc.constant({ robot: robot.id, goals: goalsOf(robot) });
      const hold = ({ id }) => fc.record({ robot: fc.constant(id), until: within(0, 20) });
      const error = fc.record({ x: within(-1, 1), y: within(-1, 1), theta: within(-1, 1) });
      const measured = fc.record({
        late: within(0, 2),
        off: mostly(fc.constant(0), within(0, 0.2)), // shares of the smallest radius; radians
        tolerance: within(0.001, 0.3),
        errors: fc.tuple(...answer.plans.map(() => error)),
        reports: fc.boolean(),
      });
      return fc
        .record({
          at: momentsOf(answer.plans),
          measured: fc.option(measured),
          rest: fc.record(
            {
              commit: within(0, 10),
              holds: ofSome(robots, hold),
              goals: ofSome(robots.filter(keepsRadius), again),
            },
            { requiredKeys: [], noNullPrototype: true },
          ),
        })
        .map(({ at, measured: how, rest }) => {
          const moment = { request, plans: answer.plans, at, ...rest };
          if (how === null) return moment;
          // A robot that stands may be that far from where its plan has it, and is taken to be there.
          const radius = smallestRadius(request);
          const pose_tolerance = how.tolerance * radius;
          const start_overlap = options.start_overlap + 3 * (how.off * radius + pose_tolerance);
          const then = Math.max(0, at - how.late);
          const poses = posesAt(answer.plans, then, how.errors, how.off * radius);
          return {
            ...moment,
            request: { ...request, options: { ...options, start_overlap } },
            ...(how.reports ? { states: statesAt(answer.plans, then, poses) } : { poses }),
            pose_tolerance,
          };
        });
    });
  }
}

const orderOf = ({ progress }, id) => progress.find(({ robot }) => robot === id)?.order_id;

function smallestRadius({ robots, robot_defaults }) {
  const goals = robots.flatMap(goalsOf).map(({ radius_after }) => radius_after);
  const radii = robots.map(({ radius }) => radius ?? robot_defaults.radius);
  return Math.min(...radii, ...goals.filter(Boolean));
}

/** Where the robots of plans are at a time, with errors of at most `most` metres and radians. */
function posesAt(plans, t, errors, most) {
  return moving(plans).map(({ robot, actions }, index) => {
    const { x, y, theta } = poseAt(actions, t);
    const error = errors[index];
    return { robot, x: x + most * error.x, y: y + most * error.y, theta: theta + most * error.theta };
  });
}

/** How far they are then, each measured in its pose. */
function statesAt(plans, t, poses) {
  return moving(plans).map(({ actions }, index) => {
    const under = actions.findIndex(({ t_end }) => t < t_end);
    if (under < 0) return { ...poses[index], action: actions.length - 1, progress: 1 };
    const { t_start, t_end } = actions[under];
    return { ...poses[index], action: under, progress: Math.max(0, (t - t_start) / (t_end - t_start)) };
  });
}

/** A complete answer merged into its request. */
function merged({ request, answer }) {
  return { ...request, ...answer };
}
