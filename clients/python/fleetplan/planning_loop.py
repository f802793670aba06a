"""What loops that plan a fleet again and again have in common."""

import copy
from collections.abc import Callable, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from types import TracebackType
from typing import Self, TypeVar

from fleetplan.client import Client
from fleetplan.errors import FleetplanError, RequestRefused
from fleetplan.types import Goal, PlanAnswer, PlanOptions, PlanRequest

_Made = TypeVar("_Made")
_Request = TypeVar("_Request", bound=PlanRequest)


class PlanningLoop:
    """The request that was planned last, the goals that robots are given, and the thread that plans. A context manager,
    which ends the thread."""

    def __init__(self, client: Client, request: PlanRequest, defaults: PlanOptions, *, period: float,
                 clock: Callable[[], float], background: bool, change: Callable[[PlanRequest], None] | None) -> None:
        """`defaults`: options that the request need not have."""
        self.request = copy.deepcopy(request)  # that was planned last
        options = defaults.copy()
        options.update(request.get("options", {}))
        options["dependencies"] = True
        self.request["options"] = options
        self.failure: FleetplanError | None = None  # of the last round; none if it succeeded
        self._client, self._period, self._clock, self._change = client, period, clock, change
        self._threads = ThreadPoolExecutor(1, "fleetplan") if background else None
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
        """Other goals than those that the robot has left, from the next round on; none to let it stand."""
        self._goals[robot] = list(goals)

    def _run(self, make: Callable[[], _Made]) -> "Future[_Made]":
        """In the background, if there is one."""
        if self._threads is not None:
            return self._threads.submit(make)
        future: Future[_Made] = Future()
        try:
            future.set_result(make())
        except FleetplanError as error:
            future.set_exception(error)
        return future

    def _first_request(self) -> PlanRequest:
        """With the goals that were given before the first round."""
        for robot in self.request["robots"]:
            if robot["id"] in self._given:
                robot.pop("goal", None)
                robot["goals"] = self._given[robot["id"]]
        return self._changed(self.request)

    def _changed(self, request: _Request) -> _Request:
        if self._change is not None:
            self._change(request)
        return request

    def _make_plan(self, request: PlanRequest) -> PlanAnswer:
        """The plan with its dependencies."""
        answer = self._client.plan(request)
        # With invalid_robots "report", goals at fault do not refuse the request.
        faults = [fault for entry in answer["unplanned"] if entry["robot"] in self._given
                  for fault in entry.get("errors", []) if "/goal" in fault["pointer"]]
        if faults:
            raise RequestRefused(422, {"code": "invalid_request", "detail": faults[0]["detail"], "errors": faults})
        if answer.get("dependencies") is None:
            made = self._client.dependencies(request, answer)  # with a time budget of its own
            if made["dependencies"] is None:
                raise FleetplanError("the time budget does not suffice for the dependencies of the plan")
            answer["dependencies"], answer["tight"] = made["dependencies"], made["tight"]
        return answer
