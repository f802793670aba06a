// A question for the service (POST /v1/matrix): how long a robot takes, alone and from its start, to places. The
// service searches once for each pose at the end, so places at the beginning take a hundredth of the time. The question
// is about the ways back, wherever each of them takes as long.

import { robotsOf } from "./listed.js";
import { zonesFor } from "./zones.js";

/** @import {Fault, Position, Request, Robot} from "./types.js" */

const TRAITS = [
  "id",
  "radius",
  "linear_speed",
  "angular_speed",
  "linear_acceleration",
  "linear_deceleration",
  "angular_acceleration",
  "may_reverse",
];
const OPTIONS = [
  "any_angle",
  "connectivity",
  "lattice_spacing",
  "inflation",
  "wait_before_move",
  "start_overlap",
  "goal_overlap",
];

/**
 * The members of an object that it has of these.
 * @returns {Record<string, any>}
 */
function pick(object, names) {
  const found = names.filter((name) => object?.[name] !== undefined);
  return Object.fromEntries(found.map((name) => [name, object[name]]));
}

/**
 * Whether ways back take as long as ways there. False in these cases:
 *
 * - There are one-way zones, or zones that robots may leave but not enter.
 * - Braking and speeding up differ.
 * - There is an inflation: the robot keeps it from walls, except where it already stands nearer.
 */
function isSameBack(request, { id }, traits, options) {
  const { linear_acceleration: up, linear_deceleration: down = up } = traits;
  const zones = zonesFor(request, id);
  const isOneWay = zones.some(({ type, enter }) => type === "one_way" || enter === false);
  return !isOneWay && up === down && !(options.inflation > 0);
}

/** The heading of a robot that comes back to where it left with this one. */
const opposite = (theta) => (theta > 0 ? theta - Math.PI : theta + Math.PI);

export class TravelQuestion {
  isBack; // whether the ways back are asked for
  robot;
  #index;
  #given; // what the times depend on: the map, the zones, and the rest as a text
  #numbers;
  #head = ""; // of the body: all but the places; a large map is written once

  /**
   * `robot`: one of the scene of the request.
   * @param {Request} request
   * @param {Robot} robot
   */
  constructor(request, robot) {
    const traits = pick({ ...request.robot_defaults, ...robotsOf(request)[robot.index] }, TRAITS);
    const options = pick(request.options, OPTIONS);
    this.robot = robot;
    this.#index = robot.index;
    this.isBack = isSameBack(request, robot, traits, options);
    this.#numbers = { robot: traits, options };
    const { map, zones } = request;
    this.#given = [map, zones, JSON.stringify([this.#numbers, robot.start])];
  }

  /** Whether another question (or null) has the same answers. */
  isSameAs(other) {
    return other !== null && this.#given.every((part, at) => part === other.#given[at]);
  }

  /**
   * The body of a request about some places, within a time.
   * @param {Position[]} places
   */
  body(places, milliseconds) {
    const [map, zones] = this.#given;
    const { robot, options } = this.#numbers;
    this.#head ||= JSON.stringify({
      map,
      zones,
      robot,
      options: { ...options, time_budget_ms: milliseconds },
    }).slice(0, -1);
    const { start } = this.robot;
    const [from, to] = this.isBack
      ? [places, [{ ...start, theta: opposite(start.theta) }]]
      : [[start], places];
    return `${this.#head},"from":${JSON.stringify(from)},"to":${JSON.stringify(to)}}`;
  }

  /** The seconds to the places from the answer; null: no way. */
  secondsOf({ seconds }) {
    return this.isBack ? seconds.map(([each]) => each) : seconds[0];
  }

  /**
   * A fault of the body at its place in the request.
   * @param {Fault} fault
   */
  atItsPlace({ pointer = "", ...fault }) {
    const robot = `/robots/${this.#index}`;
    const start = this.isBack ? /^\/to\/0/ : /^\/from\/0/;
    return { ...fault, pointer: pointer.replace(/^\/robot(?=\/|$)/, robot).replace(start, `${robot}/start`) };
  }
}
