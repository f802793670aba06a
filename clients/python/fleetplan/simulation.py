"""A fleet for tests and examples: robots that obey instructions with delays, and report where they are."""

import math
import random
from collections.abc import Iterable
from dataclasses import dataclass

from fleetplan.course import Limits, limits_of, turned
from fleetplan.executor import Instruction, Report
from fleetplan.types import PlanRequest, Pose

_STEP = 0.02  # seconds: in which the speed of a robot with inertia is constant


@dataclass(frozen=True)
class Leg:
    """Straight motion at constant speed, or a stand."""

    t_start: float
    t_end: float
    begin: Pose
    end: Pose


@dataclass
class _Robot:
    pose: Pose
    limits: Limits
    own: bool  # whether the limits come from the request: then it brakes by itself within the room of its instruction
    room: float = 0.0  # metres that are left of it
    speed: float = 0.0  # metres per second
    stands_until: float = 0.0
    instruction: Instruction | None = None


class SimulatedFleet:
    """Robots on a clock of their own, which `drive` moves."""

    def __init__(self, request: PlanRequest, *, seed: int = 0, speed: tuple[float, float] = (0.7, 1.0),
                 stops_per_hour: float = 0.0, mean_stop: float = 3.0, acceleration: float | None = None,
                 noise: float = 0.0) -> None:
        """`speed`: the share of the instructed speed that robots make, drawn anew between these for each drive.
        Robots stop at random moments, for `mean_stop` seconds on average. `acceleration`: metres per second squared, to
        drive off and to brake; by default as the request says, or at once. `noise`: of measured poses, metres."""
        self.now = 0.0
        self._random = random.Random(seed)
        self._speed, self._stops, self._mean_stop = speed, stops_per_hour / 3600.0, mean_stop
        self._noise = noise
        self._robots: dict[str, _Robot] = {}
        for robot in request["robots"]:
            pose: Pose = {"x": robot["start"]["x"], "y": robot["start"]["y"], "theta": robot["start"].get("theta", 0.0)}
            limits = limits_of(request, robot) if acceleration is None else Limits(acceleration, acceleration)
            self._robots[robot["id"]] = _Robot(pose, limits, acceleration is None)
        self.legs: dict[str, list[Leg]] = {robot: [] for robot in self._robots}  # all that they have done

    def clock(self) -> float:
        return self.now

    def pose(self, robot: str) -> Pose:
        return self._robots[robot].pose

    def reports(self) -> list[Report]:
        """Where robots are, as they measure it."""
        return [Report(name, pose=self._measured(robot.pose), speed=robot.speed)
                for name, robot in self._robots.items()]

    def obey(self, instructions: Iterable[Instruction]) -> None:
        for instruction in instructions:
            robot = self._robots[instruction.robot]
            robot.instruction, robot.room = instruction, instruction.room

    def stop(self, robot: str, seconds: float) -> None:
        """The robot breaks down: it stands for so long, whatever it is instructed."""
        self._robots[robot].stands_until = max(self._robots[robot].stands_until, self.now + seconds)

    def drive(self, seconds: float) -> None:
        """All robots do what they were instructed last."""
        end = self.now + seconds
        for name, robot in self._robots.items():
            factor = self._random.uniform(*self._speed)
            if self._random.random() < 1.0 - math.exp(-self._stops * seconds):
                self.stop(name, self._random.expovariate(1.0 / self._mean_stop))
            if robot.instruction is not None:
                self._drive(name, robot, factor, end)
        self.now = end

    def _drive(self, name: str, robot: _Robot, factor: float, end: float) -> None:
        now, instruction = self.now, robot.instruction
        assert instruction is not None
        while now < end:
            step = end - now if math.isinf(robot.limits.rise + robot.limits.fall) else min(_STEP, end - now)
            if instruction.type == "rotate" and robot.speed == 0.0 and now >= robot.stands_until:
                begin = robot.pose
                robot.pose = _turned_to(begin, instruction.target, instruction.speed * factor * step)
                self.legs[name].append(Leg(now, now + step, begin, robot.pose))
            else:
                self._translate(name, robot, instruction, factor, now, step)
            now += step

    def _translate(self, name: str, robot: _Robot, instruction: Instruction, factor: float, now: float,
                   step: float) -> None:
        """Drives straight to the target, and no further unless it cannot stop."""
        begin, target = robot.pose, instruction.target
        sign = -1.0 if instruction.reverse else 1.0
        x, y = sign * math.cos(begin["theta"]), sign * math.sin(begin["theta"])
        away_x, away_y = target["x"] - begin["x"], target["y"] - begin["y"]
        distance = math.hypot(away_x, away_y)
        goes = instruction.type == "translate" and now >= robot.stands_until and away_x * x + away_y * y > 0.0
        if goes:
            x, y = away_x / distance, away_y / distance
        wanted = instruction.speed * factor if goes else 0.0
        rise, change = robot.limits.rise * step, robot.limits.fall * step
        if robot.own and not math.isinf(change):
            wanted = min(wanted, math.sqrt(change * change / 4.0 + 2.0 * robot.limits.fall * robot.room) - change / 2.0)
        robot.speed = min(robot.speed + rise, max(robot.speed - change, wanted))
        length, duration = robot.speed * step, step
        robot.room = max(0.0, robot.room - length)
        robot.pose = {"x": begin["x"] + length * x, "y": begin["y"] + length * y, "theta": begin["theta"]}
        if goes and length >= distance and robot.speed <= change:
            duration = distance / robot.speed
            robot.pose, robot.speed = target, 0.0
        self.legs[name].append(Leg(now, now + duration, begin, robot.pose))

    def _measured(self, pose: Pose) -> Pose:
        if self._noise == 0.0:
            return pose
        return {"x": pose["x"] + self._random.gauss(0.0, self._noise),
                "y": pose["y"] + self._random.gauss(0.0, self._noise), "theta": pose["theta"]}


def _turned_to(pose: Pose, target: Pose, most: float) -> Pose:
    turn = turned(target["theta"] - pose["theta"])
    if abs(turn) <= most:
        return {"x": pose["x"], "y": pose["y"], "theta": target["theta"]}
    return {"x": pose["x"], "y": pose["y"], "theta": turned(pose["theta"] + math.copysign(most, turn))}
