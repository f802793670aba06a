"""What requests say of vehicles of VDA 5050 that have no order, are not available, or will have served all goals."""

import math
from collections.abc import Collection, Iterable, Mapping
from typing import Any, Literal

from fleetplan.course import goals_of
from fleetplan.types import Action, Goal, PlanRequest, Pose, RobotState, VehiclePose

_SAME = 1e-6  # metres, radians and seconds: rounding


def put_aside(request: PlanRequest, out: Collection[str], waiting: Mapping[str, list[Goal]],
              idle: Mapping[str, Literal["stay", "yield", "return"] | None]) -> dict[str, list[Goal]]:
    """A robot that is not available stands at the end of its commitment, and no robot waits for it to go on. Its other
    goals are returned. They and its earlier goals (`waiting`) wait until it is available again. `idle`: what robots do
    without goals otherwise."""
    aside: dict[str, list[Goal]] = {}
    for robot in request["robots"]:
        name, goals = robot["id"], goals_of(robot)
        if name in out:
            kept = 1 + max((action["goal"] for action in robot.get("committed", []) if "goal" in action), default=-1)
            aside[name] = [*_without_places(goals[kept:], robot.get("committed", [])), *waiting.get(name, [])]
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


def _without_places(goals: list[Goal], committed: list[Action]) -> list[Goal]:
    """Without the first goals that only ask for a rest in a pose in which the robot is committed to rest."""
    rests = [action["to"] for action in committed if action["type"] == "wait"] + [action["to"] for action in committed[-1:]]
    passed = 0
    while passed < len(goals) and any(_is_place(goals[passed], pose) for pose in rests):
        passed += 1
    return goals[passed:]


def _is_place(goal: Goal, pose: Pose) -> bool:
    place: Mapping[str, Any] = dict(goal)
    if "any_of" in place or place.get("service"):
        return False
    turn = math.remainder(place.get("theta", pose["theta"]) - pose["theta"], math.tau)
    return bool(max(abs(place["x"] - pose["x"]), abs(place["y"] - pose["y"]), abs(turn)) <= _SAME)


def serve_once(request: PlanRequest, out: Collection[str]) -> None:
    """Makes each robot serve its last goal once. A plan ends with the service at the last goal. A robot that makes way
    after it comes back and would be served again. If a robot is committed to the whole service, which cannot be taken
    back, it gets its place as another goal after it. This is the place of the service. If the robot is not available
    (`out`), it is the end of its commitment."""
    for robot in request["robots"]:
        goals, committed = goals_of(robot), robot.get("committed", [])
        services = [action for action in committed if goals and action.get("goal") == len(goals) - 1]
        seconds = sum(action["t_end"] - action["t_start"] for action in services)
        if services and seconds >= goals[-1].get("service", 0.0) - _SAME:
            place = (committed if robot["id"] in out else services)[-1]["to"]
            robot["goals"] = [*goals, {"x": place["x"], "y": place["y"], "theta": place["theta"]}]
            robot.pop("goal", None)


def start_where_measured(request: PlanRequest, measured: Iterable[RobotState | VehiclePose], base: Collection[str]) -> None:
    """A robot without an order begins exactly where it was measured, and stands there if it is committed to that. Where
    a plan has it does not count, because vehicles refuse orders that begin elsewhere. `base`: robots that have orders.
    """
    poses = {entry["robot"]: entry for entry in measured}
    for robot in request["robots"]:
        pose, committed = poses.get(robot["id"]), robot.get("committed", [])
        if robot["id"] in base or pose is None or any("goal" in action or action["from"] != action["to"] for action in committed):
            continue
        if "x" in pose and "y" in pose and "theta" in pose:
            start = robot["start"]
            if (start["x"], start["y"], start.get("theta")) != (pose["x"], pose["y"], pose["theta"]):
                robot["start"] = {"x": pose["x"], "y": pose["y"], "theta": pose["theta"]}
                for action in committed:
                    action["from"] = action["to"] = {"x": pose["x"], "y": pose["y"], "theta": pose["theta"]}
                robot.pop("previous", None)


def unmeasured(state: RobotState) -> RobotState:
    """How far a robot is, but not where it was measured."""
    left = state.copy()
    for name in ("x", "y", "theta", "speed"):
        left.pop(name, None)  # type: ignore[misc]
    return left
