"""Requests and answers of the service, as JSON has them.

The names are the names of the schemas in the service's OpenAPI document, which `tests/python` compares with this file.
They are dictionaries, so answers of the service can be sent back without any conversion. Units: metres, seconds,
radians.
"""

from typing import Any, Literal, NotRequired, Required, TypeAlias, TypedDict

Metadata: TypeAlias = dict[str, Any]
ActionType: TypeAlias = Literal["rotate", "translate", "wait"]


class Position(TypedDict):
    x: float
    y: float


class Pose(TypedDict):
    x: float
    y: float
    theta: float


class Start(TypedDict):
    x: float
    y: float
    theta: NotRequired[float]
    speed: NotRequired[float]


# ---------------------------------------------------------------- maps


class RowsMap(TypedDict):
    rows: list[str]
    resolution: NotRequired[float]
    origin: NotRequired[Position]


class GridPosition(TypedDict):
    x: float
    y: float
    z: NotRequired[object]


class GridOrientation(TypedDict, total=False):
    x: float
    y: float
    z: float
    w: float


class GridOrigin(TypedDict, total=False):
    position: GridPosition
    orientation: GridOrientation


class GridInfo(TypedDict):
    map_load_time: NotRequired[object]
    resolution: float
    width: int
    height: int
    origin: NotRequired[GridOrigin]


class OccupancyGrid(TypedDict):
    header: NotRequired[object]
    info: GridInfo
    data: list[int]


class OccupancyGridMap(TypedDict):
    occupancy_grid: OccupancyGrid
    unknown: NotRequired[Literal["blocked", "free"]]


class PixelsGiven(TypedDict, total=False):
    pgm: str
    png: str
    mode: Literal["trinary", "scale", "raw"]
    negate: Literal[False, True, 0, 1]
    occupied_thresh: float
    free_thresh: float
    release: Literal["jazzy", "humble"]
    origin: list[float]


class Mask(PixelsGiven, total=False):
    resolution: float


class MaskOfSpeeds(Mask, total=False):
    base: float
    multiplier: float


class Image(PixelsGiven, total=False):
    resolution: Required[float]
    image: object


class ImageMap(TypedDict):
    image: Image
    unknown: NotRequired[Literal["blocked", "free"]]


class MovingAiMap(TypedDict):
    movingai: str
    resolution: NotRequired[float]
    origin: NotRequired[Position]


Map: TypeAlias = RowsMap | OccupancyGridMap | ImageMap | MovingAiMap


# ---------------------------------------------------------------- zones and obstacles


class BlockedZone(TypedDict):
    id: str
    type: Literal["blocked"]
    enter: NotRequired[Literal[False]]
    polygon: list[Position]
    robots: NotRequired[list[str]]


class SpeedZone(TypedDict):
    id: str
    type: Literal["speed"]
    polygon: list[Position]
    linear_speed: NotRequired[float]
    angular_speed: NotRequired[float]
    robots: NotRequired[list[str]]


class OneWayZone(TypedDict):
    id: str
    type: Literal["one_way"]
    polygon: list[Position]
    heading: float
    half_angle: float
    robots: NotRequired[list[str]]


class BlockedMask(TypedDict):
    id: str
    type: Literal["blocked"]
    enter: NotRequired[Literal[False]]
    mask: Mask
    robots: NotRequired[list[str]]


class SpeedMask(TypedDict):
    id: str
    type: Literal["speed"]
    mask: MaskOfSpeeds
    robots: NotRequired[list[str]]


Zone: TypeAlias = BlockedZone | SpeedZone | OneWayZone | BlockedMask | SpeedMask


class ObstacleEntry(TypedDict):
    t: float
    x: float
    y: float


class Obstacle(TypedDict):
    id: str
    radius: float
    motion: list[ObstacleEntry]
    after: NotRequired[Literal["leaves", "stays"]]


# ---------------------------------------------------------------- robots


# `from` is a keyword, so these members are declared by a call.
_Ends = TypedDict("_Ends", {"from": Pose, "to": Pose})


class Profile(TypedDict):
    start: float
    cruise: float
    end: float


# `for` is a keyword, too.
_WaitsFor = TypedDict("_WaitsFor", {"for": list[str]}, total=False)


class Action(_Ends, _WaitsFor):
    type: ActionType
    t_start: float
    t_end: float
    goal: NotRequired[int]
    reverse: NotRequired[bool]
    profile: NotRequired[Profile]


class GoalAction(TypedDict):
    type: str
    blocking_type: NotRequired[Literal["NONE", "SINGLE", "SOFT", "HARD"]]
    retriable: NotRequired[bool]
    parameters: NotRequired[dict[str, Any]]


class GoalDetails(TypedDict, total=False):
    """What goals have besides where they are."""

    service: float
    not_before: float
    due: float
    radius_after: float
    linear_speed_after: float
    linear_acceleration_after: float
    linear_deceleration_after: float
    actions: list[GoalAction]
    metadata: Metadata


class Place(TypedDict):
    x: float
    y: float


class PlacedGoal(GoalDetails):
    x: float
    y: float
    theta: NotRequired[float]
    tolerance: NotRequired[float]
    place: NotRequired[Place]


class Alternative(TypedDict):
    x: float
    y: float
    theta: NotRequired[float]
    bias: NotRequired[float]


class OpenGoal(GoalDetails):
    """A goal that is served at one of several poses."""

    any_of: list[Alternative]
    choice: NotRequired[int]


Goal: TypeAlias = PlacedGoal | OpenGoal


class RobotDefaults(TypedDict, total=False):
    radius: float
    linear_speed: float
    angular_speed: float
    linear_acceleration: float
    linear_deceleration: float
    angular_acceleration: float
    vicinity: float
    execution_margin: float
    stop_distance: float
    may_reverse: bool
    body_radius: float


class Robot(RobotDefaults, total=False):
    id: Required[str]
    start: Required[Start]
    goal: Goal
    goals: list[Goal]
    goal_age: float
    weight: float
    idle: Literal["stay", "yield", "return"]
    committed: list[Action]
    previous: list[Action]
    metadata: Metadata


# ---------------------------------------------------------------- /v1/plan


class PlanOptions(TypedDict, total=False):
    time_budget_ms: float
    mode: Literal["first", "anytime"]
    objective: Literal["flowtime", "makespan", "tardiness"]
    seed: int
    priority: Literal["shortest_first", "longest_first", "as_listed", "random"]
    reordering: Literal["raise_failed", "random", "none"]
    start_safe_interval: float
    inflation: float
    wait_before_move: float
    any_angle: bool
    smoothing: bool
    connectivity: Literal[4, 8, 16, 32]
    max_iterations: int | None
    replan: Literal["all", "where_needed"]
    horizon: float | None
    interval_margin: float
    start_overlap: float
    goal_overlap: float
    invalid_robots: Literal["refuse", "report"]
    lattice_spacing: float | None
    dependencies: bool
    dependency_slack: float
    execution_margin: float


class PlanRequest(TypedDict):
    map: Map
    robot_defaults: NotRequired[RobotDefaults]
    robots: list[Robot]
    obstacles: NotRequired[list[Obstacle]]
    zones: NotRequired[list[Zone]]
    options: NotRequired[PlanOptions]
    metadata: NotRequired[Metadata]


class Visit(TypedDict):
    goal: int
    t_arrive: float | None
    t_leave: float | None
    reason: NotRequired[Literal["zone_closed", "goal_before"]]
    zone: NotRequired[str]
    choice: NotRequired[int | None]
    place: NotRequired[Place | None]
    late_by: NotRequired[float | None]
    estimated_t_arrive: NotRequired[float | None]
    actions: NotRequired[list[GoalAction]]
    metadata: NotRequired[Metadata]


class RobotPlan(TypedDict):
    robot: str
    cost: float
    lower_bound: float
    ends_at: NotRequired[Literal["horizon", "zone"]]
    estimated_cost: NotRequired[float | None]
    stuck: NotRequired[bool]
    blocked_by: NotRequired[list[str]]
    blocked_by_total: NotRequired[int]
    lattice_spacing: NotRequired[float]
    actions: list[Action]
    visits: NotRequired[list[Visit]]
    metadata: NotRequired[Metadata]


class Fault(TypedDict):
    pointer: str
    code: Literal["wrong_type", "missing", "unknown_key", "unknown_value", "unknown_robot", "unknown_obstacle",
                  "duplicate", "out_of_range", "empty", "bad_map_row", "bad_image", "bad_movingai", "bad_polygon",
                  "wrong_size", "start_in_obstacle", "goal_in_obstacle", "starts_overlap", "goals_overlap",
                  "discontinuity", "speed", "profile", "committed_collision", "committed_in_zone", "dependency",
                  "invalid_plan"]
    detail: str


class Unplanned(TypedDict):
    robot: str
    reason: Literal["start_blocked", "goal_blocked", "goal_unreachable", "blocked_by_robots", "budget_exhausted",
                    "committed_in_the_way", "invalid"]
    detail: str
    blocked_by: list[str]
    blocked_by_total: int
    lattice_spacing: NotRequired[float]
    actions: NotRequired[list[Action]]
    errors: NotRequired[list[Fault]]
    metadata: NotRequired[Metadata]


class UnavoidableCollision(TypedDict):
    robots: NotRequired[list[str]]
    robot: NotRequired[str]
    obstacle: NotRequired[str]
    t: float


class ActionPlace(TypedDict):
    action: int
    progress: float


class ActionProgress(TypedDict):
    robot: str
    action: int
    progress: float


class Dependency(TypedDict):
    gate: ActionProgress
    until: ActionProgress
    slack: NotRequired[float]


class TightPair(TypedDict):
    robots: list[str]
    t: float
    slack: float


class Objectives(TypedDict):
    flowtime: float
    makespan: float


class MethodCounts(TypedDict):
    tried: int
    served: int
    could_not_serve: int


class Moves(TypedDict, total=False):
    priorities: MethodCounts
    steps: MethodCounts
    room: MethodCounts
    smoothing: MethodCounts
    improvement: MethodCounts


class Search(TypedDict):
    attempts: int
    expansions: int
    improvements: int
    moves: Moves
    exhausted: NotRequired[Literal[True]]


class Timings(TypedDict):
    queue: float
    parse: float
    plan: float
    choose: float
    first_plan: float
    bounds: float
    improve: float
    verify: float
    serialize: float
    total: float


class PlanAnswer(TypedDict):
    status: Literal["solved", "partial", "none"]
    request_id: str
    plans: list[RobotPlan]
    unplanned: list[Unplanned]
    unavoidable: NotRequired[list[UnavoidableCollision]]
    dependencies: NotRequired[list[Dependency] | None]
    tight: NotRequired[list[TightPair] | None]
    flowtime: float
    makespan: float
    objective_value: NotRequired[float]
    lower_bound: Objectives
    estimated: NotRequired[Objectives]
    verified: Literal[True]
    min_clearance: float | None
    deterministic: bool
    lattice_spacing: NotRequired[float]
    search: Search
    timings_ms: Timings
    warnings: list[str]
    metadata: NotRequired[Metadata]


class Progress(TypedDict):
    elapsed_ms: float
    attempt: int
    planned: int
    robots: int
    best: Objectives | None


class ProgressEvent(TypedDict):
    event: Literal["progress"]
    data: Progress


class IncumbentEvent(TypedDict):
    event: Literal["incumbent"]
    data: PlanAnswer


class PlannedEvent(TypedDict):
    event: Literal["plan"]
    data: PlanAnswer


# The fourth event, `problem`, is raised as an exception.
PlanEvent: TypeAlias = ProgressEvent | IncumbentEvent | PlannedEvent


# ---------------------------------------------------------------- plans of other planners


class GivenPlan(TypedDict):
    robot: str
    cost: NotRequired[float]
    lower_bound: NotRequired[object]
    ends_at: NotRequired[object]
    estimated_cost: NotRequired[object]
    lattice_spacing: NotRequired[object]
    stuck: NotRequired[object]
    blocked_by: NotRequired[object]
    blocked_by_total: NotRequired[object]
    metadata: NotRequired[object]
    actions: list[Action]
    visits: NotRequired[list[Visit]]


class GivenPlans(TypedDict):
    """Plans that need not be from this service, in the place of its answer."""

    plans: list[GivenPlan]
    unavoidable: NotRequired[list[UnavoidableCollision]]
    dependencies: NotRequired[list[Dependency] | None]


Plans: TypeAlias = PlanAnswer | GivenPlans


# ---------------------------------------------------------------- /v1/validate, /v1/dependencies


class Violation(TypedDict):
    kind: Literal["robot_collision", "obstacle_collision", "discontinuity", "speed", "profile", "wrong_start",
                  "wrong_goal", "wrong_visit", "committed_changed", "margin", "moving_obstacle", "zone"]
    robots: list[str]
    obstacle: NotRequired[str]
    zone: NotRequired[str]
    t: float
    distance: float
    required: float
    detail: str


class Verdict(TypedDict):
    valid: bool
    violations: list[Violation]
    violations_total: int
    min_clearance: float | None
    truncated: NotRequired[Literal[True]]


class DependenciesAnswer(TypedDict):
    dependencies: list[Dependency] | None
    tight: list[TightPair] | None
    warnings: list[str]


# ---------------------------------------------------------------- /v1/simulate


class Range(TypedDict):
    min: float
    max: float


class Stops(TypedDict):
    rate_per_hour: float
    mean_s: float


class CrossTrack(TypedDict):
    sigma: float
    correlation_length: float


class Disturbance(TypedDict, total=False):
    speed: Range
    turn: Range
    stops: Stops
    start_delay: Range
    cross_track: CrossTrack


class Quantiles(TypedDict):
    mean: float
    min: float
    p10: float
    p50: float
    p90: float
    p99: float
    max: float


Distribution: TypeAlias = Quantiles | None


class SimulatedDelay(TypedDict):
    robot: str
    planned: float
    delay: Distribution


# `with` is a keyword.
_Collided = TypedDict("_Collided", {"with": Literal["robot", "wall"]})


class Collision(_Collided):
    run: int
    robots: list[str]
    t: float
    x: float
    y: float
    depth: float


class MeetingPair(TypedDict):
    robots: list[str]
    runs: int
    share: float


class Deadlock(TypedDict):
    run: int
    robots: list[str]


class ExecutedPlan(TypedDict):
    robot: str
    cost: float
    actions: list[Action]


class Trace(TypedDict):
    run: int
    plans: list[ExecutedPlan]


class SimulationAnswer(TypedDict):
    request_id: str
    runs: int
    collision_share: float
    deadlock_share: float
    planned: Objectives
    flowtime: Distribution
    makespan: Distribution
    robots: list[SimulatedDelay]
    first_collisions: list[Collision]
    pairs: list[MeetingPair]
    deadlocks: list[Deadlock]
    trace: NotRequired[Trace]
    warnings: list[str]


class SimulationProgress(TypedDict):
    elapsed_ms: float
    runs: int
    done: int
    collided: int
    deadlocked: int


class SimulationProgressEvent(TypedDict):
    event: Literal["progress"]
    data: SimulationProgress


class SimulatedEvent(TypedDict):
    event: Literal["simulation"]
    data: SimulationAnswer


SimulationEvent: TypeAlias = SimulationProgressEvent | SimulatedEvent


# ---------------------------------------------------------------- /v1/margins


class Aim(TypedDict, total=False):
    collisions: float
    confidence: float


class MarginValues(TypedDict, total=False):
    interval_margin: list[float]
    inflation: list[float]
    wait_before_move: list[float]


class MarginOptions(TypedDict):
    interval_margin: float
    inflation: float
    wait_before_move: float
    dependencies: NotRequired[bool]
    execution_margin: NotRequired[float]


class TriedMargins(TypedDict):
    options: MarginOptions
    status: Literal["met", "not_met", "undecided", "not_planned", "not_run"]
    planned: Objectives | None
    runs: int
    bad: int
    share: float | None
    share_low: float | None
    share_high: float | None
    collided: int
    deadlocked: int
    executed: Objectives | None
    tight: int | None
    pairs: list[MeetingPair]


class MarginsAnswer(TypedDict):
    request_id: str
    met: bool
    best: int | None
    options: MarginOptions
    plan: PlanAnswer | None
    tried: list[TriedMargins]
    advice: list[str]
    deterministic: bool
    warnings: list[str]


class MarginsProgress(TypedDict):
    elapsed_ms: float
    candidate: int
    candidates: int
    stage: Literal["plan", "execute"]
    runs: int
    bad: int


class MarginsProgressEvent(TypedDict):
    event: Literal["progress"]
    data: MarginsProgress


class FoundMargins(TypedDict):
    event: Literal["margins"]
    data: MarginsAnswer


MarginsEvent: TypeAlias = MarginsProgressEvent | FoundMargins


# ---------------------------------------------------------------- /v1/advance


class VehiclePose(TypedDict):
    robot: str
    x: float
    y: float
    theta: float


class MeasuredPose(VehiclePose):
    speed: NotRequired[float]


class RobotState(TypedDict):
    robot: str
    action: int
    progress: float
    service_left: NotRequired[float]
    x: NotRequired[float]
    y: NotRequired[float]
    theta: NotRequired[float]
    speed: NotRequired[float]
    released: NotRequired[ActionPlace]


class Hold(TypedDict):
    robot: str
    until: float


class NewGoals(TypedDict):
    robot: str
    goals: list[Goal]


SamePlace = TypedDict("SamePlace", {"robot": str, "was": ActionPlace, "is": ActionPlace})


class AdvanceAnswer(PlanRequest):
    progress: list[SamePlace]
    unavoidable: NotRequired[list[UnavoidableCollision]]
    unavoidable_total: NotRequired[int]


# ---------------------------------------------------------------- /v1/retime


class PacedState(TypedDict):
    robot: str
    action: int
    progress: float
    speed_factor: NotRequired[float]
    held_s: NotRequired[float]


class RetimedAction(TypedDict):
    action: int
    t_start: float
    t_end: float


class RetimedVisit(TypedDict):
    goal: int
    t_arrive: float | None
    t_leave: float | None


class RetimedRobot(TypedDict):
    robot: str
    t_end: float
    delay: float
    actions: list[RetimedAction]
    visits: list[RetimedVisit]


class LateRobot(TypedDict):
    robot: str
    delay: float
    waits_for: str | None
    because_of: str


class RetimeAnswer(TypedDict):
    robots: list[RetimedRobot]
    late: list[LateRobot]


# ---------------------------------------------------------------- /v1/matrix, /v1/assign


class TravelPose(TypedDict):
    x: float
    y: float
    theta: NotRequired[float]


class LoneRobot(TypedDict):
    id: NotRequired[str]
    radius: float
    linear_speed: float
    angular_speed: float
    linear_acceleration: NotRequired[float]
    linear_deceleration: NotRequired[float]
    angular_acceleration: NotRequired[float]
    may_reverse: NotRequired[bool]
    vicinity: NotRequired[float]
    execution_margin: NotRequired[float]
    stop_distance: NotRequired[float]
    body_radius: NotRequired[float]
    metadata: NotRequired[Metadata]


class MatrixAnswer(TypedDict):
    seconds: list[list[float | None]]
    metres: list[list[float | None]]
    unreachable: NotRequired[int]
    warnings: list[str]


class Task(TypedDict):
    id: str
    goals: list[PlacedGoal]
    robots: NotRequired[list[str]]
    due: NotRequired[float]
    weight: NotRequired[float]


class AssignedTask(TypedDict):
    task: str
    robot: str
    t_arrive: float


class UnassignedTask(TypedDict):
    task: str
    reason: Literal["no_way", "no_robot"]


class AssignAnswer(PlanRequest):
    assigned: list[AssignedTask]
    unassigned: list[UnassignedTask]


# ---------------------------------------------------------------- /v1/export/vda5050, /v1/import/vda5050


VdaMessage: TypeAlias = dict[str, Any]  # a message of VDA 5050


class OrderProgress(TypedDict):
    robot: str
    order_id: NotRequired[str | None]
    order_update_id: NotRequired[int]
    last_released_sequence_id: NotRequired[int]
    action: int
    progress: float
    cancel_id: NotRequired[str]
    ended_order_id: NotRequired[str]
    served: NotRequired[int]


class OrderBase(TypedDict):
    robot: str
    order: VdaMessage
    state: NotRequired[VdaMessage]


class OrderNode(TypedDict):
    sequence_id: int
    action: int
    progress: float


class RobotOrder(TypedDict):
    robot: str
    order: VdaMessage
    last_released_sequence_id: int
    nodes: list[OrderNode]


class CancelledOrder(TypedDict):
    robot: str
    detail: str
    instant_actions: VdaMessage


class Vda5050Answer(TypedDict):
    cancel_orders: list[CancelledOrder]
    orders: list[RobotOrder]
    all_released: bool


class UnavailabilityReason(TypedDict):
    reason: Literal["not_reported", "unreadable", "operating_mode", "emergency_stop", "field_violation", "paused",
                    "not_localized", "other_map", "error", "order_refused", "order_unknown", "other_order",
                    "order_cleared", "restarted", "action_failed", "action_retriable"]
    detail: str


class Availability(TypedDict):
    available: bool
    reasons: list[UnavailabilityReason]


class FailedAction(TypedDict):
    action_id: str
    goal: NotRequired[int]


class VehicleReport(TypedDict):
    robot: str
    accepted: bool
    arrived: bool
    failed: bool
    availability: Availability
    failed_actions: list[FailedAction]
    errors: list[Fault]
    errors_total: int


class Vda5050States(TypedDict):
    states: list[RobotState]
    poses: list[VehiclePose]
    progress: list[OrderProgress]
    vehicles: list[VehicleReport]
    errors: list[Fault]
    errors_total: int


# ---------------------------------------------------------------- GET


class Limits(TypedDict):
    max_body: int
    max_cells: int
    max_robots: int
    max_depth: int
    max_goals: int
    max_actions: int
    max_obstacles: int
    max_obstacle_entries: int
    max_zones: int
    max_zone_corners: int
    max_plan_memory: int
    max_unsent: int
    default_budget_ms: int
    min_budget_ms: int
    max_budget_ms: int
    workers: int
    queue: int


class Health(TypedDict):
    status: Literal["ok"]
    version: str
