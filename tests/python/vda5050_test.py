"""Vehicles that speak VDA 5050. Plans in motion continue their orders, no order is refused, and no vehicle is met."""

import json
import math
import random
import unittest

from support import PROJECT, met, service

from fleetplan import Client
from fleetplan.simulation import Leg
from fleetplan.vda5050 import VdaLoop


class Vehicle:
    """Takes orders as the standard says, drives what is released at random speeds, and reports."""

    def __init__(self, name, address, start, speed, dice):
        self.name, self.address, self.speed, self.dice = name, address, speed, dice
        self.pose = {"x": start["x"], "y": start["y"], "theta": start.get("theta", 0.0)}
        self.order_id, self.update_id, self.last = "", 0, 0
        self.nodes, self.actions, self.errors = [], {}, []  # nodes that are still to come, in the base
        self.base_end = None
        self.busy = []  # actions of the node where it stands: [id, seconds left]
        self.stuck = self.fails_next = False
        self.mode = "AUTOMATIC"
        self.refused, self.legs, self.served, self.topics = [], [], 0, []

    def take(self, message):
        self.topics.append(message.topic)
        if message.topic == "instantActions":
            for action in message.body["actions"]:
                self.nodes, self.busy, self.stuck = [], [], False
                self.base_end = None
                self.actions[action["actionId"]] = "FINISHED"
            return
        order = message.body
        first = order["nodes"][0]
        if order["orderId"] == self.order_id and self.base_end is not None:
            end = self.base_end
            same = (first["nodeId"], first["sequenceId"]) == (end["nodeId"], end["sequenceId"])
            if order["orderUpdateId"] <= self.update_id or not same:
                self.refused.append((order, end))
                return
            assert first == end, "the contents of the stitching node have changed"
        else:
            near = math.hypot(first["nodePosition"]["x"] - self.pose["x"], first["nodePosition"]["y"] - self.pose["y"])
            if self.nodes or self.busy or near > 1e-6:
                self.refused.append((order, self.pose))
                return
            self.order_id, self.last, self.actions, self.errors = order["orderId"], first["sequenceId"], {}, []
            self._begin_actions(first)
        self.update_id = order["orderUpdateId"]
        base = [node for node in order["nodes"] if node["released"]]
        self.nodes += base[1:]
        self.base_end = base[-1]
        for node in base[1:]:
            for action in node["actions"]:
                self.actions[action["actionId"]] = "WAITING"

    def drive(self, now, seconds):
        end = now + seconds
        while now < end and not self.stuck:
            if self.busy:
                step = min(self.busy[0][1], end - now)
                self.busy[0][1] -= step
                now += step
                if self.busy[0][1] <= 1e-9 and self.fails_next:
                    self.actions[self.busy.pop(0)[0]] = "FAILED"
                    self.fails_next, self.stuck = False, True
                elif self.busy[0][1] <= 1e-9:
                    self.actions[self.busy.pop(0)[0]] = "FINISHED"
                    self.served += 1
            elif self.nodes:
                now += self._go(now, end - now)
            else:
                break

    def state(self):
        manufacturer, serial_number = self.address
        return {"headerId": 0, "manufacturer": manufacturer, "serialNumber": serial_number, "orderId": self.order_id, "orderUpdateId": self.update_id,
                "lastNodeId": f"node-{self.last}", "lastNodeSequenceId": self.last, "driving": bool(self.nodes), "operatingMode": self.mode,
                "agvPosition": {**self.pose, "mapId": "hall", "positionInitialized": True}, "errors": self.errors,
                "actionStates": [{"actionId": name, "actionStatus": status} for name, status in self.actions.items()]}

    def _go(self, now, seconds):
        target = self.nodes[0]["nodePosition"]
        x, y = target["x"] - self.pose["x"], target["y"] - self.pose["y"]
        length, speed = math.hypot(x, y), self.speed * self.dice.uniform(0.5, 1.0)
        time = min(seconds, length / speed)
        begin, share = self.pose, 1.0 if length <= speed * seconds else speed * time / length
        theta = target.get("theta", begin["theta"]) if share == 1.0 else math.atan2(y, x)
        self.pose = {"x": begin["x"] + share * x, "y": begin["y"] + share * y, "theta": theta}
        if share == 1.0:
            self.pose = {**self.pose, "x": target["x"], "y": target["y"]}
            node = self.nodes.pop(0)
            self.last = node["sequenceId"]
            self._begin_actions(node)
        self.legs.append(Leg(now, now + time, begin, self.pose))
        return time

    def _begin_actions(self, node):
        for action in node["actions"]:
            parameters = {entry["key"]: entry["value"] for entry in action["actionParameters"]}
            self.busy.append([action["actionId"], parameters.get("duration", 1.0)])
            self.actions[action["actionId"]] = "RUNNING"


class Fleet:
    """What `met` needs of a fleet."""

    def __init__(self, legs):
        self.legs = legs


class Day:
    """Vehicles of two makes, with the same serial numbers, that go to and fro between their start, where they are served,
    and their goal."""

    def __init__(self, client, robots, seed=0, **how):
        self.request = json.loads((PROJECT / "tests/scenarios/warehouse.json").read_text())
        self.request["robots"] = self.request["robots"][:robots]
        self.request["options"] = {"time_budget_ms": 20000}  # a busy machine changes nothing
        self.now = 0.0
        self.vehicles = {robot["id"]: Vehicle(robot["id"], (("acme", "bolt")[k % 2], str(k // 2)), robot["start"],
                                              robot["linear_speed"], random.Random(f"{seed} {robot['id']}"))
                         for k, robot in enumerate(self.request["robots"])}
        self.of_address = {vehicle.address: vehicle for vehicle in self.vehicles.values()}
        self.loop = VdaLoop(client, self.request, manufacturer="acme", clock=lambda: self.now, background=False,
                            manufacturers={name: "bolt" for name, vehicle in self.vehicles.items()
                                           if vehicle.address[0] == "bolt"},
                            serial_numbers={name: vehicle.address[1] for name, vehicle in self.vehicles.items()},
                            map_id="hall", **how)
        self.trips = {robot["id"]: [{**robot["start"], "service": 2.0}, robot["goal"]] for robot in self.request["robots"]}
        self.arrived, self.failures, self.orders, self.out = [], [], 0, set()

    def send(self, messages):
        for message in messages:
            self.orders += message.topic == "order"
            self.of_address[message.manufacturer, message.serial_number].take(message)

    def run(self, seconds):
        end = self.now + seconds
        while self.now < end:
            for vehicle in self.vehicles.values():
                self.loop.take(vehicle.state())
            self.send(self.loop.step())
            if self.loop.failure is not None:
                self.failures.append(self.loop.failure)
            for robot in self.loop.failed:
                if robot not in self.out:
                    self.out.add(robot)
                    self.loop.give(robot, [])
                    self.send(self.loop.cancel(robot, "it has failed"))
            for robot in self.loop.idle:
                if robot not in self.out:
                    self.arrived.append(robot)
                    self.loop.give(robot, self.trips[robot])
            for vehicle in self.vehicles.values():
                vehicle.drive(self.now, 0.2)
            self.now += 0.2
        return self

    @property
    def refused(self):
        return [(name, *entry) for name, vehicle in self.vehicles.items() for entry in vehicle.refused]

    @property
    def met(self):
        return met(self.request, Fleet({name: vehicle.legs for name, vehicle in self.vehicles.items()}))


class Loop(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.context = service()
        cls.client = Client(cls.context.__enter__())

    @classmethod
    def tearDownClass(cls):
        cls.client.close()
        cls.context.__exit__(None, None, None)

    def test_orders_are_continued_while_vehicles_drive(self):
        day = Day(self.client, 8).run(60.0)
        self.assertEqual(day.refused, [])
        self.assertEqual(day.failures, [])
        self.assertEqual(day.loop.cancelled, {})
        self.assertGreater(day.loop.rounds, 25)
        self.assertGreater(day.orders, 100)
        self.assertGreater(len(day.arrived), 8)
        self.assertEqual(day.met, ([], []))

    def test_others_go_on_when_one_fails_and_one_is_cancelled(self):
        day = Day(self.client, 8, seed=1).run(10.0)
        broken, stopped, *_ = day.vehicles.values()
        broken.stuck = True
        broken.errors = [{"errorType": "motorError", "errorLevel": "FATAL"}]
        day.send(day.loop.cancel(stopped.name))
        before, served = len(day.arrived), stopped.served
        day.run(50.0)
        self.assertEqual(day.refused, [])
        self.assertEqual(day.failures, [])
        self.assertEqual(day.loop.failed, [broken.name])
        self.assertEqual(list(day.loop.cancelled), [broken.name])
        self.assertGreater(len(day.arrived), before + 4)
        self.assertGreater(stopped.served, served, "it has got another order")
        self.assertEqual(day.met, ([], []))

    def test_one_that_is_taken_over_gets_no_orders_until_it_is_back(self):
        day = Day(self.client, 4, seed=3).run(10.0)
        vehicle, *others = day.vehicles.values()
        for mode in ("INTERVENED", "STARTUP", "SERVICE"):
            with self.subTest(mode):
                vehicle.mode, vehicle.stuck, vehicle.topics = mode, True, []
                before = day.orders
                day.run(15.0)
                self.assertEqual(vehicle.topics, [])
                self.assertGreater(day.orders, before, "others go on")
                vehicle.mode, vehicle.stuck = "AUTOMATIC", False
                day.run(15.0)
                self.assertIn("order", vehicle.topics)
        self.assertEqual((day.refused, day.met), ([], ([], [])))

    def test_an_action_that_fails_is_cancelled_and_done_again(self):
        day = Day(self.client, 4, seed=4)
        vehicle, *_ = day.vehicles.values()
        vehicle.fails_next = True
        while vehicle.fails_next:
            day.run(0.2)
        self.assertTrue(vehicle.served == 0 and vehicle.stuck)
        vehicle.topics = []
        day.out = set(day.vehicles)  # nobody gets other goals
        day.run(2.0)
        self.assertEqual(vehicle.topics[:1], ["instantActions"])
        day.run(60.0)
        self.assertEqual((vehicle.served, day.failures, day.met), (1, [], ([], [])))

    def test_messages_that_are_lost_are_sent_again(self):
        day = Day(self.client, 4, seed=2)
        name, vehicle = next(iter(day.vehicles.items()))
        take, vehicle.take = vehicle.take, lambda message: None
        day.run(1.0)
        vehicle.take = take
        day.run(30.0)
        self.assertNotEqual(vehicle.order_id, "")
        self.assertTrue(day.loop.cancel(name), "it has an order")  # and the message is lost
        order = vehicle.order_id
        day.run(20.0)
        self.assertNotEqual(vehicle.order_id, order)
        self.assertEqual((day.refused, day.met), ([], ([], [])))


if __name__ == "__main__":
    unittest.main()
