"""Drives the vehicles of live_test.js: the loop of the Python client, over MQTT. Prints a line when it begins,
and what has happened, as JSON.

Time passes `lapse` times as fast. After half of the time, the order of the robot `cancel` is cancelled.
"""

import argparse
import json
import pathlib
import sys
import time

PROJECT = pathlib.Path(__file__).resolve().parent.parent.parent.parent
sys.path.insert(0, str(PROJECT / "clients/python"))

from fleetplan import Client  # noqa: E402
from fleetplan.mqtt import MqttTransport  # noqa: E402
from fleetplan.vda5050 import VdaLoop  # noqa: E402


def trips_of(request):
    """To the start, where something is picked up, and back to the goal."""
    pick = {"type": "noop", "blocking_type": "HARD", "parameters": {"duration": 3}}
    return {robot["id"]: [{**robot["start"], "service": 3.0, "actions": [pick]}, {**robot["goal"], "service": 2.0}]
            for robot in request["robots"]}


class Day:
    def __init__(self, arguments, loop, transport, request):
        self.arguments, self.loop, self.transport = arguments, loop, transport
        self.trips = trips_of(request)
        self.out, self.arrived, self.failures, self.cancelled = [], 0, [], {}
        self.messages = {"order": 0, "instantActions": 0}

    def run(self):
        begin, has_cancelled = time.monotonic(), False
        print("begun", flush=True)
        while (passed := (time.monotonic() - begin) * self.arguments.lapse) < self.arguments.seconds:
            self.send(self.loop.step())
            if self.loop.failure is not None and str(self.loop.failure) not in self.failures:
                self.failures.append(str(self.loop.failure))
            for robot in set(self.loop.failed) - set(self.out):
                self.out.append(robot)
                self.loop.give(robot, [])
                self.send(self.loop.cancel(robot, "it has failed"))
            for robot in set(self.loop.idle) - set(self.out):
                self.arrived += 1
                self.loop.give(robot, self.trips[robot])
            if passed > 0.5 * self.arguments.seconds and not has_cancelled:
                messages = self.loop.cancel(self.arguments.cancel, "by the test")
                has_cancelled = bool(messages)  # otherwise it has no order now
                self.send(messages)
            self.cancelled |= self.loop.cancelled
            time.sleep(self.arguments.pause)
        return {"rounds": self.loop.rounds, "arrived": self.arrived, "failed": self.out, "failures": self.failures,
                "cancelled": self.cancelled, "messages": self.messages}

    def send(self, messages):
        for message in messages:
            self.messages[message.topic] += 1
        self.transport.send(messages)


def main():
    parser = argparse.ArgumentParser()
    for name in ("service", "interface", "manufacturer", "map", "cancel"):
        parser.add_argument(f"--{name}", required=True)
    for name in ("port", "robots"):
        parser.add_argument(f"--{name}", type=int, required=True)
    for name in ("lapse", "seconds", "ahead", "period", "pause"):
        parser.add_argument(f"--{name}", type=float, required=True)
    arguments = parser.parse_args()
    request = json.loads((PROJECT / "tests/scenarios/warehouse.json").read_text())
    request["robots"] = request["robots"][:arguments.robots]
    loop = VdaLoop(Client(arguments.service), request, manufacturer=arguments.manufacturer, map_id=arguments.map,
                   release_ahead=arguments.ahead, period=arguments.period,
                   clock=lambda: time.monotonic() * arguments.lapse)
    with loop, MqttTransport(loop.take, manufacturer=arguments.manufacturer, version="2.0.0", host="127.0.0.1",
                             port=arguments.port, interface=arguments.interface) as transport:
        print(json.dumps(Day(arguments, loop, transport, request).run()))


if __name__ == "__main__":
    main()
