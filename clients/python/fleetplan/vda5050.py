"""The loop of a fleet manager for vehicles that speak VDA 5050 (docs/vda5050.md): plan, release, advance.

Nothing here talks to vehicles: `VdaLoop` gets their state messages and returns the messages to send. `fleetplan.mqtt`
carries them.
"""

import datetime
import functools
import threading
import time
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Future
from dataclasses import dataclass
from typing import Any, Literal

from fleetplan.client import Client
from fleetplan.errors import FleetplanError, RequestRefused
from fleetplan.fleet_loop import LOOP_OPTIONS
from fleetplan.planning_loop import PlanningLoop
from fleetplan.types import (NewGoals, OrderBase, OrderProgress, PlanAnswer, PlanOptions, PlanRequest,
                             Vda5050Answer, Vda5050States, VdaMessage, VehicleReport)

# Those of a FleetLoop, but vehicles follow edges exactly, and may stand as near to each other as they like. For others,
# `inflation` and `execution_margin` have to be the same, so that vehicles keep the distance that plans keep.
VDA_OPTIONS: PlanOptions = LOOP_OPTIONS.copy()
VDA_OPTIONS["inflation"] = VDA_OPTIONS["execution_margin"] = 0.0

_HEADER = ("headerId", "timestamp", "version", "manufacturer", "serialNumber")


@dataclass(frozen=True)
class Message:
    """To be published on a topic of a vehicle."""

    topic: Literal["order", "instantActions"]
    manufacturer: str
    serial_number: str
    body: VdaMessage  # without header


@dataclass
class _Plan:
    """A plan, and the orders that go on with it."""

    request: PlanRequest
    answer: PlanAnswer
    begin: float  # on the clock
    timestamp: str  # of its new orders, whose ids it makes unique
    base: Sequence[OrderBase]  # the orders that vehicles had when it began
    progress: dict[str, OrderProgress]
    tight: frozenset[str]  # robots for which dependencies do not suffice: they go no further than they may already


class VdaLoop(PlanningLoop):
    """Plans a fleet of vehicles, and plans it again while they drive. Call `take` with each state message and `step`
    several times per second, and send the messages that it returns.

    What is released of an order cannot be taken back, so a plan is made from there on, and nothing is released while
    it is made. A round that fails costs nothing but time: vehicles go on with the plan that they have.
    """

    def __init__(self, client: Client, request: PlanRequest, *, manufacturer: str,
                 manufacturers: Mapping[str, str] | None = None, version: Literal["2.1.0", "3.0.0"] = "2.1.0",
                 serial_numbers: Mapping[str, str] | None = None, map_id: str | None = None,
                 map_ids: Mapping[str, str] | None = None, release_ahead: float = 5.0, period: float = 2.0,
                 clock: Callable[[], float] = time.monotonic, background: bool = True,
                 change: Callable[[PlanRequest], None] | None = None) -> None:
        """`release_ahead`: seconds of its plan that a vehicle may go on before the next release. It bounds what a new
        plan cannot change; vehicles stop for a moment if planning takes longer. `period`: seconds from plan to plan.
        `change` is called with each request before it is planned, in the thread that plans."""
        super().__init__(client, request, VDA_OPTIONS, period=period, clock=clock, background=background, change=change)
        self._header: dict[str, Any] = {"version": version, "manufacturer": manufacturer,
                                        "manufacturers": manufacturers, "map_id": map_id, "map_ids": map_ids,
                                        "serial_numbers": serial_numbers, "release_ahead": release_ahead}
        ids = [robot["id"] for robot in request["robots"]]
        self._vehicles = {robot: ((manufacturers or {}).get(robot, manufacturer), (serial_numbers or {}).get(robot, robot))
                          for robot in ids}
        self.cancelled: dict[str, str] = {}  # why orders were cancelled, by robot, until it has another one
        self.rounds = 0  # that have succeeded
        self._states: dict[str, VdaMessage] = {}  # by robot, the last ones
        self._lock = threading.Lock()  # of the states
        self._orders: dict[str, VdaMessage] = {}  # the last messages, by robot
        self._cancels: dict[str, str] = {}  # ids of the actions that cancel orders, by robot
        self._plan: _Plan | None = None
        self._reports: dict[str, VehicleReport] = {}
        self._round: Future[_Plan] | None = None

    # ---------------------------------------------------------------- the loop

    def take(self, state: VdaMessage) -> None:
        """A vehicle reports. Any thread may call this."""
        of_serial = [(robot, make) for robot, (make, serial) in self._vehicles.items() if serial == state.get("serialNumber")]
        for robot, make in of_serial:
            if len(of_serial) == 1 or make == state.get("manufacturer"):
                with self._lock:
                    self._states[robot] = state

    def step(self) -> list[Message]:
        """The messages to send now. Before all vehicles have reported, none.

        Raises RequestRefused if the first request, or goals that were given, are at fault; then these goals are
        dropped, and the loop goes on with the next call."""
        now = self._clock()
        messages: list[Message] = []
        if len(self._states) < len(self._vehicles):
            return messages
        if self._round is None:
            messages += self._release()
            if now >= self._due:
                self._due = now + self._period
                self._begin_round(now)
        return messages + self._take_plan()

    def cancel(self, robot: str, reason: str = "cancelled") -> list[Message]:
        """The message that cancels the robot's order, if it has one. It gets another one when it stands, for the goals
        that it has left: give others, or none, if it is not to go on with them."""
        order = self._orders.get(robot)
        if order is None or robot in self._cancels or self._plan is None:
            return []
        action_id = f"{order['orderId']}-{order['orderUpdateId']}-cancel"
        parameters = [{"key": "orderId", "value": order["orderId"]}] if self._header["version"] == "3.0.0" else []
        body = {"actions": [{"actionType": "cancelOrder", "actionId": action_id, "blockingType": "HARD",
                             "actionParameters": parameters}]}
        self._begin_cancel(robot, action_id, reason)
        return [Message("instantActions", *self._vehicles[robot], body)]

    @property
    def idle(self) -> list[str]:
        """Robots that have served all goals that they were given, and whose vehicles have not failed."""
        if self._plan is None:
            return []
        goes_on = {plan["robot"] for plan in self._plan.answer["plans"] if "ends_at" in plan}
        unplanned = {entry["robot"] for entry in self._plan.answer["unplanned"]}
        busy = goes_on | unplanned | self._goals.keys() | self._given.keys() | self._cancels.keys()
        return [robot for robot, report in self._reports.items()
                if report["arrived"] and not report["failed"] and robot not in busy]

    @property
    def failed(self) -> list[str]:
        """Robots whose vehicles report that they cannot go on, or have refused an order."""
        return [robot for robot, report in self._reports.items() if report["failed"]]

    # ---------------------------------------------------------------- orders

    def _import(self, plan: _Plan) -> Vda5050States:
        """How far vehicles are; what is known of their orders is brought up to date."""
        with self._lock:
            messages = list(self._states.values())
        found = self._client.import_vda5050(plan.request, plan.answer, messages, timestamp=plan.timestamp,
                                            base=plan.base, progress=list(plan.progress.values()), **self._header)
        plan.progress = {entry["robot"]: entry for entry in found["progress"]}
        self._reports = {report["robot"]: report for report in found["vehicles"]}
        for robot, entry in plan.progress.items():
            if robot in self._cancels and "order_id" not in entry:  # it stands
                del self._cancels[robot], self._orders[robot]
        return found

    def _end_orders(self, plan: _Plan) -> None:
        """Vehicles that have done all get new orders with the next plan: no order goes on for a whole day. One that
        still knows a horizon waits for its order to be continued."""
        for robot, report in self._reports.items():
            entry = plan.progress[robot]
            waits = self._states[robot].get("nodeStates")
            if report["accepted"] and report["arrived"] and not waits and robot not in self._cancels:
                plan.progress[robot] = {"robot": robot, "action": entry["action"], "progress": entry["progress"]}
                self._orders.pop(robot, None)

    def _release(self) -> list[Message]:
        """The releases that vehicles have made possible for each other."""
        if self._plan is None:
            return []
        try:
            self._import(self._plan)
            exported = self._export(self._plan)
        except FleetplanError as error:
            self.failure = error
            return []
        # A vehicle whose order was cancelled gets another one with the next plan, which begins where it stands.
        return self._published(self._plan, exported, set(self._orders))

    def _export(self, plan: _Plan) -> Vda5050Answer:
        return self._client.export_vda5050(plan.request, plan.answer, timestamp=plan.timestamp, base=plan.base,
                                           progress=list(plan.progress.values()), **self._header)

    def _published(self, plan: _Plan, exported: Vda5050Answer, robots: set[str]) -> list[Message]:
        messages = []
        for entry in exported["orders"]:
            robot, order = entry["robot"], entry["order"]
            if robot not in robots or robot in plan.tight:
                continue
            first = entry["nodes"][0]
            known = plan.progress.setdefault(
                robot, {"robot": robot, "action": first["action"], "progress": first["progress"]})
            known["order_id"], known["order_update_id"] = order["orderId"], order["orderUpdateId"]
            known["last_released_sequence_id"] = entry["last_released_sequence_id"]
            self._orders[robot] = order
            self.cancelled.pop(robot, None)
            messages.append(Message("order", *self._vehicles[robot], _headless(order)))
        return messages

    def _begin_cancel(self, robot: str, action_id: str, reason: str) -> None:
        self._cancels[robot] = action_id
        self.cancelled[robot] = reason
        if self._plan is not None and robot in self._plan.progress:
            self._plan.progress[robot]["cancel_id"] = action_id

    # ---------------------------------------------------------------- rounds

    def _begin_round(self, now: float) -> None:
        self._given, self._goals = self._goals, {}
        if self._plan is None:
            self._round = self._run(functools.partial(self._first_plan, now))
            return
        try:
            self._round = self._run(self._next(self._plan, now))
        except FleetplanError as error:
            self._fail(error)

    def _next(self, plan: _Plan, now: float) -> Callable[[], _Plan]:
        """What makes the plan of this moment."""
        self._import(plan)
        self._end_orders(plan)
        states = self._import(plan)
        with self._lock:
            reported = dict(self._states)
        base: list[OrderBase] = [
            {"robot": robot, "order": self._orders[robot], "state": reported[robot]}
            for robot, entry in plan.progress.items() if "order_id" in entry]
        goals: list[NewGoals] = [{"robot": robot, "goals": given} for robot, given in self._given.items()]
        advance = functools.partial(self._client.advance, plan.request, plan.answer, now - plan.begin,
                                    states=states["states"], poses=states["poses"], goals=goals)
        return functools.partial(self._next_plan, advance, base, now)

    def _first_plan(self, now: float) -> _Plan:
        return self._planned(self._first_request(), [], now)

    def _next_plan(self, advance: Callable[[], PlanRequest], base: Sequence[OrderBase], now: float) -> _Plan:
        return self._planned(self._changed(advance()), base, now)

    def _planned(self, request: PlanRequest, base: Sequence[OrderBase], now: float) -> _Plan:
        answer = self._make_plan(request)
        tight = frozenset(robot for pair in answer.get("tight") or [] for robot in pair["robots"])
        return _Plan(request, answer, now, _timestamp(), base, {}, tight)

    def _take_plan(self) -> list[Message]:
        """Goes on with the next plan if it is ready, and if all orders can be continued by it."""
        if self._round is None or not self._round.done():
            return []
        future, self._round = self._round, None
        try:
            plan = future.result()
            plan.progress = {entry["robot"]: self._progress_of(entry) for entry in plan.base}
            exported = self._export(plan)
        except FleetplanError as error:
            self._fail(error)
            return []
        if exported["cancel_orders"]:
            return self._cancel_all(exported)
        self.failure, self._given, self._plan, self.request = None, {}, plan, plan.request
        self.rounds += 1
        return self._published(plan, exported, set(self._vehicles))

    def _progress_of(self, base: OrderBase) -> OrderProgress:
        """An order at the begin of a plan."""
        order = base["order"]
        last = max(node["sequenceId"] for node in order["nodes"] if node["released"])
        progress: OrderProgress = {"robot": base["robot"], "order_id": order["orderId"],
                                   "order_update_id": order["orderUpdateId"], "last_released_sequence_id": last,
                                   "action": 0, "progress": 0.0}
        if base["robot"] in self._cancels:
            progress["cancel_id"] = self._cancels[base["robot"]]
        return progress

    def _cancel_all(self, exported: Vda5050Answer) -> list[Message]:
        """Nobody goes on by a plan that some vehicles cannot follow: they stand before the next one is made."""
        messages = []
        for entry in exported["cancel_orders"]:
            robot, message = entry["robot"], entry["instant_actions"]
            if robot not in self._cancels:
                self._begin_cancel(robot, message["actions"][0]["actionId"], entry["detail"])
                messages.append(Message("instantActions", *self._vehicles[robot], _headless(message)))
        self._goals = {**self._given, **self._goals}
        self._given = {}
        return messages

    def _fail(self, error: FleetplanError) -> None:
        """Goes on with the plan that there is."""
        self.failure = error
        given, self._given = self._given, {}
        if isinstance(error, RequestRefused):
            goals_at_fault = given and any("/goal" in fault.pointer for fault in error.faults)
            if goals_at_fault or self._plan is None:
                raise error
        self._goals = {**given, **self._goals}


def _timestamp() -> str:
    return datetime.datetime.now(datetime.UTC).isoformat(timespec="milliseconds").replace("+00:00", "Z")


def _headless(message: VdaMessage) -> VdaMessage:
    """Without the members that whoever sends it fills in."""
    return {name: value for name, value in message.items()
            if name not in _HEADER}
