"""What loops that plan a fleet again and again have in common."""

import copy
import re
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from types import TracebackType
from typing import Any, Self, TypeVar

from fleetplan.answers import check_advance, check_dependencies, check_plan
from fleetplan.client import Client
from fleetplan.errors import FleetplanError, MessageRejected, RequestRefused, RoundFailed, shown
from fleetplan.faults import Faults, OnFault
from fleetplan.http import write_json
from fleetplan.types import AdvanceAnswer, Goal, PlanAnswer, PlanOptions, PlanRequest

_Made = TypeVar("_Made")
_Request = TypeVar("_Request", bound=PlanRequest)


class PlanningLoop:
    """The request that was planned last, the goals that robots are given, and the thread that plans. A context manager,
    which ends the thread."""

    def __init__(self, client: Client, request: PlanRequest, defaults: PlanOptions, *, period: float,
                 clock: Callable[[], float], background: bool, change: Callable[[PlanRequest], None] | None,
                 on_fault: OnFault | None) -> None:
        """`defaults`: options that the request need not have."""
        write_json(request)
        self.request = copy.deepcopy(request)  # that was planned last
        options = defaults.copy()
        options.update(request.get("options", {}))
        options["dependencies"] = True
        self.request["options"] = options
        self.failure: FleetplanError | None = None  # of the last round; none if it succeeded
        self._client, self._period, self._clock, self._change = client, period, clock, change
        self._threads = ThreadPoolExecutor(1, "fleetplan") if background else None
        self._faults = Faults(on_fault)
        self._due = -float("inf")
        self._goals: dict[str, list[Goal]] = {}  # for the next round
        self._given: dict[str, list[Goal]] = {}  # in the round under way

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, value: BaseException | None,
                 trace: TracebackType | None) -> None:
        self.close()

    def close(self) -> None:
        if self._threads is not None:
            self._threads.shutdown(cancel_futures=True)

    def give(self, robot: str, goals: Sequence[Goal]) -> None:
        """Replaces the goals that the robot has left, from the next round on. An empty list lets it stand. Raises
        InvalidValue if the goals cannot be written as JSON."""
        given = list(goals)
        write_json(given)
        self._goals[robot] = given

    def _run(self, make: Callable[[], _Made]) -> "Future[_Made]":
        """In the background, if there is one."""
        if self._threads is not None:
            return self._threads.submit(_guarded, make)
        future: Future[_Made] = Future()
        try:
            future.set_result(_guarded(make))
        except FleetplanError as error:
            future.set_exception(error)
        return future

    def _first_request(self) -> PlanRequest:
        """With the goals that were given before the first round."""
        request = copy.deepcopy(self.request)
        for robot in request["robots"]:
            if robot["id"] in self._given:
                robot.pop("goal", None)
                robot["goals"] = self._given[robot["id"]]
        return self._changed(request)

    def _changed(self, request: _Request) -> _Request:
        if self._change is not None:
            self._change(request)
        return request

    def _advanced(self, advance: Callable[..., AdvanceAnswer], request: PlanRequest,
                  parts: Mapping[str, list[Any]]) -> AdvanceAnswer:
        """The next request. `parts`: members about single robots. If any of them are at fault, they are left out and
        reported, so that other robots are not affected. Goals at fault are an exception."""
        left = {name: list(entries) for name, entries in parts.items()}
        while True:
            try:
                answer = advance(**left)
                check_advance(request, answer)
                return answer
            except RequestRefused as error:
                faults = {(part, int(index)): fault.detail for fault in error.faults
                          for part, index in re.findall(r"^/(states|poses|holds|goals)/(\d{1,9})(?:/|$)", fault.pointer)
                          if int(index) < len(left.get(part, []))}
                error.robots = frozenset(left[part][index]["robot"] for part, index in faults if part == "goals")
                if not faults or error.robots:
                    raise
                for (part, index), detail in faults.items():
                    self._faults.tell(MessageRejected(left[part][index]["robot"], detail))
                left = {part: [entry for index, entry in enumerate(entries) if (part, index) not in faults]
                        for part, entries in left.items()}

    def _make_plan(self, request: PlanRequest) -> PlanAnswer:
        """The plan with its dependencies."""
        try:
            answer = self._client.plan(request)
        except RequestRefused as error:
            named = {int(index) for fault in error.faults
                     for index in re.findall(r"^/robots/(\d{1,9})/goal", fault.pointer)}
            error.robots = frozenset(robot["id"] for index, robot in enumerate(request["robots"]) if index in named)
            raise
        check_plan(request, answer)
        # With invalid_robots "report", goals at fault do not refuse the request.
        faults = [(entry["robot"], fault) for entry in answer["unplanned"] if entry["robot"] in self._given
                  for fault in entry.get("errors", []) if "/goal" in fault["pointer"]]
        if faults:
            refused = RequestRefused(422, {"code": "invalid_request", "detail": faults[0][1]["detail"],
                                           "errors": [fault for _, fault in faults]})
            refused.robots = frozenset(robot for robot, _ in faults)
            raise refused
        if answer.get("dependencies") is None:
            made = self._client.dependencies(request, answer)  # with a time budget of its own
            check_dependencies(request, answer, made)
            if made["dependencies"] is None:
                raise FleetplanError("the time budget does not suffice for the dependencies of the plan")
            answer["dependencies"], answer["tight"] = made["dependencies"], made["tight"]
        return answer

    def _fail(self, error: FleetplanError, *, is_first: bool) -> None:
        """A round has failed: the next round goes on from the present plan. Its new goals are given again, except goals
        at fault. `is_first`: there is no plan yet."""
        self.failure = error
        self._faults.tell(error)
        given, self._given = self._given, {}
        if not isinstance(error, RequestRefused):
            self._goals = {**given, **self._goals}
            return
        names_goals = any("/goal" in fault.pointer for fault in error.faults)
        at_fault = error.robots & given.keys() or (given.keys() if names_goals else set())
        self._goals = {**{robot: goals for robot, goals in given.items() if robot not in at_fault}, **self._goals}
        if at_fault or is_first:
            error.robots = frozenset(at_fault)
            raise error


def _guarded(make: Callable[[], _Made]) -> _Made:
    """A round that ends by an error, whatever it is, costs that round."""
    try:
        return make()
    except FleetplanError:
        raise
    except Exception as error:  # of `change`, or a bug
        raise unforeseen(error) from error


def unforeseen(error: Exception) -> RoundFailed:
    """What a round has failed by that is not foreseen."""
    return RoundFailed(f"{type(error).__name__}: {shown(str(error))}")
