"""The endpoints of the service as methods."""

import datetime
import email.utils
import math
import ssl
import time
from collections.abc import Generator, Iterator, Mapping, Sequence
from types import TracebackType
from typing import Literal, cast
from urllib.parse import quote

from fleetplan.errors import (ConnectionFailed, FleetplanError, InvalidAnswer, InvalidValue, ProblemError, problem_error,
                              shown)
from fleetplan.http import Bounds, Pool, Response, read_json, write_json
from fleetplan.types import (AdvanceAnswer, Aim, AssignAnswer, DependenciesAnswer, Disturbance, Health, Hold, Limits,
                             LoneRobot, MarginsAnswer, MarginsEvent, MarginValues, MatrixAnswer, MeasuredPose, NewGoals,
                             OrderBase, OrderProgress, PacedState, PlanAnswer, PlanEvent, PlanRequest, Plans,
                             RetimeAnswer, RobotState, SimulationAnswer, SimulationEvent, Task, TravelPose,
                             Vda5050Answer, Vda5050States, VdaMessage, VehiclePose, Verdict)

_PROBLEM_WITHOUT_BODY = "the answer is not problem details; is this a proxy?"
_RETRY_AFTER = 1.0  # seconds, if the server does not say
_LEAST_WAIT = 0.25  # seconds, whatever it says
_MAX_BYTES = 256 << 20  # of an answer
_MAX_BUDGET = 1e9  # milliseconds: more is no time budget


class Client:
    """A client of one server. Threads may share it: each request has a connection of its own, which is kept.

    Requests that the server refuses because it is busy (503) are sent again when it asks for that (`Retry-After`).
    """

    def __init__(self, url: str = "http://localhost:8080", *, token: str | None = None, timeout: float = 10.0,
                 patience: float = 30.0, context: ssl.SSLContext | None = None, max_answer: int = _MAX_BYTES) -> None:
        """`token`: for servers that require a token. `timeout`: seconds that a request may take as a whole, beside its
        time budget, from its connection to the end of its answer. The server may also be silent for so long between
        events. `patience`: seconds in which a request to a busy server is sent again; 0 for never. `context`: for
        https; by default, the system's trusted certificates. `max_answer`: bytes of an answer, or of an event."""
        self._pool = Pool(url, context)
        if not timeout > 0.0 or not patience >= 0.0 or max_answer < 1:
            raise InvalidValue("timeout and max_answer are more than 0, and patience is not negative")
        if token is not None and not (token.isascii() and token.isprintable()):
            raise InvalidValue("the token has characters that a header cannot have")
        self._headers = {"User-Agent": "fleetplan-python"}
        if token is not None:
            self._headers["Authorization"] = f"Bearer {token}"
        self._timeout, self._patience, self._max_answer = timeout, patience, max_answer

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
        """The events `progress` and `incumbent` as they happen. The last event is `plan`, with the answer. Closing the
        generator before cancels the plan."""
        for name, data in self._events("/v1/plan", request, "plan"):
            yield cast(PlanEvent, {"event": name, "data": data})

    def advance(self, request: PlanRequest, plans: Plans, at: float, *, commit: float | None = None,
                states: Sequence[RobotState] = (), poses: Sequence[MeasuredPose] | Sequence[VehiclePose] = (),
                holds: Sequence[Hold] = (), goals: Sequence[NewGoals] = (),
                pose_tolerance: float | None = None) -> AdvanceAnswer:
        """The request of the moment `at`, seconds after the start of these plans, and the robots' positions in the
        plans. States and poses may come from import_vda5050."""
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
        """The events `progress` as they happen. The last event is `simulation`, with the answer."""
        body = _given(request, plans, policy=policy, disturbance=disturbance, runs=runs, seed=seed,
                      max_delay=max_delay, trace=trace)
        for name, data in self._events("/v1/simulate", body, "simulation"):
            yield cast(SimulationEvent, {"event": name, "data": data})

    def margins(self, request: PlanRequest, policy: Literal["open_loop", "absorb_waits", "dependencies", "clock_stop"],
                disturbance: Disturbance, *, max_delay: float | None = None, aim: Aim | None = None,
                runs: int | None = None, seed: int | None = None,
                try_: MarginValues | None = None) -> MarginsAnswer:
        """The cheapest margins with which a plan of the request holds when it is executed so, and that plan."""
        body = _given({"try": try_} if try_ is not None else {}, request=request, policy=policy, disturbance=disturbance,
                      max_delay=max_delay, aim=aim, runs=runs, seed=seed)
        return cast(MarginsAnswer, self._post("/v1/margins", body, request))

    def margins_events(self, request: PlanRequest,
                       policy: Literal["open_loop", "absorb_waits", "dependencies", "clock_stop"],
                       disturbance: Disturbance, *, max_delay: float | None = None, aim: Aim | None = None,
                       runs: int | None = None, seed: int | None = None,
                       try_: MarginValues | None = None) -> Generator[MarginsEvent, None, None]:
        """The events `progress` as they happen; the last one is `margins`, with the answer."""
        body = _given({"try": try_} if try_ is not None else {}, request=request, policy=policy, disturbance=disturbance,
                      max_delay=max_delay, aim=aim, runs=runs, seed=seed)
        for name, data in self._events("/v1/margins", body, "margins", request):
            yield cast(MarginsEvent, {"event": name, "data": data})

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
        """What vehicles report. `messages`: the last state message of each vehicle, with any content. The other
        parameters are the same as for the last export.
        """
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
        listed = self._answer("GET", "/v1/examples").get("examples")
        names = [example.get("name") for example in listed if isinstance(example, dict)] if isinstance(listed, list) else []
        if not names or not all(isinstance(name, str) for name in names):
            raise InvalidAnswer(f"{self._pool.url} lists no examples")
        return cast(list[str], names)

    def example(self, name: str) -> PlanRequest:
        return cast(PlanRequest, self._answer("GET", "/v1/examples/" + quote(name, safe="")))

    # ---------------------------------------------------------------- requests

    def _post(self, path: str, body: Mapping[str, object], request: Mapping[str, object] | None = None) -> object:
        """`request`: the request with the options, if it is not the body."""
        return self._answer("POST", path, body, _budget(request or body))

    def _answer(self, method: str, path: str, body: Mapping[str, object] | None = None,
                budget: float = 0.0) -> dict[str, object]:
        """`budget`: seconds for which the server may compute."""
        whole = self._timeout + budget
        with self._send(method, path, "application/json", body, whole, whole) as response:
            text = response.read()
        value = read_json(text)
        if value is None:
            raise InvalidAnswer(f"{self._pool.url}{path} answers {text[:80]!r}, which is not JSON")
        if not isinstance(value, dict):
            raise InvalidAnswer(f"{self._pool.url}{path} answers {text[:80]!r}, which is no object")
        return value

    def _events(self, path: str, body: Mapping[str, object], last: str,
                request: Mapping[str, object] | None = None) -> Iterator[tuple[str, object]]:
        """Events come at least four times per second, so the server is never silent for long. `request`: as in
        _post."""
        whole = self._timeout + _budget(request or body)
        with self._send("POST", path, "text/event-stream", body, self._timeout, whole) as response:
            for event in response.events():
                data = read_json(event.data)
                if not isinstance(data, dict):
                    raise InvalidAnswer(f"{self._pool.url}{path} sends an event {shown(event.data[:80])}")
                if event.name == "problem":
                    raise _as_error(data)
                if event.name == last:
                    response.read()  # to its end, so that the connection is kept
                yield event.name, data
                if event.name == last:
                    return
        raise ConnectionFailed(f"the events of {self._pool.url}{path} end without {last}")

    def _send(self, method: str, path: str, accept: str, body: Mapping[str, object] | None, silence: float,
              whole: float) -> Response:
        """The answer to a request that succeeds; its body is still to be read. `silence`, `whole`: seconds, see
        `Bounds`."""
        headers = {**self._headers, "Accept": accept}
        sent = None
        if body is not None:
            sent = write_json(body).encode()
            headers["Content-Type"] = "application/json"
        give_up = time.monotonic() + self._patience
        while True:
            response = self._pool.send(method, path, headers, sent, Bounds(silence, whole, self._max_answer))
            if response.status == 200:
                return response
            wait = _retry_after(response.retry_after)
            error = self._error_of(response)
            if response.status != 503 or time.monotonic() + wait > give_up:
                raise error
            time.sleep(wait)

    def _error_of(self, response: Response) -> FleetplanError:
        """What an answer says that is not a success. Redirections are not followed: the service sends none."""
        with response:
            if response.status < 400:
                return InvalidAnswer(f"{self._pool.url} answers {response.status} {shown(response.reason)}; "
                                     f"is this a proxy?")
            try:
                problem = read_json(response.read())
            except FleetplanError:
                problem = None
        return problem_error(response.status, problem if isinstance(problem, dict) else {"detail": _PROBLEM_WITHOUT_BODY})


def _budget(request: Mapping[str, object]) -> float:
    """Seconds for which the server may compute."""
    options = request.get("options")
    given = options.get("time_budget_ms") if isinstance(options, Mapping) else None
    default = 5000.0  # of the server, unless it is set otherwise
    return (given if isinstance(given, int | float) and 0.0 <= given <= _MAX_BUDGET else default) / 1000.0


def _as_error(problem: Mapping[str, object]) -> ProblemError:
    status = problem.get("status")
    return problem_error(status if isinstance(status, int) else 500, problem)


def _retry_after(header: str | None) -> float:
    """Seconds, never less than a wait that spares the server. The header has seconds, or a date (RFC 9110)."""
    try:
        seconds = float(header or "nan")
    except ValueError:
        try:
            seconds = email.utils.parsedate_to_datetime(header or "").timestamp() - time.time()
        except (TypeError, ValueError, OverflowError, IndexError):
            seconds = math.nan
    return _RETRY_AFTER if math.isnan(seconds) else max(_LEAST_WAIT, seconds)


def _given(*parts: Mapping[str, object], **members: object) -> dict[str, object]:
    """All members of the parts, and the other members that are not None."""
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
