"""What requests say of vehicles of VDA 5050 that have no order, or are not available."""

from collections.abc import Collection, Iterable, Mapping
from typing import Literal

from fleetplan.course import goals_of
from fleetplan.types import Goal, PlanRequest, RobotState, VehiclePose


def put_aside(request: PlanRequest, out: Collection[str], waiting: Mapping[str, list[Goal]],
              idle: Mapping[str, Literal["stay", "yield", "return"] | None]) -> dict[str, list[Goal]]:
    """A robot that is not available stands at the end of what it is committed to: nobody waits for it to go on. Its
    other goals, which are returned, and those of before (`waiting`) wait until it is available again. `idle`: what
    robots do without goals otherwise."""
    aside: dict[str, list[Goal]] = {}
    for robot in request["robots"]:
        name, goals = robot["id"], goals_of(robot)
        if name in out:
            kept = 1 + max((action["goal"] for action in robot.get("committed", []) if "goal" in action), default=-1)
            aside[name] = [*goals[kept:], *waiting.get(name, [])]
            goals, robot["idle"] = goals[:kept], "stay"
            robot.pop("previous", None)
        elif name in waiting:
            goals = [*goals, *waiting[name]]
            robot.pop("idle", None)
            if (otherwise := idle.get(name)) is not None:
                robot["idle"] = otherwise
        else:
            continue
        robot.pop("goal", None)
        robot["goals"] = goals
        if not goals:
            robot.pop("goals")
            robot.pop("goal_age", None)
    return aside


def start_where_measured(request: PlanRequest, measured: Iterable[RobotState | VehiclePose], base: Collection[str]) -> None:
    """A robot that has no order begins exactly where it is, not where a plan has it: vehicles refuse orders that begin
    elsewhere. `base`: robots that have orders."""
    poses = {entry["robot"]: entry for entry in measured}
    for robot in request["robots"]:
        pose = poses.get(robot["id"])
        if robot["id"] in base or pose is None or robot.get("committed"):
            continue
        if "x" in pose and "y" in pose and "theta" in pose:
            start = robot["start"]
            if (start["x"], start["y"], start.get("theta")) != (pose["x"], pose["y"], pose["theta"]):
                robot["start"] = {"x": pose["x"], "y": pose["y"], "theta": pose["theta"]}
                robot.pop("previous", None)


def unmeasured(state: RobotState) -> RobotState:
    """How far a robot is, but not where it was measured."""
    left = state.copy()
    for name in ("x", "y", "theta", "speed"):
        left.pop(name, None)  # type: ignore[misc]
    return left
