"""Checks whether answers are valid answers of the service. The loops go on only with valid answers, because the next
request contains them.
"""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NoReturn, NotRequired, TypedDict

from fleetplan.course import goals_of, turned, whole
from fleetplan.errors import InvalidAnswer, shown
from fleetplan.shapes import Misshapen, check
from fleetplan.types import (Action, ActionPlace, ActionProgress, AdvanceAnswer, Availability, Dependency, Fault,
                             OrderProgress, PlanAnswer, PlanRequest, Plans, Pose, Robot, RobotPlan, RobotState, SamePlace,
                             Start, TightPair, Unplanned, Vda5050Answer, Vda5050States, VehiclePose)

_SAME = 1e-4  # metres, radians or seconds: what ends of actions are apart by rounding, at most
_SAME_PROGRESS = 1e-9
_RAISED = ("start_overlap", "invalid_robots")  # options that change if robots could not be where they are otherwise


class _Plan(TypedDict):
    """What a loop uses of a plan."""

    status: str
    plans: list[RobotPlan]
    unplanned: list[Unplanned]
    dependencies: NotRequired[list[Dependency] | None]
    tight: NotRequired[list[TightPair] | None]


class _Advance(TypedDict):
    """What a loop uses of the next request; it repeats the map, which is not looked at."""

    map: dict[str, Any]
    robots: list[Robot]
    options: dict[str, Any]
    progress: list[SamePlace]


class _Vehicle(TypedDict):
    robot: str
    accepted: bool
    arrived: bool
    failed: bool
    availability: NotRequired[Availability]
    errors: NotRequired[list[Fault]]


class _States(TypedDict):
    """What a loop uses of what vehicles report."""

    states: list[RobotState]
    poses: list[VehiclePose]
    progress: list[OrderProgress]
    vehicles: list[_Vehicle]


class _Node(TypedDict):
    sequenceId: int
    released: bool


class _Order(TypedDict):
    orderId: str
    orderUpdateId: int
    nodes: list[_Node]


class _Cancel(TypedDict):
    actions: list[dict[str, Any]]


def check_plan(request: PlanRequest, answer: PlanAnswer) -> None:
    """Whether it is a plan for the request. Each robot's actions must be contiguous, and dependencies must be between
    these actions."""
    _shape(answer, _Plan)
    robots = {robot["id"]: robot for robot in request["robots"]}
    named = [entry["robot"] for entry in [*answer["plans"], *answer["unplanned"]]]
    if len(set(named)) < len(named) or not set(named) <= robots.keys():
        _fail("names robots twice, or others than the request")
    actions: dict[str, Sequence[Action]] = {name: robot.get("committed", []) for name, robot in robots.items()}
    for plan in answer["plans"]:
        robot = robots[plan["robot"]]
        actions[plan["robot"]] = plan["actions"]
        _check_actions(plan["robot"], robot["start"], plan["actions"], len(goals_of(robot)))
    if (answer.get("dependencies") is None) != (answer.get("tight") is None):
        _fail("has dependencies without tight pairs, or the other way round")
    for dependency in answer.get("dependencies") or []:
        for place in (dependency["gate"], dependency["until"]):
            _check_place(actions, place["robot"], place)
    for pair in answer.get("tight") or []:
        if len(pair["robots"]) != 2 or not set(pair["robots"]) <= robots.keys():
            _fail("has a tight pair of other robots")


def check_dependencies(request: PlanRequest, answer: PlanAnswer, made: Mapping[str, object]) -> None:
    """Checks dependencies that were requested separately."""
    whole = dict(answer)
    whole.update({name: made.get(name) for name in ("dependencies", "tight")})
    check_plan(request, whole)  # type: ignore[arg-type]


def check_advance(request: PlanRequest, answer: AdvanceAnswer) -> None:
    """Whether it is a request for the same robots, with the same options as the previous request."""
    _shape(answer, _Advance)
    options: Mapping[str, object] = answer["options"]
    for name, value in request.get("options", {}).items():
        if name not in options or name not in _RAISED and options[name] != value:
            _fail(f"is a request with other options: {shown(name)}")
    names = [robot["id"] for robot in request["robots"]]
    if [robot["id"] for robot in answer["robots"]] != names:
        _fail("is a request for other robots")
    committed = {}
    for robot in answer["robots"]:
        committed[robot["id"]] = robot.get("committed", [])
        _check_actions(robot["id"], robot["start"], committed[robot["id"]], len(goals_of(robot)))
    for place in answer["progress"]:
        if place["robot"] not in committed or not 0 <= place["is"]["action"] + place["is"]["progress"]:
            _fail("has the progress of other robots")


def check_states(request: PlanRequest, progress: Iterable[OrderProgress], answer: Vda5050States) -> None:
    """Whether robots of the request report, and each order of the progress before goes on or has ended."""
    _shape(answer, _States)
    names = {robot["id"] for robot in request["robots"]}
    lists: list[Sequence[Mapping[str, Any]]] = [answer["states"], answer["poses"], answer["progress"], answer["vehicles"]]
    for entries in lists:
        told = [entry["robot"] for entry in entries]
        if len(set(told)) < len(told) or not set(told) <= names:
            _fail("names robots twice, or others than the request")
    told_orders = {entry["robot"]: entry.get("order_id") or entry.get("ended_order_id") for entry in answer["progress"]}
    for entry in progress:
        if "order_id" in entry and told_orders.get(entry["robot"]) != entry["order_id"]:
            _fail(f"does not tell of the order of {shown(entry['robot'])}")


def check_orders(request: PlanRequest, answer: Vda5050Answer) -> None:
    _shape(answer, Vda5050Answer)
    names = {robot["id"] for robot in request["robots"]}
    for entry in answer["orders"]:
        _shape(entry["order"], _Order)
        if entry["robot"] not in names or not entry["nodes"] or not any(
                node["released"] for node in entry["order"]["nodes"]):
            _fail("has an order of another robot, or one that releases nothing")
    for cancel in answer["cancel_orders"]:
        _shape(cancel["instant_actions"], _Cancel)
        if cancel["robot"] not in names or not any(isinstance(action.get("actionId"), str)
                                                   for action in cancel["instant_actions"]["actions"][:1]):
            _fail("cancels an order of another robot, or by no action")


def what_is_given(plans: Plans) -> Plans:
    """Of plans that were checked, what a request with them needs: nothing else that came may be wrong there."""
    given: list[Any] = []
    for plan in plans["plans"]:
        only: dict[str, Any] = {"robot": plan["robot"], "actions": [_given(action, _ACTION) for action in plan["actions"]]}
        if "visits" in plan:
            only["visits"] = [_given(visit, _VISIT) for visit in plan["visits"]]
        if "cost" in plan:
            only["cost"] = plan["cost"]
        given.append(only)
    return {"plans": given}


_ACTION = ("type", "t_start", "t_end", "from", "to", "goal", "reverse", "profile")
_VISIT = ("goal", "t_arrive", "t_leave", "choice", "place")


def _given(whole: Mapping[str, Any], names: Sequence[str]) -> dict[str, Any]:
    return {name: whole[name] for name in names if name in whole}


def _shape(value: object, kind: Any) -> None:
    try:
        check(value, kind)
    except Misshapen as error:
        raise InvalidAnswer(f"the answer is not of the service: {shown(str(error))}") from error


def _fail(why: str) -> NoReturn:
    raise InvalidAnswer(f"the answer is not of the service: it {why}")


def _check_actions(robot: str, start: Start, actions: Sequence[Action], goals: int) -> None:
    at: Pose = {"x": start["x"], "y": start["y"], "theta": start.get("theta", 0.0)}
    now, is_heading_known = 0.0, "theta" in start
    for action in actions:
        begin, goal = action["from"], action.get("goal")
        if action["type"] not in ("translate", "rotate", "wait") or goal is not None and not 0 <= goal < goals:
            _fail(f"has an action of an unknown kind for {shown(robot)}")
        is_on = max(abs(begin["x"] - at["x"]), abs(begin["y"] - at["y"]), abs(action["t_start"] - now)) <= _SAME
        turn = abs(turned(begin["theta"] - at["theta"])) if is_heading_known else 0.0
        if not is_on or turn > _SAME or action["t_end"] < action["t_start"]:
            _fail(f"has actions of {shown(robot)} that do not go on from each other")
        at, now, is_heading_known = action["to"], action["t_end"], True


def _check_place(actions: Mapping[str, Sequence[Action]], robot: str, place: ActionProgress | ActionPlace) -> None:
    if robot not in actions:
        _fail("has dependencies of other robots")
    if place["action"] < 0 or place["progress"] < 0.0 or whole(place) > max(1, len(actions[robot])) + _SAME_PROGRESS:
        _fail("has dependencies outside of the actions")
