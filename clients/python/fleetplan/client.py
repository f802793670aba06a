"""The endpoints of the service as methods."""

import contextlib
import datetime
import json
import ssl
import time
from collections.abc import Generator, Iterator, Mapping, Sequence
from types import TracebackType
from typing import Literal, cast
from urllib.parse import quote

from fleetplan.errors import ConnectionFailed, ProblemError, problem_error
from fleetplan.http import Pool, Response, read_json
from fleetplan.types import (AdvanceAnswer, AssignAnswer, DependenciesAnswer, Disturbance, Health, Hold, Limits,
                             LoneRobot, MatrixAnswer, MeasuredPose, NewGoals, OrderBase, OrderProgress, PacedState,
                             PlanAnswer, PlanEvent, PlanRequest, Plans, RetimeAnswer, RobotState, SimulationAnswer,
                             SimulationEvent, Task, TravelPose, Vda5050Answer, Vda5050States, VdaMessage, VehiclePose,
                             Verdict)

_PROBLEM_WITHOUT_BODY = "the answer is not problem details; is this a proxy?"
_RETRY_AFTER = 1.0  # seconds, if the server does not say


class Client:
    """A client of one server. Threads may share it: each request has a connection of its own, which is kept.

    Requests that the server refuses because it is busy (503) are sent again when it asks for that (`Retry-After`).
    """

    def __init__(self, url: str = "http://localhost:8080", *, token: str | None = None, timeout: float = 10.0,
                 patience: float = 30.0, context: ssl.SSLContext | None = None) -> None:
        """`token`: of servers that require one. `timeout`: seconds for which the server may be silent, beside the time
        budget of the request. `patience`: seconds in which a request to a busy server is sent again; 0 for never.
        `context`: of https; by default, the certificates that the system trusts."""
        self._pool = Pool(url, context)
        self._headers = {"User-Agent": "fleetplan-python"}
        if token is not None:
            self._headers["Authorization"] = f"Bearer {token}"
        self._timeout, self._patience = timeout, patience

    def __enter__(self) -> "Client":
        return self

    def __exit__(self, kind: type[BaseException] | None, value: BaseException | None,
                 trace: TracebackType | None) -> None:
        self.close()

    def close(self) -> None:
        """Closes the connections that are kept."""
        self._pool.close()

    # ---------------------------------------------------------------- planning

    def plan(self, request: PlanRequest) -> PlanAnswer:
        return cast(PlanAnswer, self._post("/v1/plan", request))

    def plan_events(self, request: PlanRequest) -> Generator[PlanEvent, None, None]:
        """The events `progress` and `incumbent` as they happen; the last one is `plan`, with the answer. Closing the
        generator before cancels the plan."""
        for name, data in self._events("/v1/plan", request, "plan"):
            yield cast(PlanEvent, {"event": name, "data": data})

    def advance(self, request: PlanRequest, plans: Plans, at: float, *, commit: float | None = None,
                states: Sequence[RobotState] = (), poses: Sequence[MeasuredPose] | Sequence[VehiclePose] = (),
                holds: Sequence[Hold] = (), goals: Sequence[NewGoals] = (),
                pose_tolerance: float | None = None) -> AdvanceAnswer:
        """The request of the moment `at`, seconds after the start of these plans, and where robots are in it. States and
        poses may be those of import_vda5050."""
        body = _given(request=request, plans=plans["plans"], at=at, commit=commit, states=states or None,
                      poses=poses or None, holds=holds or None, goals=goals or None, pose_tolerance=pose_tolerance)
        return cast(AdvanceAnswer, self._post("/v1/advance", body, request))

    # ---------------------------------------------------------------- which robot does what

    def matrix(self, request: PlanRequest, robot: LoneRobot, from_: Sequence[TravelPose],
               to: Sequence[TravelPose], *, format: Literal["numbers", "integers"] | None = None) -> MatrixAnswer:
        """How long the robot takes between these poses alone on the map, with the zones and options of the request."""
        body = _given(_part(request, "map", "zones", "options"), {"from": from_}, robot=robot, to=to, format=format)
        return cast(MatrixAnswer, self._post("/v1/matrix", body, request))

    def assign(self, request: PlanRequest, tasks: Sequence[Task]) -> AssignAnswer:
        """The request with the goals of the tasks that its robots get, at most one each."""
        return cast(AssignAnswer, self._post("/v1/assign", {"request": request, "tasks": tasks}, request))

    # ---------------------------------------------------------------- plans, of this service or of others

    def validate(self, request: PlanRequest, plans: Plans, *, tolerance: float | None = None) -> Verdict:
        return cast(Verdict, self._post("/v1/validate", _given(request, plans, tolerance=tolerance), request))

    def dependencies(self, request: PlanRequest, plans: Plans) -> DependenciesAnswer:
        return cast(DependenciesAnswer, self._post("/v1/dependencies", _given(request, plans), request))

    def simulate(self, request: PlanRequest, plans: Plans,
                 policy: Literal["open_loop", "absorb_waits", "dependencies", "clock_stop"], *,
                 disturbance: Disturbance | None = None, runs: int | None = None, seed: int | None = None,
                 max_delay: float | None = None, trace: int | None = None) -> SimulationAnswer:
        body = _given(request, plans, policy=policy, disturbance=disturbance, runs=runs, seed=seed,
                      max_delay=max_delay, trace=trace)
        return cast(SimulationAnswer, self._post("/v1/simulate", body, request))

    def simulate_events(self, request: PlanRequest, plans: Plans,
                        policy: Literal["open_loop", "absorb_waits", "dependencies", "clock_stop"], *,
                        disturbance: Disturbance | None = None, runs: int | None = None, seed: int | None = None,
                        max_delay: float | None = None,
                        trace: int | None = None) -> Generator[SimulationEvent, None, None]:
        """The events `progress` as they happen; the last one is `simulation`, with the answer."""
        body = _given(request, plans, policy=policy, disturbance=disturbance, runs=runs, seed=seed,
                      max_delay=max_delay, trace=trace)
        for name, data in self._events("/v1/simulate", body, "simulation"):
            yield cast(SimulationEvent, {"event": name, "data": data})

    def retime(self, request: PlanRequest, plans: Plans, at: float, states: Sequence[PacedState]) -> RetimeAnswer:
        """When robots will arrive that are in these states at the moment `at`. The plans have dependencies."""
        body = _given(_part(request, "robots", "robot_defaults", "options"), _part(plans, "plans", "dependencies"),
                      at=at, states=states)
        return cast(RetimeAnswer, self._post("/v1/retime", body, request))

    def export_vda5050(self, request: PlanRequest, plans: Plans, *, version: Literal["2.1.0", "3.0.0"],
                       manufacturer: str, manufacturers: Mapping[str, str] | None = None, timestamp: str | None = None,
                       map_id: str | None = None, map_ids: Mapping[str, str] | None = None,
                       serial_numbers: Mapping[str, str] | None = None, release_ahead: float | None = None,
                       allowed_deviation: float | None = None,
                       base: Sequence[OrderBase] = (), progress: Sequence[OrderProgress] = ()) -> Vda5050Answer:
        """`timestamp`: in UTC, as ISO 8601 has it; by default, now. The plans have dependencies."""
        body = _vda5050(request, plans, version=version, manufacturer=manufacturer, manufacturers=manufacturers,
                        timestamp=timestamp, map_id=map_id, map_ids=map_ids, serial_numbers=serial_numbers,
                        release_ahead=release_ahead, allowed_deviation=allowed_deviation, base=base or None,
                        progress=progress or None)
        return cast(Vda5050Answer, self._post("/v1/export/vda5050", body, request))

    def import_vda5050(self, request: PlanRequest, plans: Plans, messages: Sequence[VdaMessage], *,
                       version: Literal["2.1.0", "3.0.0"], manufacturer: str,
                       manufacturers: Mapping[str, str] | None = None, timestamp: str | None = None,
                       map_id: str | None = None, map_ids: Mapping[str, str] | None = None,
                       serial_numbers: Mapping[str, str] | None = None, release_ahead: float | None = None,
                       allowed_deviation: float | None = None,
                       base: Sequence[OrderBase] = (), progress: Sequence[OrderProgress] = ()) -> Vda5050States:
        """What vehicles report. `messages`: the last state of each, whatever it is; the other parameters are those of the last export."""
        body = _vda5050(request, plans, version=version, manufacturer=manufacturer, manufacturers=manufacturers,
                        timestamp=timestamp, map_id=map_id, map_ids=map_ids, serial_numbers=serial_numbers,
                        release_ahead=release_ahead, allowed_deviation=allowed_deviation, base=base or None,
                        progress=progress or None, messages=messages)
        return cast(Vda5050States, self._post("/v1/import/vda5050", body, request))

    # ---------------------------------------------------------------- the server

    def limits(self) -> Limits:
        return cast(Limits, self._answer("GET", "/v1/limits"))

    def health(self) -> Health:
        return cast(Health, self._answer("GET", "/healthz"))

    def examples(self) -> list[str]:
        """The names of the example requests."""
        listed = cast(dict[str, list[dict[str, str]]], self._answer("GET", "/v1/examples"))
        return [example["name"] for example in listed["examples"]]

    def example(self, name: str) -> PlanRequest:
        return cast(PlanRequest, self._answer("GET", "/v1/examples/" + quote(name, safe="")))

    # ---------------------------------------------------------------- requests

    def _post(self, path: str, body: Mapping[str, object], request: Mapping[str, object] | None = None) -> object:
        """`request`: the one that has the options, if it is not the body."""
        return self._answer("POST", path, body, self._silence(request or body))

    def _silence(self, request: Mapping[str, object]) -> float:
        """Seconds for which the server may compute and be silent."""
        options = request.get("options")
        budget = options.get("time_budget_ms") if isinstance(options, Mapping) else None
        default = 5000.0  # of the server, unless it is set otherwise
        return self._timeout + (budget if isinstance(budget, int | float) else default) / 1000.0

    def _answer(self, method: str, path: str, body: Mapping[str, object] | None = None,
                timeout: float | None = None) -> object:
        with self._send(method, path, "application/json", body, timeout or self._timeout) as response:
            text = response.read()
        value = read_json(text)
        if value is None:
            raise ConnectionFailed(f"{self._pool.url}{path} answers {text[:80]!r}, which is not JSON")
        return value

    def _events(self, path: str, body: Mapping[str, object], last: str) -> Iterator[tuple[str, object]]:
        """Events come at least four times per second, so the server is never silent for long."""
        with self._send("POST", path, "text/event-stream", body, self._timeout) as response:
            for event in response.events():
                data = read_json(event.data)
                if event.name == "problem" and isinstance(data, Mapping):
                    raise _as_error(data)
                if event.name == last:
                    response.read()  # to its end, so that the connection is kept
                yield event.name, data
                if event.name == last:
                    return
        raise ConnectionFailed(f"the events of {self._pool.url}{path} end without {last}")

    def _send(self, method: str, path: str, accept: str, body: Mapping[str, object] | None,
              timeout: float) -> Response:
        """The answer to a request that succeeds; its body is still to be read."""
        headers = {**self._headers, "Accept": accept}
        sent = None
        if body is not None:
            sent = json.dumps(body, separators=(",", ":"), allow_nan=False).encode()
            headers["Content-Type"] = "application/json"
        give_up = time.monotonic() + self._patience
        while True:
            response = self._pool.send(method, path, headers, sent, timeout)
            if response.status < 400:
                return response
            with response:
                problem = read_json(response.read())
            wait = _retry_after(response.retry_after)
            if response.status != 503 or time.monotonic() + wait > give_up:
                known = problem if isinstance(problem, Mapping) else {"detail": _PROBLEM_WITHOUT_BODY}
                raise problem_error(response.status, known)
            time.sleep(wait)


def _as_error(problem: Mapping[str, object]) -> ProblemError:
    status = problem.get("status")
    return problem_error(status if isinstance(status, int) else 500, problem)


def _retry_after(header: str | None) -> float:
    """Seconds. The header may have a date instead, which this service does not send."""
    with contextlib.suppress(TypeError, ValueError):
        return max(0.0, float(cast(str, header)))
    return _RETRY_AFTER


def _given(*parts: Mapping[str, object], **members: object) -> dict[str, object]:
    """All members of the parts, and those that are not None."""
    body: dict[str, object] = {}
    for part in parts:
        body.update(part)
    body.update({name: value for name, value in members.items() if value is not None})
    return body


def _vda5050(request: PlanRequest, plans: Plans, *, timestamp: str | None, **members: object) -> dict[str, object]:
    now = datetime.datetime.now(datetime.UTC).isoformat(timespec="milliseconds").replace("+00:00", "Z")
    return _given(_part(request, "robots", "robot_defaults", "options"), _part(plans, "plans", "dependencies"),
                  timestamp=timestamp or now, **members)


def _part(whole: Mapping[str, object], *names: str) -> dict[str, object]:
    return {name: whole[name] for name in names if name in whole}
