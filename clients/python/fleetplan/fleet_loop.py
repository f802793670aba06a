"""The loop of a fleet manager: plan, execute, advance (docs/fleet_loop.md)."""

import functools
import math
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import Future
from dataclasses import dataclass
from typing import Any

from fleetplan.answers import what_is_given
from fleetplan.client import Client
from fleetplan.course import Place, limits_of
from fleetplan.errors import FleetplanError, InvalidValue, MessageRejected, PlanDropped, RequestRefused, shown
from fleetplan.executor import Executor, Instruction, Report
from fleetplan.faults import OnFault
from fleetplan.planning_loop import PlanningLoop, unforeseen
from fleetplan.types import AdvanceAnswer, Hold, MeasuredPose, NewGoals, PlanAnswer, PlanOptions, PlanRequest, Plans

# Options for a fleet that is planned again and again, while its robots are late and a little beside their paths. They
# give slack between robots in time and space. Measured starts may be too near to something. Only the next seconds are
# planned, so that a round of a large fleet is done in time. The options of the request have precedence.
LOOP_OPTIONS: PlanOptions = {"time_budget_ms": 900, "horizon": 20.0, "interval_margin": 0.5, "dependency_slack": 0.02,
                             "inflation": 0.05, "execution_margin": 0.02, "start_overlap": 0.15,
                             "invalid_robots": "report"}

_SAME_TIME = 1e-9  # seconds
_TRANSFER = 0.5  # seconds: what commitments are longer than planning may take


@dataclass
class _Round:
    """From a moment to the plan that is made for it."""

    begin: float
    ready: float  # not followed before, whenever it is made
    places: Mapping[str, Place]  # of robots at the moment
    first: PlanRequest | None = None  # of the first plan; written by the thread that plans, as is the next one
    request: AdvanceAnswer | None = None  # of the moment, once it is known
    committed: bool = False  # robots to what it commits them to
    passed: Sequence[str] = ()  # robots that were further by then
    future: "Future[PlanAnswer] | None" = None
    dropped_from: float = math.inf  # its plan, unless robots can obey it before


class FleetLoop(PlanningLoop):
    """Plans a fleet, and plans it again while it drives. Call `step` several times per second with the robots' reports,
    and send them the instructions that it returns.

    A round may fail: there is no answer, a busy server, or an invalid answer. This costs only time: robots go on with
    their present plan. A report that cannot be used is ignored; its robot's other reports still count.
    """

    def __init__(self, client: Client, request: PlanRequest, *, period: float = 1.0, commit: float | None = None,
                 clock: Callable[[], float] = time.monotonic, background: bool = True,
                 latency: float = 0.0, change: Callable[[PlanRequest], None] | None = None,
                 pose_tolerance: float | None = None, deceleration: float | Mapping[str, float] | None = None,
                 reaction: float = 0.0, near: float = 0.01, on_fault: OnFault | None = None) -> None:
        """`period`: seconds from plan to plan. A plan that takes longer delays the next one. `commit`: seconds of
        motion that are decided before each plan. The default is the time budget, half a second, and the time to brake.
        If the request limits accelerations, the move under way is added, because every commitment ends at rest.

        `change` is called with each request before it is planned, in the thread that plans, to add obstacles, zones or
        robots. `clock`: returns seconds. `background`: plans are made in a thread, while robots go on. Without it,
        `step` waits for them, as simulations need. Then `latency` is how long plans take on the clock, seconds.

        `on_fault` is called with each round that failed and each report that is not used, in the thread that has found
        it. Faults are logged, too. The other parameters are the parameters of `Executor`."""
        super().__init__(client, request, LOOP_OPTIONS, period=period, clock=clock, background=background, change=change,
                         on_fault=on_fault)
        self.answer: PlanAnswer | None = None  # to the request
        self._latency = latency
        self._commit = commit
        if commit is None and not _accelerates(request):
            self._commit = self.request["options"]["time_budget_ms"] / 1000.0 + _TRANSFER + _braking_time(request, deceleration)
        self._pose_tolerance, self._deceleration = pose_tolerance, deceleration
        self._reaction, self._near = reaction, near
        self._executor: Executor | None = None
        self._round: _Round | None = None  # under way
        self._holds: dict[str, float] = {}  # until when, on the clock

    # ---------------------------------------------------------------- the loop

    def step(self, reports: Iterable[Report] = ()) -> list[Instruction]:
        """What every robot should do now. Before the first plan, nothing: robots stand.

        Raises RequestRefused if the first request, or goals that were given, are at fault. Then these goals are
        dropped, and the loop goes on with the next call."""
        now = self._clock()
        for report in reports:
            self._take_report(report, now)
        self._commit_robots()
        self._take_plan(now)
        if self._round is None and now >= self._due:
            self._due = now + self._period
            self._begin_round(now)
            self._commit_robots()
            self._take_plan(now)
        return self._executor.instructions(now) if self._executor is not None else []

    def _take_report(self, report: Report, now: float) -> None:
        if self._executor is None:
            return
        try:
            self._executor.report(report, now)
        except InvalidValue as error:
            self._faults.tell(MessageRejected(str(getattr(report, "robot", "a report")), str(error)))

    def hold(self, robot: str, seconds: float) -> None:
        """The robot stands where it is for so long, from the next round on. What it does until then is up to it."""
        if not 0.0 <= seconds < math.inf:
            raise InvalidValue(f"{shown(robot)} cannot be held for {seconds} s")
        self._holds[robot] = self._clock() + seconds

    @property
    def idle(self) -> list[str]:
        """Robots that have served all their goals, and robots without goals that make way."""
        served = self._executor.served if self._executor is not None else []
        return [robot for robot in served if robot not in self._goals and robot not in self._given]

    @property
    def stuck(self) -> dict[str, list[str]]:
        """Robots that gain nothing on the way to their goals within the horizon of the last plan, with the robots that
        are in their way. Somebody should look if it is the same plan after plan."""
        plans = self.answer["plans"] if self.answer is not None else []
        return {plan["robot"]: plan.get("blocked_by", []) for plan in plans if plan.get("stuck")}

    @property
    def overran(self) -> list[str]:
        """Robots that have passed a closed gate: an operator should look at them."""
        return self._executor.overran if self._executor is not None else []

    # ---------------------------------------------------------------- rounds

    def _begin_round(self, now: float) -> None:
        self._given, self._goals = self._goals, {}
        if self._executor is None:
            self._round = _Round(now, now + self._latency, {})
            self._round.future = self._run(functools.partial(self._plan_first, self._round))
        else:
            self._round = _Round(now, now + self._latency, self._executor.places())
            advance = self._advance(self._executor, now)
            self._round.future = self._run(functools.partial(self._plan_next, self._round, advance))

    def _plan_first(self, round_: _Round) -> PlanAnswer:
        round_.first = self._first_request()
        return self._make_plan(round_.first)

    def _plan_next(self, round_: _Round, advance: Callable[[], AdvanceAnswer]) -> PlanAnswer:
        request = self._changed(advance())
        round_.request = request
        return self._make_plan(request)

    def _advance(self, executor: Executor, now: float) -> Callable[[], AdvanceAnswer]:
        """What returns the request of this moment."""
        assert self.answer is not None
        self._holds = {robot: until for robot, until in self._holds.items() if until > now}
        holds: list[Hold] = [{"robot": robot, "until": until - now} for robot, until in self._holds.items()]
        # What an invalid robot is committed to cannot be executed.
        holds += [{"robot": entry["robot"], "until": 0.0} for entry in self.answer["unplanned"]
                  if entry["reason"] == "invalid" and entry["robot"] not in self._holds]
        goals: list[NewGoals] = [{"robot": robot, "goals": given} for robot, given in self._given.items()]
        request, at = self.request, now - executor.start

        def advance_by(plans: Plans) -> Callable[..., AdvanceAnswer]:
            return functools.partial(self._client.advance, request, plans, at, commit=self._commit,
                                     pose_tolerance=self._pose_tolerance)

        advance, standing = advance_by(what_is_given(self.answer)), advance_by({"plans": []})
        parts: dict[str, list[Any]] = {"states": executor.states(now), "poses": executor.poses(now), "holds": holds,
                                       "goals": goals}
        return functools.partial(self._next_request, advance, standing, request, parts, executor.last_poses())

    def _next_request(self, advance: Callable[..., AdvanceAnswer], standing: Callable[..., AdvanceAnswer],
                      request: PlanRequest, parts: dict[str, list[Any]], poses: list[MeasuredPose]) -> AdvanceAnswer:
        """By the plan that there is. If that is refused, which should not have been followed, by no plan: robots are
        where they were measured last, and have their goals."""
        try:
            return self._advanced(advance, request, parts)
        except RequestRefused as error:
            if not any(fault.pointer.startswith("/plans") for fault in error.faults):
                raise
            self._faults.tell(error)
        return self._advanced(standing, request, {**parts, "states": [], "poses": poses})

    def _commit_robots(self) -> None:
        """Robots go on to the ends of their commitments, once these are known."""
        round_ = self._round
        if round_ is not None and round_.request is not None and not round_.committed and self._executor is not None:
            round_.committed = True
            try:
                round_.passed = self._executor.commit(round_.request, round_.places, round_.begin)
            except Exception as error:  # as in _take_plan
                self._end_round(unforeseen(error))

    def _take_plan(self, now: float) -> None:
        """Goes on with the next plan if it is ready and robots can obey its gates. If they cannot yet, because another
        robot is late, they execute their commitments, for at most a period."""
        round_ = self._round
        if round_ is None or round_.future is None or not round_.future.done():
            return
        self._commit_robots()
        if now < round_.ready - _SAME_TIME:
            return
        try:
            answer = round_.future.result()
            if round_.passed:
                raise FleetplanError(f"{round_.passed} passed the ends of their commitments before these were known")
            if not self._follow(round_, answer, now):
                return
        except FleetplanError as error:
            self._end_round(error)
        except Exception as error:  # a bug, or an answer that is wrong in an unforeseen way
            self._end_round(unforeseen(error))
        else:
            self._round, self.failure, self._given, self.answer = None, None, {}, answer

    def _follow(self, round_: _Round, answer: PlanAnswer, now: float) -> bool:
        """Goes on with the plan, if all robots can obey it; if not now, perhaps later."""
        if self._executor is None:
            assert round_.first is not None
            self._executor = Executor(round_.first, answer, now, early=False, deceleration=self._deceleration,
                                      reaction=self._reaction, near=self._near)
            self.request = round_.first
        elif round_.request is not None:
            if too_fast := self._executor.follow(round_.request, answer, round_.begin, now):
                round_.dropped_from = min(round_.dropped_from, now + self._period)
                if now < round_.dropped_from - _SAME_TIME:
                    return False
                raise PlanDropped(f"{too_fast} could not stop before gates of the plan")
            self.request = round_.request
        return True

    def _end_round(self, error: FleetplanError) -> None:
        """Goes on with the plan that there is."""
        self._round = None
        if self._executor is not None:
            self._executor.release()
        self._fail(error, is_first=self._executor is None)


def _accelerates(request: PlanRequest) -> bool:
    """Whether robots of the request need time to start or to stop."""
    limits = (limits_of(request, robot) for robot in request["robots"])
    return any(not math.isinf(one.rise) or not math.isinf(one.fall) for one in limits)


def _braking_time(request: PlanRequest, deceleration: float | Mapping[str, float] | None) -> float:
    """Seconds in which a robot drives the way that it needs to stop: the longest of all robots."""
    default = request.get("robot_defaults", {}).get("linear_speed", 0.0)
    longest = 0.0
    for robot in request["robots"]:
        brakes = deceleration.get(robot["id"]) if isinstance(deceleration, Mapping) else deceleration
        if brakes is not None:
            longest = max(longest, robot.get("linear_speed", default) / (2.0 * brakes))
    return longest

