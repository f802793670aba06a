// The shapes that several modules share, for the type checker: the service's JSON (see GET /v1/openapi.json)
// and what the page makes of it. Units: metres, seconds, radians.

/** @typedef {{x: number, y: number}} Position */
/** @typedef {{x: number, y: number, theta: number}} Pose */
/** @typedef {{column: number, row: number}} Cell row 0 is the top one */

// The service's JSON

/**
 * A pose of a request; a start without theta faces 0, a goal without theta allows any heading.
 * @typedef {{x: number, y: number, theta?: number}} GivenPose
 */

/** @typedef {GivenPose & {service?: number, not_before?: number, due?: number,
 * radius_after?: number, linear_speed_after?: number, linear_acceleration_after?: number,
 * linear_deceleration_after?: number}} GivenGoal */

/**
 * A disk that the fleet does not control. It leaves after its motion unless `after` is "stays".
 * @typedef {object} RequestObstacle
 * @property {string} id
 * @property {number} radius
 * @property {{t: number, x: number, y: number}[]} motion
 * @property {"stays" | "leaves"} [after]
 */

/**
 * @typedef {object} RequestRobot
 * @property {string} id
 * @property {number} [radius]
 * @property {number} [linear_speed]
 * @property {number} [angular_speed]
 * @property {GivenPose} start
 * @property {GivenGoal} [goal]
 * @property {GivenGoal[]} [goals] in the order of the visits, instead of `goal`
 * @property {Action[]} [committed]
 * @property {Action[]} [previous]
 */

/**
 * A map of a request with rows; one with an image, an occupancy grid or a text of MovingAI instead is read by
 * files/request_map.js.
 * @typedef {{rows: string[], resolution?: number, origin?: Position}} RequestMap
 */
/** @typedef {{radius?: number, linear_speed?: number, angular_speed?: number}} RobotDefaults */

/**
 * A request of POST /v1/plan. The page also shows and edits faulty requests: readers check what they use.
 * @typedef {object} Request
 * @property {RequestMap} map
 * @property {RequestRobot[]} robots
 * @property {RobotDefaults} [robot_defaults]
 * @property {RequestObstacle[]} [obstacles]
 * @property {object[]} [zones] see zones.js
 * @property {Record<string, any>} [options]
 */

/**
 * An action.
 *
 * - `goal`, of a wait: the number of the goal that is served, from 0
 * - `reverse`, of a translation: whether it goes backwards
 * - `profile`: its speeds, if they change
 * - `changes`: how many seconds the changes take
 *
 * @typedef {{type: "rotate" | "translate" | "wait", t_start: number, t_end: number, from: Pose, to: Pose,
 * goal?: number, reverse?: boolean, profile?: {start: number, cruise: number, end: number},
 * changes?: {rise: number, fall: number}}} Action
 */
/** @typedef {{rise: number, fall: number, turn: number}} Inertia see profile.js */
/** @typedef {{goal: number, t_arrive: number | null, t_leave: number | null, late_by?: number | null}} Visit without
 * times if the goal is not reached */
/** @typedef {{robot: string, cost: number, lower_bound?: number, actions: Action[], visits?: Visit[], stuck?: boolean,
 * blocked_by?: string[], blocked_by_total?: number}} Plan */
/** @typedef {{robot: string, reason: string, detail?: string, blocked_by?: string[], blocked_by_total?: number}} Blocked */
/** @typedef {Blocked & {actions?: Action[]}} Unplanned */

/**
 * The answer of POST /v1/plan. One from a file may lack what is optional here.
 * @typedef {object} Answer
 * @property {string} status "solved", "partial" or "none"
 * @property {Plan[]} plans
 * @property {Unplanned[]} unplanned
 * @property {number} flowtime
 * @property {number} makespan
 * @property {{flowtime: number, makespan: number}} [lower_bound]
 * @property {boolean} [verified]
 * @property {number | null} [min_clearance]
 * @property {boolean} [deterministic]
 * @property {number} [objective_value]
 * @property {{expansions: number}} [search]
 * @property {number} [lattice_spacing] metres; if it is not the size of a cell
 * @property {Record<string, number>} [timings_ms]
 * @property {(string | {detail?: string})[]} warnings
 * @property {object[]} [unavoidable]
 */

/**
 * @typedef {{kind: string, robots: string[], t: number, distance?: number, required?: number, detail:
 * string}} Violation
 */

/**
 * The answer of POST /v1/validate.
 * @typedef {object} Check
 * @property {boolean} valid
 * @property {Violation[]} violations
 * @property {number} [violations_total]
 * @property {number | null} min_clearance
 */

/**
 * @typedef {{pointer?: string, code?: string, detail: string}} Fault an error of a Problem, at a JSON Pointer
 */

/**
 * A failure in the form of RFC 9457.
 * @typedef {object} Problem
 * @property {string} title
 * @property {string} [detail]
 * @property {number} [status]
 * @property {Fault[]} [errors]
 * @property {number} [retry_after] seconds
 * @property {string} [request_id]
 * @property {() => void} [again] tries again what failed
 */

/**
 * The answer of GET /v1/limits; empty until it is known.
 * @typedef {object} Limits
 * @property {number} [default_budget_ms]
 * @property {number} [max_budget_ms]
 * @property {number} [max_robots]
 * @property {number} [max_cells]
 * @property {number} [max_body] bytes
 */

/** @typedef {{flowtime: number, makespan: number}} Costs */

/**
 * An event while planning; `best` is null until there is a plan.
 * @typedef {object} Progress
 * @property {number} elapsed_ms
 * @property {number} attempt
 * @property {number} planned
 * @property {number} robots
 * @property {Costs | null} best
 */

// The scene, see scene.js

/**
 * A map as it is drawn; `blocked[row * columns + column]` is 1 for a wall, the top row first.
 * @typedef {object} Grid
 * @property {RequestMap} map
 * @property {string[]} lines
 * @property {number} columns
 * @property {number} rows
 * @property {number} resolution
 * @property {Position} origin
 * @property {Uint8Array} blocked
 * @property {Bounds} bounds
 */

/** @typedef {{left: number, bottom: number, right: number, top: number}} Bounds metres */

/**
 * A robot as it is drawn, at `index` of the request's robots.
 *
 * - `goal`: its theta is null for any heading
 * - `via`: the goals before the last one, null where they are faulty
 * - `radiiAfter`: the radii that goals change, null where they do not
 * - `services`: how long they take, and from when on
 * - `alternatives`: for each goal, the poses at one of which it is served; none for a goal with one pose, null where
 *   they are faulty
 * - `committed`: the path of its committed actions
 * - `vicinity`: the distance that it keeps from others
 * - `makesWay`: whether it moves for others while it has nothing to do
 * - `yields`: whether it then need not come back
 *
 * @typedef {object} Robot
 * @property {number} index
 * @property {string} id
 * @property {string} label what differs from the other robots' ids
 * @property {number} radius
 * @property {Pose} start
 * @property {{x: number, y: number, theta: number | null} | null} goal
 * @property {({x: number, y: number, theta: number | null} | null)[]} via
 * @property {({x: number, y: number, theta: number | null} | null)[][]} alternatives
 * @property {(number | null)[]} radiiAfter
 * @property {{service: number, notBefore: number}[]} services seconds
 * @property {Position[]} committed
 * @property {number} vicinity
 * @property {boolean} makesWay
 * @property {boolean} yields
 * @property {Inertia} inertia at first
 * @property {Inertia[]} inertiasAfter after each of its goals
 */

/** @typedef {{id: string, radius: number, motion: {t: number, x: number, y: number}[], stays: boolean}}
 * MovingObstacle */

/** The cells of a zone, row by row from the top, see zone_masks.js.
 * @typedef {{columns: number, rows: number, percents: Uint8Array, limits: Uint8Array, bounds: Bounds,
 *   resolution: number, isFramed: boolean}} Mask */

/**
 * A zone as it is drawn: a polygon, or a mask over its `bounds`; `heading` of one-way zones only.
 * @typedef {{type: "blocked" | "speed" | "one_way", polygon: Position[], mask: Mask | null, bounds: Bounds | null,
 * middle: Position, heading: number | null, label: string}} Zone
 */

/** @typedef {{grid: Grid | null, robots: Robot[], obstacles: MovingObstacle[], zones: Zone[]}} Scene */

/**
 * What a robot does under an answer; see readTracks.
 * @typedef {object} Track
 * @property {"ready" | "planned" | "parked" | "unplanned" | "outdated"} status
 * @property {Action[]} actions
 * @property {({x: number, y: number, theta: number | null} | null)[]} chosen
 * @property {{t: number, radius: number}[]} radii
 * @property {Position[]} path
 * @property {number | null} cost
 * @property {number | null} lowerBound
 * @property {{goal: number, seconds: number}[]} late
 * @property {Unplanned | null} unplanned
 * @property {Blocked | null} stuck
 * @property {Action[]} former
 */

/** @typedef {{radius: number, knots: Float64Array, ramps: Float64Array, radii: {t: number, radius: number}[]}} Motion
 * see motion.js */

// The options of a request, see options.js

/**
 * @typedef {object} Option
 * @property {string} name
 * @property {string} label
 * @property {string} unit "" for none
 * @property {string} type of JSON Schema
 * @property {any} default null if the service has none, or decides
 * @property {{value: any, label: string}[] | null} choices
 * @property {number | null} min
 * @property {number | null} max
 * @property {string} description
 */

export {};
