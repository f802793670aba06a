"""Vehicles that speak VDA 5050 and behave like vehicles in the field. They refuse orders, fail actions, restart, are
pushed by hand, lose their place, and send messages that nobody can read."""

import json
import math
import random

STEP_S = 0.2
ON_NODE_M = 0.02


class Vehicle:
    """Takes orders as the standard says, drives what is released, and reports.

    `missions` counts how often each mission was served; a mission is a parameter of the action at a goal."""

    def __init__(self, name, manufacturer, robot, version, seed):
        self.name, self.manufacturer, self.version = name, manufacturer, version
        self.random = random.Random(f"{seed} {name}")
        self.radius, self.speed = robot["radius"], robot["linear_speed"]
        start = robot["start"]
        self.pose = {"x": start["x"], "y": start["y"], "theta": start.get("theta", 0.0)}
        self.missions, self.inbox, self.legs = {}, [], []
        self.refused = []  # orders, and why
        self.errors, self.mode, self.stop, self.paused, self.lost, self.map = [], "AUTOMATIC", "NONE", False, False, "hall"
        self.refuses_next = self.fails_next = False
        self.header, self.finished_at, self.push = 0, -math.inf, None
        self.forget()

    # ---------------------------------------------------------------- what happens to it

    def forget(self):
        """It restarts: it knows no order."""
        self.order_id, self.update_id, self.last, self.last_id = "", 0, 0, ""
        self.actions, self.errors = {}, []
        self.drop()

    def drop(self):
        """It has nothing to do any more."""
        for name, status in self.actions.items():
            if status in ("WAITING", "RUNNING"):
                self.actions[name] = "FAILED"
        self.base, self.horizon, self.busy, self.base_end, self.blocked = [], [], [], None, False

    @property
    def is_driven_by_hand(self):
        return self.mode != "AUTOMATIC"

    @property
    def can_move(self):
        return not (self.is_driven_by_hand or self.paused or self.lost or self.blocked or self.stop != "NONE"
                    or any(error["errorLevel"] in ("FATAL", "CRITICAL") for error in self.errors))

    def stretch(self):
        """Where it may drive."""
        places = [self.pose, *(node["nodePosition"] for node in self.base)]
        return [(place["x"], place["y"]) for place in places]

    # ---------------------------------------------------------------- orders

    def read(self):
        """Takes the messages that have come since the last report."""
        messages, self.inbox = self.inbox, []
        for message in messages:
            if message.topic == "instantActions":
                action = message.body["actions"][0]
                if action["blockingType"] == "NONE":  # 3.0.0 has no other; others wait for what they are to end
                    self._cancel(action["actionId"])
            else:
                self._take(message.body)

    def _cancel(self, action_id):
        has_order = bool(self.base or self.horizon or self.busy or self.blocked)
        self.drop()
        self.errors = [error for error in self.errors if error["errorLevel"] != "WARNING"]
        self.actions[action_id] = "FINISHED" if has_order else "FAILED"
        if not has_order:
            self._warn("noOrderToCancel" if self.version < "3" else "NO_ORDER_TO_CANCEL", {"actionId": action_id})

    def _take(self, order):
        first = order["nodes"][0]
        is_update = order["orderId"] == self.order_id and self.base_end is not None
        why = self._why_refused(order, first, is_update)
        if why is not None:
            self.refused.append((why, order))
            references = {"orderId": order["orderId"], "orderUpdateId": str(order["orderUpdateId"])}
            if self.version >= "3" or self.random.random() < 0.5:
                references = {"orderId": order["orderId"]}
            self._warn("orderUpdateError" if is_update else "orderError", references)
            return
        self.errors = [error for error in self.errors if error["errorLevel"] != "WARNING"]
        base = [node for node in order["nodes"] if node["released"]]
        if not is_update:
            self.order_id, self.last, self.last_id, self.actions = order["orderId"], first["sequenceId"], first["nodeId"], {}
            self._begin(first)
        self.update_id = order["orderUpdateId"]
        self.base += base[1:]
        self.base_end = base[-1]
        self.horizon = [node for node in order["nodes"] if not node["released"]]
        for node in base[1:]:
            for action in node["actions"]:
                self.actions[action["actionId"]] = "WAITING"

    def _why_refused(self, order, first, is_update):
        if self.refuses_next:
            self.refuses_next = False
            return "told to"
        if self.is_driven_by_hand:
            return "driven by hand"
        if is_update:
            end = self.base_end
            same = (first["nodeId"], first["sequenceId"]) == (end["nodeId"], end["sequenceId"])
            return None if same and order["orderUpdateId"] > self.update_id else "update does not fit"
        if self.base or self.horizon or self.busy or self.blocked:
            return "busy"
        position = first["nodePosition"]
        away = math.hypot(position["x"] - self.pose["x"], position["y"] - self.pose["y"])
        return None if away <= ON_NODE_M else f"begins {away:.3f} m away"

    def _warn(self, kind, references):
        level = "WARNING"
        self.errors = [*self.errors, {"errorType": kind, "errorLevel": level, "errorReferences": [
            {"referenceKey": key, "referenceValue": value} for key, value in references.items()]}]

    def _begin(self, node):
        for action in node["actions"]:
            parameters = {entry["key"]: entry["value"] for entry in action.get("actionParameters", [])}
            self.busy.append([action["actionId"], parameters.get("duration", 2.0), parameters.get("mission")])
            self.actions[action["actionId"]] = "RUNNING"

    # ---------------------------------------------------------------- motion

    def drive(self, now):
        end = now + STEP_S
        begin = self.pose
        if self.push is not None:
            x, y, steps = self.push
            share = 1.0 / steps
            self.pose = {"x": begin["x"] + share * (x - begin["x"]), "y": begin["y"] + share * (y - begin["y"]),
                         "theta": begin["theta"]}
            self.push = (x, y, steps - 1) if steps > 1 else None
            self.legs.append((now, end, begin, self.pose))
            return
        while now < end and self.can_move:
            if self.busy:
                now += self._work(end, now)
            elif self.base:
                now += self._go(now, end - now)
            else:
                break

    def _work(self, end, now):
        action = self.busy[0]
        step = min(action[1], end - now)
        action[1] -= step
        if action[1] <= 1e-9:
            self.busy.pop(0)
            if self.fails_next and action[2] is not None:
                self.fails_next, self.blocked = False, True
                self.actions[action[0]] = "FAILED"
                self._warn("pickFailed", {"actionId": action[0]})
            else:
                self.actions[action[0]] = "FINISHED"
                self.finished_at = now + step
                if action[2] is not None:
                    self.missions[action[2]] = self.missions.get(action[2], 0) + 1
        return max(step, 1e-9)

    def _go(self, now, seconds):
        target = self.base[0]["nodePosition"]
        x, y = target["x"] - self.pose["x"], target["y"] - self.pose["y"]
        length, speed = math.hypot(x, y), self.speed * self.random.uniform(0.5, 1.0)
        arrives = length <= speed * seconds
        time = length / speed if arrives else seconds
        begin, share = self.pose, 1.0 if arrives else speed * time / length
        theta = target.get("theta", begin["theta"]) if arrives else math.atan2(y, x)
        self.pose = {"x": begin["x"] + share * x, "y": begin["y"] + share * y, "theta": theta}
        if arrives:
            self.pose = {**self.pose, "x": target["x"], "y": target["y"]}
            node = self.base.pop(0)
            self.last, self.last_id = node["sequenceId"], node["nodeId"]
            self._begin(node)
        self.legs.append((now, now + time, begin, self.pose))
        return max(time, 1e-9)

    # ---------------------------------------------------------------- reports

    def state(self):
        self.header += 1
        pose = self.pose if not self.lost else {"x": self.pose["x"] + 3.0, "y": -1e3, "theta": 1.0}
        position = {**pose, "mapId": self.map}
        known = "positionInitialized" if self.version < "3" else "localized"
        position[known] = not self.lost
        nodes = [*self.base, *self.horizon]
        return {
            "headerId": self.header, "timestamp": "2026-01-31T12:00:00.000Z", "version": self.version,
            "manufacturer": self.manufacturer, "serialNumber": self.name, "orderId": self.order_id,
            "orderUpdateId": self.update_id, "lastNodeId": self.last_id, "lastNodeSequenceId": self.last,
            "driving": bool(self.base) and self.can_move and not self.busy, "paused": self.paused,
            "operatingMode": self.mode,
            ("agvPosition" if self.version < "3" else "mobileRobotPosition"): position,
            "nodeStates": [{"nodeId": node["nodeId"], "sequenceId": node["sequenceId"], "released": node["released"]}
                           for node in nodes],
            "edgeStates": [{"edgeId": node["nodeId"], "sequenceId": node["sequenceId"] - 1, "released": node["released"]}
                           for node in nodes],
            "actionStates": [{"actionId": name, "actionStatus": status} for name, status in self.actions.items()],
            "errors": self.errors, "loads": None, "velocity": None,
            "safetyState": {("eStop" if self.version < "3" else "activeEmergencyStop"): self.stop, "fieldViolation": False}}


def rubbish(dice, vehicle, others):
    """The bytes of a message that no vehicle should send on its topic."""
    state = vehicle.state()
    position = "agvPosition" if "agvPosition" in state else "mobileRobotPosition"
    kind = dice.randrange(12)
    if kind == 0:
        state[position] = {"x": math.nan, "y": math.inf, "theta": math.nan}
    elif kind == 1:
        return b"[" * 100000
    elif kind == 2:
        return b"\xff\xfe\x00 no text"
    elif kind == 3:  # of another vehicle, which is said to have done all
        other = dice.choice(others)
        state = {**other.state(), "lastNodeSequenceId": 10 ** 6, "nodeStates": [], "actionStates": []}
    elif kind == 4:
        state["manufacturer"] = "another"
    elif kind == 5:
        del state[dice.choice(["orderId", "orderUpdateId"])]
    elif kind == 6:
        state[dice.choice(["orderUpdateId", "lastNodeSequenceId"])] = dice.choice([-1, 10 ** 400, "7", [], 1.5, True])
    elif kind == 7:
        state[dice.choice(["nodeStates", "actionStates", "errors"])] = dice.choice([{}, "x", [None], [{"actionId": 7}]])
    elif kind == 8:
        state[position] = {"x": 1e300, "y": 0.0, "theta": 0.0}
    elif kind == 9:
        state["orderId"] = "\ud800"
    elif kind == 10:
        return json.dumps([state]).encode()
    else:
        state["errors"] = [{"errorType": "x", "errorLevel": dice.choice([7, None, {}])}]
    return json.dumps(state).encode()
