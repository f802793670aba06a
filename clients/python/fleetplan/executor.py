"""Executes plans with robots that are late: docs/execution.md is its contract.

Each robot goes along its own actions, in order. It does not pass a gate before the robot that it waits for has made the
progress that opens the gate. Nothing here talks to robots or reads a clock. `Executor` says what each robot should do
now, and takes the robots' reports.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

from fleetplan.course import Course, Place, goals_of, limits_by_action, whole
from fleetplan.errors import InvalidValue, shown
from fleetplan.types import (Action, ActionProgress, AdvanceAnswer, MeasuredPose, PlanAnswer, PlanRequest,
                             Pose, Robot, RobotState, TightPair, Visit)

_REACHED = 1e-9  # of whole progress: rounding
_SAME_TIME = 1e-9  # seconds
_MARGIN_ROUNDING = 1e-9  # metres
_TIGHT = 2.0  # seconds: how long after its least slack a pair is tight
_FARTHEST = 1e9  # metres: the greatest coordinate of the service
_FASTEST = 1e3  # metres per second
_LONGEST = 1e8  # seconds


@dataclass(frozen=True)
class Instruction:
    """What a robot should do now, until it gets another instruction."""

    robot: str
    plan: int  # the number of the plan; reports repeat it
    action: int  # its number in the robot's actions
    type: Literal["translate", "rotate", "wait"]  # wait: to stand, for whatever reason
    target: Pose  # where to go and no further
    speed: float  # the highest, in metres or radians per second; 0 to stand
    room: float  # metres, or radians, to where it has to stand: beyond the target, if it may go on from there
    reverse: bool = False  # to translate backwards
    goal: int | None = None  # the number of the goal that is served by this wait
    seconds: float | None = None  # that are left of a wait, if it has an end of its own
    waits_for: tuple[str, ...] = ()  # robots that have to go on before


@dataclass(frozen=True)
class Report:
    """What a robot knows of itself: a pose, or how far it is in an action."""

    robot: str
    pose: Pose | None = None  # measured
    action: int | None = None  # with `progress`: the fraction of this action that is done
    progress: float = 0.0
    plan: int | None = None  # of the instruction; reports on another plan are ignored, unless they are poses
    speed: float | None = None  # metres per second
    service_left: float | None = None  # seconds, of the service under way


@dataclass(frozen=True)
class _Gate:
    place: Place
    other: str
    until: Place


@dataclass(frozen=True)
class _Clock:
    """For gates with too little slack in the plan. Until this time of the plan, a robot is not ahead of another robot
    by more than planned."""

    other: str
    until: float  # seconds


@dataclass
class _Progress:
    """How far a robot is."""

    course: Course
    goals: bool  # whether it has any
    arrives: bool  # whether it has served all of them at the end of its actions
    idle: bool  # whether it has none, and makes way
    margin: float  # metres: its execution margin
    gates: list[_Gate] = field(default_factory=list)
    next_gate: int = 0  # those before are open
    clocks: list[_Clock] = field(default_factory=list)
    place: Place = 0.0
    commitment: Place = math.inf  # not to be passed
    committed_from: dict[int, float] = field(default_factory=dict)  # by action: seconds, when its commitment begins it
    stays: bool = False  # where it is, whatever its actions are
    counted: float = 0.0  # until then, its wait is counted; on the executor's clock
    report: Report | None = None
    reported: float = -math.inf

    def measured(self, now: float) -> Pose | None:
        """The pose, if it has just been measured."""
        return self.report.pose if self.report is not None and now - self.reported <= _SAME_TIME else None


class Executor:
    """Executes one plan after the other.

    It keeps the promises of dependencies. If `tight` of the plan is empty, robots never come closer than the sum of
    their radii and execution margins. Pairs in `tight` keep the clock: the second robot to pass is not ahead of the
    first by more than planned. Times are from one clock, in seconds, which the caller reads.
    """

    def __init__(self, request: PlanRequest, answer: PlanAnswer, now: float, *, early: bool = True,
                 deceleration: float | Mapping[str, float] | None = None, reaction: float = 0.0,
                 near: float = 0.01) -> None:
        """`answer`: with dependencies. `now`: when the plan begins.

        `early`: robots may be ahead of the plan, and skip waits that only let others pass. Without it, no action begins
        before its time, which moving obstacles need.

        `deceleration`: metres per second squared, of all robots or by robot. `reaction`: seconds from a report to the
        execution of the instruction that follows. With these, the speed allows the robot to stop in time. By default,
        robots brake as the request says (`linear_deceleration`), if it does.

        `near`: a robot with less than so many metres (radians) left of an action has done it. A robot that is so near
        to a gate is at the gate. The execution margin should be at least as large."""
        self._early, self._deceleration, self._reaction, self._near = early, deceleration, reaction, near
        self.plan = 0  # the number of the plan
        self.start = now  # of the plan: its time 0
        self._robots: dict[str, _Progress] = {}
        self._begin(request, answer, now)

    # ---------------------------------------------------------------- what robots should do

    def instructions(self, now: float) -> list[Instruction]:
        """Of all robots, in the order of the request."""
        for robot in self._robots:
            self._count_wait(robot, now)
        return [self._instruction(robot, now) for robot in self._robots]

    @property
    def finished(self) -> bool:
        """Whether all robots have executed their actions."""
        return all(progress.place >= progress.course.end - _REACHED for progress in self._robots.values())

    @property
    def served(self) -> list[str]:
        """Robots that have served all of their goals, and robots without goals that make way (`idle`), even while they
        do so."""
        return [robot for robot, progress in self._robots.items() if progress.idle or
                progress.goals and progress.arrives and progress.place >= progress.course.end - _REACHED]

    @property
    def overran(self) -> list[str]:
        """Robots that have passed a gate that is closed, by more than their execution margin: measured poses may be
        a little past it. They have to stand, but what is promised does not hold."""
        return [robot for robot, progress in self._robots.items()
                if self._past_gate(robot) > progress.margin + _MARGIN_ROUNDING]

    # ---------------------------------------------------------------- what they do

    def report(self, report: Report, now: float) -> None:
        """Raises InvalidValue if it is not a report of one of the robots, or has values that no robot has; then nothing
        changes."""
        progress = self._robots.get(report.robot) if _is_report(report) else None
        if progress is None:
            raise InvalidValue(f"{shown(report)} is no report of a robot of the fleet")
        if report.plan is not None and report.plan != self.plan and report.pose is None:
            return
        course = progress.course
        tells_action = report.action is not None and report.plan in (None, self.plan)
        if tells_action and not 0 <= (report.action or 0) < max(1, len(course.actions)):
            raise InvalidValue(f"{report.robot} has no action {report.action}")
        progress.report, progress.reported = report, now
        self._count_wait(report.robot, now)
        before = progress.place
        if report.action is not None and tells_action:
            progress.place = min(course.end, max(before, report.action + report.progress))
        elif report.pose is not None:
            limit = min(self._limit(report.robot), self._first_not_due(progress, now))
            progress.place = course.located(report.pose, before, limit, self._near)
        if report.service_left is not None and before < course.end:
            progress.place = course.after_service(progress.place, report.service_left)
        if int(progress.place) != int(before):
            progress.counted = now

    def progress(self, robot: str) -> ActionProgress:
        """Where the robot is in its actions."""
        progress = self._robots[robot]
        return progress.course.progress(robot, progress.place)

    def states(self, now: float) -> list[RobotState]:
        """Where robots are in their actions, and where they have just been measured, for `/v1/advance`."""
        for robot in self._robots:
            self._count_wait(robot, now)
        return [self._state(robot, progress, now) for robot, progress in self._robots.items()
                if progress.course.actions]

    def poses(self, now: float) -> list[MeasuredPose]:
        """Where robots without actions have just been measured; they have no state."""
        poses: list[MeasuredPose] = []
        for robot, progress in self._robots.items():
            if not progress.course.actions and (pose := progress.measured(now)) is not None:
                measured: MeasuredPose = {"robot": robot, "x": pose["x"], "y": pose["y"], "theta": pose["theta"]}
                if progress.report is not None and progress.report.speed is not None:
                    measured["speed"] = progress.report.speed
                poses.append(measured)
        return poses

    def last_poses(self) -> list[MeasuredPose]:
        """Where robots were measured last, whenever that was."""
        return [{"robot": robot, "x": pose["x"], "y": pose["y"], "theta": pose["theta"]}
                for robot, progress in self._robots.items()
                if progress.report is not None and (pose := progress.report.pose) is not None]

    # ---------------------------------------------------------------- from plan to plan

    def places(self) -> dict[str, Place]:
        """Where robots are, for `commit`."""
        return {robot: progress.place for robot, progress in self._robots.items()}

    def commit(self, request: AdvanceAnswer, places: Mapping[str, Place], begin: float) -> list[str]:
        """While a plan is made for a request of `/v1/advance`, robots go on to the end of their commitments and no
        further. The new plan begins there. Robots are not ahead of their commitments either, unless they may be early:
        a late robot still has its waits before it.

        `places`: where they were at `begin`, the moment of the request. Returns the robots that are already further. If
        there are any, the plan cannot be followed."""
        self._committed_at = places
        self._begins_at = {entry["robot"]: whole(entry["is"]) for entry in request.get("progress", [])}
        for robot in request["robots"]:
            progress = self._robots.get(robot["id"])
            if progress is not None:
                ahead = _course(request, robot, robot.get("committed", []))
                place = places[robot["id"]]
                progress.commitment = progress.course.after(place, ahead.moves(0.0, ahead.end), self._near)
                progress.committed_from = self._committed_from(progress.course, ahead, place, begin)
        # A robot that only waits after its commitment has not passed it.
        return [robot for robot, progress in self._robots.items()
                if progress.course.moves(progress.commitment, progress.place)]

    def release(self) -> None:
        """There is no new plan: robots go on with their present plan."""
        for progress in self._robots.values():
            progress.commitment = math.inf
            progress.committed_from = {}

    def follow(self, request: PlanRequest, answer: PlanAnswer, begin: float, now: float) -> list[str]:
        """Goes on with the plan for the request that was committed to, which began at `begin`. Actions done since then
        count as done in the new plan.

        Returns the robots that can no longer stop before a closed gate of the new plan, which was not known when they
        drove off. If there are any, nothing changes. Robots go on to the ends of their commitments, as the gates of
        their old plan allow. The new plan may be followed later."""
        before = self._robots, self.start, self.plan
        is_followed = False
        try:
            too_fast = self._go_on(request, answer, begin, now)
            is_followed = not too_fast
            return too_fast
        finally:
            if not is_followed:
                self._robots, self.start, self.plan = before

    def _go_on(self, request: PlanRequest, answer: PlanAnswer, begin: float, now: float) -> list[str]:
        old, committed_at, begins_at = self._robots, self._committed_at, self._begins_at
        ways = {robot: self._way_to_stop(robot) for robot in old}
        self._begin(request, answer, begin)
        for robot, progress in self._robots.items():
            if robot in old:
                done = old[robot].course.moves(committed_at[robot], old[robot].place)
                progress.place = progress.course.after(begins_at.get(robot, 0.0), done, self._near)
                progress.report, progress.reported = old[robot].report, old[robot].reported
            progress.counted = now
        return [robot for robot in self._robots if self._past_gate(robot) + ways.get(robot, 0.0) > self._near]

    # ---------------------------------------------------------------- inside

    def _begin(self, request: PlanRequest, answer: PlanAnswer, begin: float) -> None:
        dependencies = answer.get("dependencies")
        if dependencies is None:
            raise InvalidValue("the plan has no dependencies; ask for them with options.dependencies")
        self.start = begin
        self.plan += 1
        plans = {plan["robot"]: plan for plan in answer["plans"]}
        invalid = {entry["robot"] for entry in answer["unplanned"] if entry["reason"] == "invalid"}
        self._robots = {}
        for robot in request["robots"]:
            plan = plans.get(robot["id"])
            actions = robot.get("committed", []) if plan is None else plan["actions"]
            has_goals = bool(goals_of(robot))
            visits = None if plan is None else plan.get("visits")
            self._robots[robot["id"]] = _Progress(
                _course(request, robot, actions, visits), has_goals, plan is not None and "ends_at" not in plan,
                plan is not None and not has_goals and robot.get("idle", "stay") != "stay",
                _execution_margin(request, robot), counted=begin, stays=robot["id"] in invalid)
        for dependency in dependencies:
            gate, until = dependency["gate"], dependency["until"]
            self._robots[gate["robot"]].gates.append(_Gate(whole(gate), until["robot"], whole(until)))
        for progress in self._robots.values():
            progress.gates.sort(key=lambda gate: gate.place)
        for pair in answer.get("tight") or []:
            self._keep_time(pair)

    def _keep_time(self, pair: TightPair) -> None:
        """In a tight pair, the robot that waits for the other nearest to the pair's time is the second to pass."""
        first, second = pair["robots"]
        gates = [(abs(self._robots[robot].course.time_at(gate.place) - pair["t"]), robot, other)
                 for robot, other in ((first, second), (second, first))
                 for gate in self._robots[robot].gates if gate.other == other]
        if gates:
            _, waits, other = min(gates)
            self._robots[waits].clocks.append(_Clock(other, pair["t"] + _TIGHT))

    def _is_open(self, gate: _Gate) -> bool:
        return self._robots[gate.other].place >= gate.until - _REACHED

    def _closed_at(self, robot: str) -> Place:
        """The first gate that is closed."""
        progress = self._robots[robot]
        gates = progress.gates
        while progress.next_gate < len(gates) and self._is_open(gates[progress.next_gate]):
            progress.next_gate += 1
        return gates[progress.next_gate].place if progress.next_gate < len(gates) else math.inf

    def _past_gate(self, robot: str) -> float:
        """Metres by which the robot has passed its first closed gate; negative before it."""
        progress, gate = self._robots[robot], self._closed_at(robot)
        driven = progress.course.driven
        return driven(gate, progress.place) - driven(progress.place, min(gate, progress.course.end))

    def _way_to_stop(self, robot: str) -> float:
        """Metres that the robot drives if it is told to stop: its braking distance. Less if it has to stand sooner
        anyway, because it already brakes for that."""
        progress, speed = self._robots[robot], self._reported_speed(robot)
        course, place, gate = progress.course, progress.place, self._closed_at(robot)
        deceleration = self._brakes(robot, course.index(place))
        if math.isinf(deceleration):
            return 0.0
        needed = speed * self._reaction + speed * speed / (2.0 * deceleration)
        is_before_stand = place < min(gate, course.end) and course.actions[course.index(place)]["type"] == "translate"
        return min(needed, course.room(place, gate)) if is_before_stand else needed

    def _limit(self, robot: str) -> Place:
        """The place that the robot may reach and not pass."""
        progress = self._robots[robot]
        if progress.stays:
            return 0.0
        limits = [self._on_time(progress, clock) for clock in progress.clocks]
        return min(self._closed_at(robot), progress.commitment, progress.course.end, *limits)

    def _on_time(self, progress: _Progress, clock: _Clock) -> Place:
        """The place at which the robot is planned to be when the other robot is where it is now."""
        other = self._robots[clock.other]
        t = other.course.time_at(other.place)
        return progress.course.place_at(t) if t < clock.until else math.inf

    def _count_wait(self, robot: str, now: float) -> None:
        """Goes on with the waits of a robot, as far as they are over."""
        progress, course = self._robots[robot], self._robots[robot].course
        while (progress.place < (limit := self._limit(robot)) - _REACHED
               and course.actions[index := course.index(progress.place)]["type"] == "wait"):
            begins = self._begins(progress, index)
            if now < begins - _SAME_TIME:
                break
            stop, least = min(limit, index + 1.0), course.amount(index)
            since = max(progress.counted, begins)
            needed = (stop - progress.place) * least
            if now - since < needed - _SAME_TIME:
                progress.place += (now - since) / least
                break
            progress.place, progress.counted = stop, since + needed if least > 0.0 else progress.counted
        progress.counted = now

    def _committed_from(self, course: Course, ahead: Course, place: Place, begin: float) -> dict[int, float]:
        """When the moves of a commitment begin, by the actions that they are on the course now."""
        times: dict[int, float] = {}
        for number, action in enumerate(ahead.actions):
            index = course.next_move(course.after(place, ahead.moves(0.0, float(number)), self._near))
            if action["type"] != "wait" and index is not None:
                times.setdefault(index, begin + action["t_start"])
        return times

    def _begins(self, progress: _Progress, index: int) -> float:
        """When a robot may begin what a wait is for, or a move."""
        course = progress.course
        action = course.actions[index]
        if self._early:
            return self.start + (course.not_before(index) if action["type"] == "wait" else 0.0)
        if action["type"] == "wait":
            return self.start + action["t_end"] - course.amount(index)
        return max(self.start + action["t_start"], progress.committed_from.get(index, -math.inf))

    def _first_not_due(self, progress: _Progress, now: float) -> Place:
        """Where the robot stands until it may begin the move after that. Without this limit, errors of measured poses
        would look as if it had begun."""
        course = progress.course
        for index in range(math.ceil(progress.place - _REACHED), len(course.actions)):
            if course.actions[index]["type"] == "wait":
                break
            if course.begins_at_rest(index) and now < self._begins(progress, index) - _SAME_TIME:
                return index
        return math.inf

    def _instruction(self, robot: str, now: float) -> Instruction:
        progress, course = self._robots[robot], self._robots[robot].course
        place, limit = progress.place, self._limit(robot)
        if place >= course.end - _REACHED:
            return self._stand(robot, place)
        index = course.index(place + _REACHED)
        action = course.actions[index]
        if place >= limit - _REACHED:
            return self._stand(robot, place, waits_for=self._waits_for(robot))
        begins = self._begins(progress, index)
        if action["type"] == "wait":
            left = max(0.0, begins - now) + (index + 1 - place) * course.amount(index)
            return self._stand(robot, place, action.get("goal"), left, self._waits_for(robot))
        if place <= index + _REACHED and now < begins - _SAME_TIME:
            return self._stand(robot, place, None, begins - now)
        room = course.room(place, limit)
        return Instruction(robot, self.plan, index, action["type"], course.pose(min(limit, index + 1.0)),
                           self._speed(robot, place, room), room,
                           action.get("reverse", False), waits_for=self._waits_for(robot) if limit < index + 1 else ())

    def _stand(self, robot: str, place: Place, goal: int | None = None, seconds: float | None = None,
               waits_for: tuple[str, ...] = ()) -> Instruction:
        course = self._robots[robot].course
        index = max(0, course.index(place + _REACHED))
        return Instruction(robot, self.plan, index, "wait", course.pose(place), speed=0.0, room=0.0, goal=goal,
                           seconds=seconds, waits_for=waits_for)

    def _waits_for(self, robot: str) -> tuple[str, ...]:
        """The robots that have to go on before this one may pass its limit."""
        progress, limit = self._robots[robot], self._limit(robot)
        gates = progress.gates[progress.next_gate:]
        others = {gate.other for gate in gates if gate.place <= limit and not self._is_open(gate)}
        others |= {clock.other for clock in progress.clocks if self._on_time(progress, clock) <= limit}
        return tuple(sorted(others))

    def _speed(self, robot: str, place: Place, room: float) -> float:
        """At most as planned, and so that the robot can stop within the room, and is as slow as planned when the next
        action begins."""
        course = self._robots[robot].course
        index = course.index(place + _REACHED)
        planned, deceleration = course.planned_speed(index), self._brakes(robot, index)
        if math.isinf(deceleration) or course.actions[index]["type"] != "translate":
            return planned
        room = min(room, course.room_at_speed(place, deceleration))
        return min(planned, _braking_speed(room, self._reported_speed(robot), deceleration, self._reaction))

    def _brakes(self, robot: str, index: int) -> float:
        """Metres per second squared in an action, infinite if the robot needs no way to stop."""
        of_robots = self._deceleration
        given = of_robots.get(robot) if isinstance(of_robots, Mapping) else of_robots
        return self._robots[robot].course.deceleration(index) if given is None else given

    def _reported_speed(self, robot: str) -> float:
        """Metres per second; 0 if it is not known."""
        report = self._robots[robot].report
        return abs(report.speed) if report is not None and report.speed is not None else 0.0

    def _state(self, robot: str, progress: _Progress, now: float) -> RobotState:
        course = progress.course
        at = course.progress(robot, progress.place)
        state: RobotState = {"robot": robot, "action": at["action"], "progress": at["progress"]}
        action, least = course.actions[at["action"]], course.amount(at["action"])
        if action["type"] == "wait":
            if "goal" in action:
                state["service_left"] = course.service_left(progress.place)
            else:
                # What is left of it is for others, and ends as planned.
                left = max(self.start + action["t_end"] - now, (1.0 - at["progress"]) * least)
                state["progress"] = max(0.0, 1.0 - left / max(_SAME_TIME, action["t_end"] - action["t_start"]))
        pose = progress.measured(now)
        if pose is not None:
            state["x"], state["y"], state["theta"] = pose["x"], pose["y"], pose["theta"]
            if progress.report is not None and progress.report.speed is not None:
                state["speed"] = progress.report.speed
        return state


def _is_report(report: object) -> bool:
    """Whether it has the members of a report, with numbers that the service takes."""
    if not isinstance(report, Report) or not isinstance(report.robot, str):
        return False
    numbers: list[tuple[object, float, float]] = [(report.progress, 0.0, 1.0)]
    if report.action is not None:
        numbers.append((report.action, 0.0, math.inf))
    if report.plan is not None:
        numbers.append((report.plan, -math.inf, math.inf))
    if report.speed is not None:
        numbers.append((report.speed, -_FASTEST, _FASTEST))
    if report.service_left is not None:
        numbers.append((report.service_left, 0.0, _LONGEST))
    if report.pose is not None:
        if not isinstance(report.pose, Mapping):
            return False
        numbers += [(report.pose.get(name), -_FARTHEST, _FARTHEST) for name in ("x", "y", "theta")]
    return all(isinstance(value, int | float) and not isinstance(value, bool) and least <= value <= most
               for value, least, most in numbers) and isinstance(report.action, int | None)


def _execution_margin(request: PlanRequest, robot: Robot) -> float:
    of_all = request.get("options", {}).get("execution_margin", 0.0)
    return robot.get("execution_margin", request.get("robot_defaults", {}).get("execution_margin", of_all))


def _course(request: PlanRequest, robot: Robot, actions: list[Action],
            visits: list[Visit] | None = None) -> Course:
    start = robot["start"]
    pose: Pose = {"x": start["x"], "y": start["y"], "theta": start.get("theta", 0.0)}
    return Course(pose, actions, goals_of(robot), request.get("options", {}).get("wait_before_move", 0.0),
                  limits_by_action(request, robot, actions, visits))


def _braking_speed(room: float, speed: float, deceleration: float, reaction: float) -> float:
    """The highest speed to go on with, for the reaction, and then to stop within the room; from a speed that may be
    higher."""
    lost = deceleration * reaction
    steady = math.sqrt(lost * lost + 2.0 * deceleration * room) - lost
    if speed <= steady:
        return steady
    # The way v' r + (v - v')^2 / (2 d) + v'^2 / (2 d) is the room.
    root = (speed - lost) ** 2 - 2.0 * speed * speed + 4.0 * deceleration * room
    slower = (speed - lost + math.sqrt(root)) / 2.0 if root >= 0.0 else 0.0
    return slower if slower >= max(0.0, speed - lost) else 0.0
