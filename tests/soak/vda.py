#!/usr/bin/env python3
"""Runs the loop for vehicles of VDA 5050 (clients/python). Vehicles refuse orders, fail actions, restart, are stopped
and pushed by hand, lose their place, and send messages that nobody can read. Answers of the server are now and then
lost or wrong. The vehicles' time is simulated.

Usage: vda.py [--binary FLEETPLAN | --url URL] [--minutes N | --seconds N] [--robots N] [--version 2.1.0 | 3.0.0]
              [--seed N]

--minutes are minutes of this machine. --seconds are seconds of the vehicles, for each version: the same on every
machine.

Prints what it did, with a digest. Two runs in which the same happened have the same digest. The exit status is 0 only
if

- each mission was served exactly once in the end,
- the ways that are released to vehicles never came too near to each other,
- only a vehicle that was pushed met another vehicle,
- no vehicle stood for long without a reason,
- and only FleetplanError was raised.
"""

import argparse
import collections
import copy
import hashlib
import itertools
import json
import logging
import math
import pathlib
import random
import sys
import time
import traceback

PROJECT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path[:0] = [str(PROJECT / "clients/python"), str(PROJECT / "tests/motion")]

from fleetplan import Client, ConnectionFailed, FleetplanError  # noqa: E402
from fleetplan.errors import InvalidValue  # noqa: E402
from fleetplan.vda5050 import VdaLoop  # noqa: E402
from fleetplan.vehicle_states import state_on  # noqa: E402
from geometry import closest_of_paths  # noqa: E402
from replay import Walls  # noqa: E402
from report import verdict  # noqa: E402
from server import Server  # noqa: E402
from vehicles import ON_NODE_M, STEP_S, Vehicle, rubbish  # noqa: E402

CONTACT_M = 1e-4  # rounding of what is driven
RELEASED_M = 1e-3  # the same, of ways that are released
EVERY_S = 60.0  # a vehicle is disturbed again, on average
SETTLES_S = 30.0  # after it was disturbed
LONGEST_STAND_S = 240.0  # without a reason
LAST_S = 900.0  # in which all is served in the end
ANSWERS_LOST = 0.002  # the share
SPOILED = [None, "x", math.nan, 1e300, [], {}, True]
PUSHED_M = 1.5
TURN_MIN = 10.0  # with the same fleet
MAX_FAILURES = 20
MAKE = "acme"


class Flaky:
    """A client whose answers are sometimes lost, or none of the service."""

    def __init__(self, client, dice, counts, clock):
        self.client, self.dice, self.counts, self.clock, self.is_quiet = client, dice, counts, clock, False
        self.last = "none"  # that was lost or wrong

    def __getattr__(self, name):
        method = getattr(self.client, name)

        def called(*arguments, **members):
            answer = method(*arguments, **members)
            if self.is_quiet or self.dice.random() >= ANSWERS_LOST:
                return answer
            self.counts["answers lost or wrong"] += 1
            self.last = f"{name} at {self.clock():.1f} s"
            if self.dice.random() < 0.3:
                raise ConnectionFailed("lost")
            wrong, where = spoiled(answer, self.dice)
            self.last += f", {where}"
            return wrong
        return called


def spoiled(answer, dice):
    """The answer with one value of another type, so that it is not an answer of the service, and the place of the
    value. (With the same type, it could be one: it is impossible to tell that a plan without dependencies had some.)"""
    whole, where = copy.deepcopy(answer), ""
    at, depth = whole, dice.randrange(4)
    while True:
        names = list(at) if isinstance(at, dict) else list(range(len(at)))
        if not names:
            return {}, "all"
        name = dice.choice(names)
        where += f"/{name}"
        if depth > 0 and isinstance(at[name], dict | list):
            at, depth = at[name], depth - 1
            continue
        at[name] = dice.choice([value for value in SPOILED if type(value) is not type(at[name])])
        return whole, f"{where} = {at[name]!r}"


class Soak:
    def __init__(self, client, robots, version, seed):
        self.dice, self.counts = random.Random(seed), collections.Counter()
        self.request = json.loads((PROJECT / "tests/scenarios/warehouse.json").read_text())
        self.request["robots"] = self.request["robots"][:robots]
        self.request["options"] = {"time_budget_ms": 20000}  # a busy machine changes nothing
        self.walls = Walls(self.request["map"])
        self.vehicles = {robot["id"]: Vehicle(robot["id"], MAKE, robot, version, seed) for robot in self.request["robots"]}
        self.now, self.numbers, self.failures = 0.0, itertools.count(), []
        self.given = {name: [] for name in self.vehicles}
        self.undo = {}  # by vehicle: when and how its disturbance ends
        self.displaced = set()  # vehicles that were pushed, until they have another order
        self.fine_since = dict.fromkeys(self.vehicles, 0.0)
        self.longest_stand, self.told = 0.0, collections.Counter()
        self.digest = hashlib.sha256()
        self.client = Flaky(client, self.dice, self.counts, lambda: self.now)
        self.loop = VdaLoop(self.client, self.request, manufacturer=MAKE, version=version, map_id="hall",
                            clock=lambda: self.now, background=False,
                            on_fault=lambda fault: self.told.update([type(fault).__name__]))
        self.topic = f"uagv/v{version[0]}/{MAKE}/%s/state"

    # ---------------------------------------------------------------- a step

    def step(self, disturbs):
        for vehicle in self.vehicles.values():
            self.report(vehicle, json.dumps(vehicle.state()).encode())
            before = vehicle.order_id
            vehicle.read()
            if vehicle.order_id not in ("", before):
                self.displaced.discard(vehicle.name)
        self.undo_disturbances()
        if disturbs:
            self.disturb()
        try:
            messages = self.loop.step()
        except FleetplanError as error:
            self.fail(f"the loop has raised {error}")
            messages = []
        self.send(messages)
        self.give_missions(disturbs)
        for vehicle in self.vehicles.values():
            vehicle.legs = []
            vehicle.drive(self.now)
            self.digest.update(repr((vehicle.pose, vehicle.last, vehicle.update_id, vehicle.missions)).encode())
        self.check_motion()
        self.now += STEP_S

    def send(self, messages):
        for message in messages:
            self.counts["orders" if message.topic == "order" else "orders cancelled"] += 1
            self.vehicles[message.serial_number].inbox.append(message)
            self.check_released(message)

    def report(self, vehicle, payload):
        try:
            self.loop.take(state_on(self.topic % vehicle.name, payload))
        except InvalidValue:
            self.counts["messages rejected by their topic"] += 1

    def give_missions(self, more):
        for name in self.loop.idle:
            vehicle = self.vehicles[name]
            lost = [mission for mission in self.given[name] if mission not in vehicle.missions]
            if lost:
                self.fail(f"{name} has served all, says the loop, but not {lost}")
                self.given[name] = [mission for mission in self.given[name] if mission not in lost]
            if more:
                robot = next(robot for robot in self.request["robots"] if robot["id"] == name)
                goals = []
                for place in (robot["start"], robot["goal"]):
                    mission = f"{name}-{next(self.numbers)}"
                    self.given[name].append(mission)
                    goals.append({**place, "service": 2.0, "actions": [{"type": "pick", "parameters": {"mission": mission}}]})
                self.loop.give(name, goals)

    def fail(self, what):
        self.failures.append(f"{self.now:.1f} s: {what} (the last answer that was lost or wrong: {self.client.last})")

    # ---------------------------------------------------------------- disturbances

    def undo_disturbances(self):
        for name, (end, undo) in list(self.undo.items()):
            if self.now >= end:
                del self.undo[name]
                undo()

    def disturb(self):
        for vehicle in self.vehicles.values():
            if vehicle.name in self.undo or self.now < 5.0:
                self.fine_since[vehicle.name] = self.now + SETTLES_S
            elif self.dice.random() < STEP_S / EVERY_S:
                self.fine_since[vehicle.name] = self.now + SETTLES_S
                kind = self.dice.choice([self.rubbish, self.rubbish, self.refuse, self.fail_action, self.restart, self.push,
                                         self.push, self.cancel, self.stop, self.pause, self.lose_place,
                                         self.change_map, self.break_down])
                kind(vehicle)

    def end_disturbances(self):
        for _, undo in self.undo.values():
            undo()
        self.undo = {}
        self.client.is_quiet = True
        for vehicle in self.vehicles.values():
            vehicle.refuses_next = vehicle.fails_next = False

    def until(self, vehicle, what, undo):
        self.counts[what] += 1
        self.undo[vehicle.name] = self.now + self.dice.uniform(3.0, 20.0), undo

    def rubbish(self, vehicle):
        self.counts["rubbish"] += 1
        others = [other for other in self.vehicles.values() if other is not vehicle]
        for _ in range(self.dice.randrange(1, 10)):
            self.report(vehicle, rubbish(self.dice, vehicle, others))

    def refuse(self, vehicle):
        self.counts["refusals"] += 1
        vehicle.refuses_next = True

    def fail_action(self, vehicle):
        self.counts["actions to fail"] += 1
        vehicle.fails_next = True

    def cancel(self, vehicle):
        """Somebody cancels the order."""
        self.send(self.loop.cancel(vehicle.name, "somebody wants it"))

    def has_told_all(self, vehicle):
        """Events that a vehicle does not tell before it restarts stay unknown."""
        return self.now - vehicle.finished_at > 1.0

    def restart(self, vehicle):
        if self.has_told_all(vehicle):
            self.counts["restarts"] += 1
            vehicle.forget()

    def take_over(self, vehicle):
        self.until(vehicle, "driven by hand", lambda: setattr(vehicle, "mode", "AUTOMATIC"))
        vehicle.mode = "MANUAL"
        vehicle.drop()

    def push(self, vehicle):
        self.take_over(vehicle)
        if self.dice.random() < 0.3 and self.has_told_all(vehicle):
            vehicle.forget()
        self.move_by_hand(vehicle, self.dice.uniform(0.1, PUSHED_M), [])

    def part(self, vehicle, other):
        """Two vehicles that have met stand there until one of them is moved by hand."""
        if not (vehicle.legs or other.legs or vehicle.name in self.undo):
            self.take_over(vehicle)
            self.move_by_hand(vehicle, self.dice.uniform(0.5, PUSHED_M), [other])

    def move_by_hand(self, vehicle, far, met):
        angle = self.dice.uniform(-math.pi, math.pi)
        x, y = vehicle.pose["x"] + far * math.cos(angle), vehicle.pose["y"] + far * math.sin(angle)
        if self.is_free(vehicle, x, y, met):
            self.counts["pushed"] += 1
            self.displaced.add(vehicle.name)
            vehicle.push = x, y, 12

    def is_free(self, vehicle, x, y, met):
        """Whether no vehicle is in the way, or will be by what is released now. Vehicles that it has met count at its
        end.
        """
        way = [(vehicle.pose["x"], vehicle.pose["y"]), (x, y)]
        return self.walls.clearance(*way[0], *way[1], vehicle.radius) >= vehicle.radius and all(
            apart([(x, y)] if other in met else way, released_to(other)) >= vehicle.radius + other.radius + 0.1
            for other in self.vehicles.values() if other is not vehicle)

    def stop(self, vehicle):
        vehicle.stop = "AUTOACK" if vehicle.version < "3" else "MANUAL"
        self.until(vehicle, "emergency stops", lambda: setattr(vehicle, "stop", "NONE"))

    def pause(self, vehicle):
        vehicle.paused = True
        self.until(vehicle, "pauses", lambda: setattr(vehicle, "paused", False))

    def lose_place(self, vehicle):
        vehicle.lost = True
        self.until(vehicle, "places lost", lambda: setattr(vehicle, "lost", False))

    def change_map(self, vehicle):
        vehicle.map = "another hall"
        self.until(vehicle, "other maps", lambda: setattr(vehicle, "map", "hall"))

    def break_down(self, vehicle):
        vehicle.errors = [*vehicle.errors, {"errorType": "motorError", "errorLevel": "FATAL"}]
        self.until(vehicle, "breakdowns", lambda: setattr(vehicle, "errors", []))

    # ---------------------------------------------------------------- checks

    def check_released(self, message):
        """The way that is released to a vehicle touches no other vehicle's way."""
        if message.topic != "order":
            return
        vehicle = self.vehicles[message.serial_number]
        for other in self.vehicles.values():
            if other is vehicle or {vehicle.name, other.name} & self.displaced:
                continue
            if apart(released_to(vehicle), released_to(other)) < vehicle.radius + other.radius - RELEASED_M:
                self.fail(f"a way is released to {vehicle.name} that touches the one of {other.name}")

    def check_motion(self):
        for vehicle in self.vehicles.values():
            if vehicle.legs or vehicle.busy:
                self.fine_since[vehicle.name] = max(self.fine_since[vehicle.name], self.now)
            stands = self.now - self.fine_since[vehicle.name]
            self.longest_stand = max(self.longest_stand, stands)
            if stands > LONGEST_STAND_S:
                self.fail(f"{vehicle.name} has stood for {stands:.0f} s without a reason")
                self.fine_since[vehicle.name] = self.now
        paths = {name: self.path(vehicle) for name, vehicle in self.vehicles.items()}
        for a, b in itertools.combinations(self.vehicles.values(), 2):
            least = a.radius + b.radius
            if math.hypot(a.pose["x"] - b.pose["x"], a.pose["y"] - b.pose["y"]) > least + (a.speed + b.speed) * STEP_S:
                continue
            if closest_of_paths(paths[a.name], paths[b.name])[0] < least - CONTACT_M:
                if {a.name, b.name} & self.displaced:
                    self.counts["steps in which one that was pushed was met"] += 1
                    self.part(*((a, b) if a.name in self.displaced else (b, a)))
                else:
                    self.fail(f"{a.name} and {b.name} have met")

    def path(self, vehicle):
        """What it has driven in this step, and its stand."""
        path, t = [], self.now
        for begin, end, a, b in vehicle.legs:
            if begin > t:
                path.append((t, begin, a["x"], a["y"], a["x"], a["y"]))
            path.append((begin, end, a["x"], a["y"], b["x"], b["y"]))
            t = end
        x, y = vehicle.pose["x"], vehicle.pose["y"]
        return [*path, (t, max(t, self.now + STEP_S), x, y, x, y)]

    def unserved(self):
        return [mission for name, missions in self.given.items() for mission in missions
                if mission not in self.vehicles[name].missions]

    def finish(self):
        """All that was given is served, without any more disturbance."""
        self.end_disturbances()
        end = self.now + LAST_S
        self.fine_since = dict.fromkeys(self.vehicles, end)
        while self.now < end and self.unserved():
            self.step(False)
        for mission in self.unserved():
            self.fail(f"the mission {mission} is lost")
        for vehicle in self.vehicles.values():
            for mission, times in vehicle.missions.items():
                if times > 1:
                    self.fail(f"the mission {mission} was served {times} times")

    def run(self, is_over):
        """Disturbs the vehicles until it is over, and finishes."""
        try:
            while not is_over(self.now) and len(self.failures) < MAX_FAILURES:
                self.step(True)
            self.finish()
        except Exception:  # to tell when and how
            self.fail(f"the loop has ended by\n{traceback.format_exc()}")

    def print_report(self):
        reasons = collections.Counter(why for vehicle in self.vehicles.values() for why, _ in vehicle.refused)
        print(f"{self.now:.0f} s of {len(self.vehicles)} vehicles: "
              f"{sum(len(vehicle.missions) for vehicle in self.vehicles.values())} missions served, "
              f"{self.loop.rounds} rounds, at most {max(0.0, self.longest_stand):.0f} s of standing without a reason")
        for title, counts in (("done", self.counts), ("told", self.told), ("orders refused", reasons)):
            print(f"{title}: " + ", ".join(f"{count} {what}" for what, count in sorted(counts.items())))
        print(f"digest: {self.digest.hexdigest()[:16]}", flush=True)


def released_to(vehicle):
    """Where it may drive once it has read what it was sent. It refuses an order that does not begin where the one before
    ends: that was cleared."""
    way = vehicle.stretch()
    for sent in vehicle.inbox:
        places = [node["nodePosition"] for node in sent.body.get("nodes", []) if node["released"]]
        base = [(place["x"], place["y"]) for place in places]
        if base and math.dist(base[0], way[-1]) <= ON_NODE_M:
            way += base
    return way


def apart(way, other):
    """The least distance of two ways of straight pieces."""
    return min(_apart(*first, *second) for first in _pieces(way) for second in _pieces(other))


def _pieces(way):
    return list(itertools.pairwise(way)) or [(way[0], way[0])]


def _apart(a, b, c, d):
    if _crosses(a, b, c, d):
        return 0.0
    return min(_to_piece(a, c, d), _to_piece(b, c, d), _to_piece(c, a, b), _to_piece(d, a, b))


def _crosses(a, b, c, d):
    def side(p, q, r):
        return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])
    return side(a, b, c) * side(a, b, d) < 0.0 and side(c, d, a) * side(c, d, b) < 0.0


def _to_piece(p, a, b):
    x, y = b[0] - a[0], b[1] - a[1]
    squared = x * x + y * y
    share = min(1.0, max(0.0, ((p[0] - a[0]) * x + (p[1] - a[1]) * y) / squared)) if squared > 0.0 else 0.0
    return math.hypot(p[0] - a[0] - share * x, p[1] - a[1] - share * y)


def main():
    parser = argparse.ArgumentParser(description="Runs the loop for vehicles of VDA 5050 with vehicles that disturb it.")
    parser.add_argument("--binary", help="the server to start")
    parser.add_argument("--url", help="a server that is already running")
    length = parser.add_mutually_exclusive_group()
    length.add_argument("--minutes", type=float, default=60.0, help="of this machine, for all")
    length.add_argument("--seconds", type=float, help="of the vehicles, for each version")
    parser.add_argument("--robots", type=int, default=10)
    parser.add_argument("--version", choices=("2.1.0", "3.0.0"), help="by default both, one after the other")
    parser.add_argument("--seed", type=int, default=int(time.time()))
    arguments = parser.parse_args()
    if not arguments.binary and not arguments.url:
        parser.error("--binary or --url is required")
    logging.disable()  # what is told is counted
    server = Server(arguments.binary, arguments.url)
    print(f"seed {arguments.seed}, {server.url}", flush=True)
    failures = []
    versions = [arguments.version] if arguments.version else ["2.1.0", "3.0.0"]
    turns = versions if arguments.seconds else max(1, round(arguments.minutes / TURN_MIN / len(versions))) * versions
    for number, version in enumerate(turns):
        client = Client(server.url)
        soak = Soak(client, arguments.robots, version, arguments.seed + number)
        end = time.monotonic() + 60.0 * arguments.minutes / len(turns)
        soak.run(lambda now, end=end: now >= arguments.seconds if arguments.seconds else time.monotonic() >= end)
        turn = f"VDA 5050 {version}, seed {arguments.seed + number}"
        print(f"{turn}, ", end="")
        soak.print_report()
        failures += [f"{turn}, {failure}" for failure in soak.failures[:MAX_FAILURES]]
        client.close()
    if not server.alive():
        failures.append("the server ended")
    server.end()
    return verdict(failures)


if __name__ == "__main__":
    sys.exit(main())
