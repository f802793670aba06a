"""The loop of a fleet manager for vehicles that speak VDA 5050 (docs/vda5050.md): plan, release, advance.

Nothing here talks to vehicles: `VdaLoop` gets their state messages and returns the messages to send. `fleetplan.mqtt`
carries them.
"""

import datetime
import functools
import math
import re
import threading
import time
from collections.abc import Callable, Collection, Mapping, Sequence
from concurrent.futures import Future
from dataclasses import dataclass, field
from typing import Any, Literal

from fleetplan.answers import check_orders, check_states, what_is_given
from fleetplan.client import Client
from fleetplan.errors import FleetplanError, InvalidValue, MessageRejected, RequestRefused, VehicleUnavailable
from fleetplan.faults import OnFault
from fleetplan.fleet_loop import LOOP_OPTIONS
from fleetplan.planning_loop import PlanningLoop, unforeseen
from fleetplan.types import (AdvanceAnswer, Goal, NewGoals, OrderBase, OrderProgress, PlanAnswer, PlanOptions, PlanRequest,
                             RobotState, Vda5050Answer, Vda5050States, VdaMessage, VehicleReport)
from fleetplan.unavailable import put_aside, serve_once, start_where_measured, unmeasured
from fleetplan.vehicle_states import read_state, sender_of

# The options of a FleetLoop, except that vehicles follow edges exactly, and may stand as near to each other as they
# like. For other vehicles, `inflation` and `execution_margin` have to be equal, so that vehicles keep the distance that
# plans keep.
VDA_OPTIONS: PlanOptions = LOOP_OPTIONS.copy()
VDA_OPTIONS["inflation"] = VDA_OPTIONS["execution_margin"] = 0.0

# Why a vehicle takes no orders, of the reasons that the service names. Others pass by themselves, or with another order.
_LASTING = frozenset({"not_reported", "operating_mode", "emergency_stop", "paused", "not_localized", "other_map", "error"})

_ARRIVES_S = 10.0  # a message that its vehicle has not taken by then was lost

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
    aside: dict[str, list[Goal]] = field(default_factory=dict)  # goals of robots that are not available


class VdaLoop(PlanningLoop):
    """Plans a fleet of vehicles, and plans it again while they drive. Call `take` with each state message and `step`
    several times per second, and send the messages that it returns.

    The released part of an order cannot be taken back. So a plan begins at its end, and nothing is released while the
    plan is made. A round that fails costs only time: vehicles go on with their present plan. A state message that
    cannot be read is ignored. A vehicle that is not available gets no orders, and its goals are put aside until it is
    available.
    """

    def __init__(self, client: Client, request: PlanRequest, *, manufacturer: str,
                 manufacturers: Mapping[str, str] | None = None, version: Literal["2.1.0", "3.0.0"] = "2.1.0",
                 serial_numbers: Mapping[str, str] | None = None, map_id: str | None = None,
                 map_ids: Mapping[str, str] | None = None, release_ahead: float = 5.0, period: float = 2.0,
                 wait: float = 30.0, clock: Callable[[], float] = time.monotonic, background: bool = True,
                 change: Callable[[PlanRequest], None] | None = None, on_fault: OnFault | None = None) -> None:
        """`release_ahead`: seconds of its plan that a vehicle may go on before the next release. It bounds the part
        that a new plan cannot change. Vehicles stop for a moment if planning takes longer. `period`: seconds from plan
        to plan. `wait`: seconds for which the first plan waits for vehicles that have not reported.

        `change` is called with each request before it is planned, in the thread that plans. `on_fault` is called with
        each fault, in the thread that has found it. A fault is a round that failed, a state that is not used, or a
        vehicle that is not available. Faults are logged, too."""
        super().__init__(client, request, VDA_OPTIONS, period=period, clock=clock, background=background, change=change,
                         on_fault=on_fault)
        self._header: dict[str, Any] = {"version": version, "manufacturer": manufacturer,
                                        "manufacturers": manufacturers, "map_id": map_id, "map_ids": map_ids,
                                        "serial_numbers": serial_numbers, "release_ahead": release_ahead}
        ids = [robot["id"] for robot in request["robots"]]
        self._vehicles = {robot: ((manufacturers or {}).get(robot, manufacturer), (serial_numbers or {}).get(robot, robot))
                          for robot in ids}
        self._robots = {vehicle: robot for robot, vehicle in self._vehicles.items()}
        self._idle = {robot["id"]: robot.get("idle") for robot in request["robots"]}
        self.cancelled: dict[str, str] = {}  # why orders were cancelled, by robot, until it has a new order
        self.unavailable: dict[str, str] = {}  # why vehicles are not available, by robot
        self.rounds = 0  # that have succeeded
        self._wait, self._waits_since = wait, math.inf
        self._states: dict[str, VdaMessage] = {}  # by robot, the last ones
        self._imported: dict[str, VdaMessage] = {}  # by robot, the last state messages that the service has read
        self._lock = threading.Lock()  # of the states
        self._orders: dict[str, VdaMessage] = {}  # the last messages, with the nodes before them, by robot
        self._cancels: dict[str, str] = {}  # ids of the actions that cancel orders, by robot
        self._sent: dict[str, tuple[float, Message]] = {}  # the last messages, and when, by robot
        self._plan: _Plan | None = None
        self._reports: dict[str, VehicleReport] = {}
        self._round: Future[_Plan] | None = None

    # ---------------------------------------------------------------- the loop

    def take(self, state: VdaMessage) -> None:
        """A vehicle reports. Any thread may call this. A message that cannot be read, or is of no vehicle of the fleet,
        is not used, and told."""
        try:
            read = read_state(state)
            robot = self._robot_of(read)
        except InvalidValue as error:
            self._faults.tell(MessageRejected(sender_of(state), f"its state {error}"))
            return
        read["manufacturer"], read["serialNumber"] = self._vehicles[robot]
        with self._lock:
            self._states[robot] = read

    def _robot_of(self, state: VdaMessage) -> str:
        """By serial number; by the make, too, unless the vehicle does not say it, and no other make has the number."""
        make, serial = state.get("manufacturer"), state.get("serialNumber")
        robots = [robot for (its_make, its_serial), robot in self._robots.items()
                  if its_serial == serial and make in (None, its_make)]
        if len(robots) != 1:
            raise InvalidValue("is of no vehicle of the fleet")
        return robots[0]

    def step(self) -> list[Message]:
        """The messages to send now. None before all vehicles have reported, or `wait` is over.

        Raises RequestRefused if the first request, or goals that were given, are at fault. Then these goals are
        dropped, and the loop goes on with the next call."""
        now = self._clock()
        messages: list[Message] = []
        if self._plan is None and not self._have_reported(now):
            return messages
        if self._round is None:
            messages += self._release()
            messages += self._cancel_failed()
            messages += self._lost(now)
            if now >= self._due:
                self._due = now + self._period
                self._begin_round(now)
        return messages + self._take_plan()

    def cancel(self, robot: str, reason: str = "cancelled") -> list[Message]:
        """The message that cancels the robot's order, if it has an order. When it stands, it gets a new order for the
        goals that it has left. If it should not go on with them, give other goals, or none."""
        order = self._orders.get(robot)
        if order is None or robot in self._cancels or self._plan is None:
            return []
        action_id = f"{order['orderId']}-{order['orderUpdateId']}-cancel"
        parameters = [{"key": "orderId", "value": order["orderId"]}] if self._header["version"] == "3.0.0" else []
        body = {"actions": [{"actionType": "cancelOrder", "actionId": action_id, "blockingType": "NONE",
                             "actionParameters": parameters}]}
        self._begin_cancel(robot, action_id, reason)
        return [self._message(robot, "instantActions", body)]

    @property
    def idle(self) -> list[str]:
        """Robots that have served all goals that they were given, and whose vehicles are available."""
        if self._plan is None:
            return []
        goes_on = {plan["robot"] for plan in self._plan.answer["plans"] if "ends_at" in plan}
        unplanned = {entry["robot"] for entry in self._plan.answer["unplanned"]}
        busy = goes_on | unplanned | self._goals.keys() | self._given.keys() | self._cancels.keys()
        busy |= self.unavailable.keys() | self._plan.aside.keys()
        return [robot for robot, report in self._reports.items()
                if report["arrived"] and not report["failed"] and robot not in busy]

    @property
    def failed(self) -> list[str]:
        """Robots whose vehicles report that they cannot go on, or have refused an order."""
        return [robot for robot, report in self._reports.items() if report["failed"]]

    def _have_reported(self, now: float) -> bool:
        """Whether all vehicles have reported, or the wait for the other vehicles is over."""
        self._waits_since = min(self._waits_since, now)
        with self._lock:
            silent = self._vehicles.keys() - self._states.keys()
        if silent and now - self._waits_since < self._wait:
            return False
        self._set_unavailable(dict.fromkeys(sorted(silent), "it has not reported"))
        return True

    def _set_unavailable(self, reasons: dict[str, str]) -> None:
        for robot, reason in reasons.items():
            if self.unavailable.get(robot) != reason:
                self._faults.tell(VehicleUnavailable(robot, reason))
        self.unavailable = reasons

    # ---------------------------------------------------------------- orders

    def _import(self, plan: _Plan) -> Vda5050States:
        """How far vehicles are. Updates what is known of their orders."""
        with self._lock:
            reported = dict(self._states)
        found = self._read_states(plan, reported)
        plan.progress.update({entry["robot"]: entry for entry in found["progress"]})
        self._reports = {report["robot"]: report for report in found["vehicles"]}
        self._imported = reported
        self._tell(found)
        for robot, entry in plan.progress.items():
            if robot in self._orders and "order_id" not in entry:  # it is cancelled, and the vehicle stands, or it is lost
                self._forget(robot)
        return found

    def _read_states(self, plan: _Plan, reported: dict[str, VdaMessage]) -> Vda5050States:
        """What the service reads in the states. States that it refuses are reported as faults. They are left out of
        `reported`, or the previous states replace them."""
        while True:
            robots = list(reported)
            try:
                found = self._client.import_vda5050(plan.request, self._given_plans(plan), list(reported.values()),
                                                    timestamp=plan.timestamp, base=plan.base,
                                                    progress=list(plan.progress.values()), **self._header)
                check_states(plan.request, plan.progress.values(), found)
                return found
            except RequestRefused as error:
                refused = {robots[int(index)]: fault.detail for fault in error.faults
                           for index in re.findall(r"^/messages/(\d{1,9})(?:/|$)", fault.pointer)
                           if int(index) < len(robots)}
                if not refused:
                    raise
            for robot, detail in refused.items():
                self._faults.tell(MessageRejected(robot, detail))
                self._leave_out(robot, reported)

    def _leave_out(self, robot: str, reported: dict[str, VdaMessage]) -> None:
        refused, before = reported.pop(robot), self._imported.get(robot)
        if before is refused:
            before = None
        if before is not None:
            reported[robot] = before
        with self._lock:
            if self._states.get(robot) is refused:
                self._states.pop(robot)
                if before is not None:
                    self._states[robot] = before

    def _forget(self, robot: str) -> None:
        """The robot's order is over."""
        self._orders.pop(robot, None)
        self._cancels.pop(robot, None)

    def _tell(self, found: Vda5050States) -> None:
        """What is wrong with states, and which vehicles are not available."""
        reasons: dict[str, str] = {}
        for report in found["vehicles"]:
            robot = report["robot"]
            for fault in report.get("errors", []):
                self._faults.tell(MessageRejected(robot, fault["detail"]))
            told = report["availability"]["reasons"] if "availability" in report else []
            lasting = [reason["detail"] for reason in told if reason["reason"] in _LASTING]
            if lasting or report["failed"]:
                reasons[robot] = " ".join(lasting) or "It has failed."
        self._set_unavailable(reasons)

    def _cancel_failed(self) -> list[Message]:
        """Vehicles may be unable to go on with an order, may refuse it, or may fail to do one of its actions. They get
        a new order for what is left as soon as they can."""
        return [message for robot in self.failed for message in self.cancel(robot, "it has failed")]

    def _message(self, robot: str, topic: Literal["order", "instantActions"], body: VdaMessage) -> Message:
        message = Message(topic, *self._vehicles[robot], _headless(body))
        self._sent[robot] = self._clock(), message
        return message

    def _lost(self, now: float) -> list[Message]:
        """Messages that vehicles have not taken: they may have been lost, or the vehicle has forgotten them before it has
        told so. They are sent again; a vehicle that has one nevertheless ignores the second."""
        messages = []
        for robot, (since, message) in self._sent.items():
            is_waiting = robot in self._orders and now - since >= _ARRIVES_S
            if is_waiting and not self._has_taken(robot):
                self._sent[robot] = now, message
                messages.append(message)
        return messages

    def _has_taken(self, robot: str) -> bool:
        """Whether it has taken its last message. A vehicle that is not available gets no orders."""
        if robot not in self._cancels:
            report = self._reports.get(robot)
            return report is None or report["accepted"] or robot in self.unavailable
        state = self._imported.get(robot, {})
        actions = [*state.get("actionStates", []), *state.get("instantActionStates", [])]
        return any(action["actionId"] == self._cancels[robot] for action in actions)

    def _end_orders(self, plan: _Plan) -> None:
        """Vehicles that have done everything get new orders with the next plan, so that no order goes on for a whole
        day. A vehicle that still knows a horizon waits for its order to be continued."""
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
            # A vehicle whose order was cancelled gets a new order with the next plan, which begins where it stands.
            return self._published(self._plan, exported, self._orders.keys())
        except FleetplanError as error:
            self.failure = error
        except Exception as error:  # a bug, or an answer that is wrong in an unforeseen way
            self.failure = unforeseen(error)
        self._faults.tell(self.failure)
        return []

    def _export(self, plan: _Plan) -> Vda5050Answer:
        exported = self._client.export_vda5050(plan.request, self._given_plans(plan), timestamp=plan.timestamp,
                                               base=plan.base, progress=list(plan.progress.values()), **self._header)
        check_orders(plan.request, exported)
        return exported

    def _given_plans(self, plan: _Plan) -> Any:
        """What the service needs of the plan."""
        return {**what_is_given(plan.answer), "dependencies": plan.answer.get("dependencies")}

    def _published(self, plan: _Plan, exported: Vda5050Answer, robots: Collection[str]) -> list[Message]:
        messages = []
        for entry in exported["orders"]:
            robot, order = entry["robot"], entry["order"]
            if robot not in robots or robot in plan.tight or robot in self.unavailable:
                continue
            first = entry["nodes"][0]
            known = plan.progress.setdefault(
                robot, {"robot": robot, "action": first["action"], "progress": first["progress"]})
            known["order_id"], known["order_update_id"] = order["orderId"], order["orderUpdateId"]
            known["last_released_sequence_id"] = entry["last_released_sequence_id"]
            self._orders[robot] = self._with_nodes_before(robot, order)
            self.cancelled.pop(robot, None)
            messages.append(self._message(robot, "order", order))
        return messages

    def _with_nodes_before(self, robot: str, order: VdaMessage) -> VdaMessage:
        """An update, with the released nodes of the messages before it that the vehicle has not left, as far as is
        known. The vehicle may still fail to do an action there."""
        before, state = self._orders.get(robot), self._imported.get(robot, {})
        if before is None or before["orderId"] != order["orderId"]:
            return order
        is_known = state.get("orderId") == order["orderId"] and state.get("lastNodeId")
        reached = state.get("lastNodeSequenceId", 0) if is_known else 0
        first = order["nodes"][0]["sequenceId"]
        nodes = [node for node in before["nodes"] if node["released"] and reached <= node["sequenceId"] < first]
        return {**order, "nodes": [*nodes, *order["nodes"]]}

    def _begin_cancel(self, robot: str, action_id: str, reason: str) -> None:
        self._cancels[robot] = action_id
        self.cancelled[robot] = reason
        if self._plan is not None and robot in self._plan.progress:
            self._plan.progress[robot]["cancel_id"] = action_id

    # ---------------------------------------------------------------- rounds

    def _begin_round(self, now: float) -> None:
        self._given, self._goals = self._goals, {}
        try:
            out = dict(self.unavailable)
            make: Callable[[], _Plan] = functools.partial(self._first_plan, out, now)
            if self._plan is not None:
                make = self._next(self._plan, now)
            self._round = self._run(make)
        except FleetplanError as error:
            self._fail(error, is_first=self._plan is None)
        except Exception as error:  # as in _release
            self._fail(unforeseen(error), is_first=self._plan is None)

    def _next(self, plan: _Plan, now: float) -> Callable[[], _Plan]:
        """What makes the plan of this moment."""
        self._import(plan)
        self._end_orders(plan)
        states = self._import(plan)
        out = dict(self.unavailable)
        base: list[OrderBase] = []
        for robot, entry in plan.progress.items():
            if "order_id" in entry:
                order: OrderBase = {"robot": robot, "order": self._orders[robot]}
                if robot in self._imported:
                    order["state"] = self._imported[robot]
                base.append(order)
        goals: list[NewGoals] = [{"robot": robot, "goals": [] if robot in out else given}
                                 for robot, given in self._given.items()]
        # The measured position of a vehicle that cannot go on does not matter as long as the vehicle may still drive
        # what is released.
        bound = {entry["robot"] for entry in base} & (out.keys() | self._cancels.keys())
        measured = [unmeasured(state) if state["robot"] in bound else state for state in states["states"]]
        parts: dict[str, list[Any]] = {"states": measured, "poses": states["poses"], "goals": goals}
        advance = functools.partial(self._client.advance, plan.request, what_is_given(plan.answer), now - plan.begin)
        waiting = {**plan.aside, **{robot: given for robot, given in self._given.items() if robot in out}}
        return functools.partial(self._next_plan, plan, advance, parts, base, out, waiting, now)

    def _first_plan(self, out: Collection[str], now: float) -> _Plan:
        return self._planned(self._first_request(), [], out, {}, now)

    def _next_plan(self, plan: _Plan, advance: Callable[..., AdvanceAnswer], parts: dict[str, list[Any]],
                   base: Sequence[OrderBase], out: Collection[str], waiting: Mapping[str, list[Goal]],
                   now: float) -> _Plan:
        request = self._advanced(advance, plan.request, parts)
        start_where_measured(request, [*parts["states"], *parts["poses"]], {entry["robot"] for entry in base})
        return self._planned(self._changed(request), base, out, waiting, now)

    def _planned(self, request: PlanRequest, base: Sequence[OrderBase], out: Collection[str],
                 waiting: Mapping[str, list[Goal]], now: float) -> _Plan:
        aside = put_aside(request, out, waiting, self._idle)
        serve_once(request, out)
        answer = self._make_plan(request)
        tight = frozenset(robot for pair in answer.get("tight") or [] for robot in pair["robots"])
        return _Plan(request, answer, now, _timestamp(), base, {}, tight, aside)

    def _take_plan(self) -> list[Message]:
        """Goes on with the next plan if it is ready, and if all orders can be continued by it."""
        if self._round is None or not self._round.done():
            return []
        future, self._round = self._round, None
        try:
            plan = future.result()
            plan.progress = {entry["robot"]: self._progress_of(entry) for entry in plan.base}
            exported = self._export(plan)
            if exported["cancel_orders"]:
                return self._cancel_all(exported)
            self.failure, self._given, self._plan, self.request = None, {}, plan, plan.request
            for report in self._reports.values():
                report["arrived"] = False  # that was in the plan before
            self.rounds += 1
            return self._published(plan, exported, self._vehicles.keys())
        except FleetplanError as error:
            self._fail(error, is_first=self._plan is None)
        except Exception as error:  # as in _release
            self._fail(unforeseen(error), is_first=self._plan is None)
        return []

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
        """No vehicle goes on by a plan that some vehicles cannot follow: they stand before the next plan is made."""
        messages = []
        for entry in exported["cancel_orders"]:
            robot, message = entry["robot"], entry["instant_actions"]
            if robot not in self._cancels:
                self._begin_cancel(robot, message["actions"][0]["actionId"], entry["detail"])
                messages.append(self._message(robot, "instantActions", message))
        self._goals = {**self._given, **self._goals}
        self._given = {}
        return messages


def _timestamp() -> str:
    return datetime.datetime.now(datetime.UTC).isoformat(timespec="milliseconds").replace("+00:00", "Z")


def _headless(message: VdaMessage) -> VdaMessage:
    """Without the members that the sender fills in."""
    return {name: value for name, value in message.items()
            if name not in _HEADER}
