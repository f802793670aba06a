"""The loop with simulated robots. Goals are served, no robot is met, and rounds that fail cost only time."""

import json
import time
import unittest

from support import PROJECT, met, service

from fleetplan import Client, ConnectionFailed, FleetLoop, PlanDropped, RequestRefused, ServiceUnavailable
from fleetplan.simulation import SimulatedFleet


class Fails:
    """A client of which some requests fail."""

    def __init__(self, client, name, fails):
        """`fails(n)`: the exception that request n of this name raises, from 1, or None."""
        self.client, self.name, self.fails, self.count = client, name, fails, 0

    def __getattr__(self, name):
        method = getattr(self.client, name)
        if name != self.name:
            return method

        def counted(*arguments, **members):
            self.count += 1
            error = self.fails(self.count)
            if error is not None:
                raise error
            return method(*arguments, **members)
        return counted


class Day:
    """Robots that go to their goal, and then again and again to their start, for a service, and back to their goal."""

    def __init__(self, client, robots, fleet=None, limits=None, commit=1.4, **how):
        """`limits`: of accelerations."""
        self.request = json.loads((PROJECT / "tests/scenarios/warehouse.json").read_text())
        self.request["robots"] = self.request["robots"][:robots]
        self.request["options"] = {"time_budget_ms": 20000}  # a busy machine changes nothing
        if limits:
            self.request["robot_defaults"] = limits
        self.fleet = SimulatedFleet(self.request, **(fleet or {}))
        self.loop = FleetLoop(client, self.request, clock=self.fleet.clock, background=False, commit=commit, **how)
        self.trips = {robot["id"]: [{**robot["start"], "service": 1.5}, robot["goal"]] for robot in self.request["robots"]}
        self.arrived, self.failures, self.overran, self.statuses = [], [], set(), []

    def run(self, seconds):
        while self.fleet.now < seconds:
            before = self.loop.answer
            self.fleet.obey(self.loop.step(self.fleet.reports()))
            if self.loop.failure is not None:
                self.failures.append(self.loop.failure)
            if self.loop.answer is not before:
                self.statuses.append(self.loop.answer["status"])
            self.fleet.drive(0.1)
            self.overran |= set(self.loop.overran)
            for robot in self.loop.idle:
                self.arrived.append(robot)
                self.loop.give(robot, self.trips[robot])
        return self


class Loops(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.client = cls.enterClassContext(Client(cls.enterClassContext(service())))

    def assert_nobody_was_met(self, day):
        self.assertEqual(met(day.request, day.fleet), ([], []))
        self.assertEqual(day.overran, set())

    def test_robots_in_time_serve_their_goals(self):
        day = Day(self.client, 12, {"speed": (1.0, 1.0)}).run(40.0)
        self.assert_nobody_was_met(day)
        self.assertEqual(day.failures, [])
        self.assertGreaterEqual(len(day.statuses), 39)
        self.assertEqual(set(day.statuses), {"solved"})
        self.assertGreaterEqual(len(day.arrived), 12)

    def test_robots_that_accelerate_serve_their_goals_and_meet_nobody(self):
        limits = {"linear_acceleration": 0.5, "linear_deceleration": 0.8}
        day = Day(self.client, 12, {"seed": 3, "speed": (0.8, 1.0), "noise": 0.002}, limits, commit=None, reaction=0.1)
        day.run(60.0)
        self.assert_nobody_was_met(day)
        self.assertEqual(day.failures, [])
        self.assertGreaterEqual(len(day.arrived), 8)

    def test_robots_that_are_late_and_stop_serve_their_goals_and_meet_nobody(self):
        day = Day(self.client, 25, {"seed": 1, "speed": (0.6, 1.0), "stops_per_hour": 60.0, "noise": 0.002}).run(50.0)
        self.assert_nobody_was_met(day)
        self.assertEqual(day.failures, [])
        self.assertGreaterEqual(len(day.arrived), 15)

    def test_a_service_that_begins_late_is_not_lost(self):
        day = Day(self.client, 12, {"seed": 2, "speed": (0.4, 0.7)}).run(80.0)
        trips = 0
        for robot in day.request["robots"]:
            served = sum(near(robot["start"], pose) and seconds > 1.45
                         for pose, seconds in stands_of(day.fleet.legs[robot["id"]]))
            begun = max(0, day.arrived.count(robot["id"]) - 1)
            self.assertGreaterEqual(served, begun, robot["id"])
            trips += begun
        self.assertGreaterEqual(trips, 4)

    def test_rounds_that_fail_cost_nothing_but_time(self):
        errors = {2: ConnectionFailed("lost"), 3: ServiceUnavailable(503, {"code": "overloaded"}), 7: ConnectionFailed("lost")}
        for name in ("plan", "advance"):
            with self.subTest(name):
                day = Day(Fails(self.client, name, errors.get), 12).run(15.0)
                self.assert_nobody_was_met(day)
                self.assertEqual({str(failure) for failure in day.failures}, {str(error) for error in errors.values()})
                self.assertIsNone(day.loop.failure)
                self.assertTrue(any(leg.begin != leg.end for leg in day.fleet.legs["tote-01"] if leg.t_start > 12.0))

    def test_plans_may_take_time_on_the_clock_of_a_simulation(self):
        fleet = {"seed": 1, "speed": (0.8, 1.0), "acceleration": 1.0, "noise": 0.002}
        day = Day(self.client, 12, fleet, latency=0.5, deceleration=0.8, reaction=0.1).run(1.0)
        self.assertEqual(day.loop.answer["status"], "solved")
        self.assertEqual([leg for leg in day.fleet.legs["tote-01"] if leg.t_start < 0.45], [], "there is no plan yet")
        day.run(40.0)
        self.assert_nobody_was_met(day)
        self.assertEqual(day.failures, [])
        self.assertGreaterEqual(len(day.arrived), 8)

    def test_robots_that_are_stuck_are_told_with_those_in_their_way(self):
        robots = [{"id": "a", "start": {"x": 2.5, "y": 0.5}, "goal": {"x": 12.5, "y": 0.5}},
                  {"id": "b", "start": {"x": 4.5, "y": 0.5}}]
        request = {"map": {"rows": ["." * 20]}, "robots": robots,
                   "robot_defaults": {"radius": 0.4, "linear_speed": 1.0, "angular_speed": 1.0}}
        fleet = SimulatedFleet(request)
        loop = FleetLoop(self.client, request, clock=fleet.clock, background=False, commit=1.0)
        while fleet.now < 6.0:
            fleet.obey(loop.step(fleet.reports()))
            fleet.drive(0.1)
        self.assertEqual(loop.stuck, {"a": ["b"]})
        self.assertIsNone(loop.answer["plans"][0]["estimated_cost"])

    def test_a_plan_that_robots_cannot_obey_is_put_off_and_then_given_up(self):
        defaults = {"radius": 0.4, "linear_speed": 1.0, "angular_speed": 1.0}
        robots = [{"id": robot, "start": {"x": 0.5, "y": y, "theta": 0.0}, "goal": {"x": 24.5, "y": y, "theta": 0.0}}
                  for robot, y in (("a", 0.5), ("b", 2.5))]
        request = {"map": {"rows": ["." * 25] * 3}, "robots": robots, "robot_defaults": defaults}
        # After half a second a is past the gate, which opens when b has driven so far: soon, or too late.
        for opens, times in ((0.9, [0.5, 1.5, 3.0, 3.5]), (2.9, [0.5, 1.5, 4.0])):
            with self.subTest(opens=opens):
                fleet = SimulatedFleet(request, speed=(1.0, 1.0))
                client = WithGate(self.client, 3, ("a", 0.3), ("b", opens))
                loop = FleetLoop(client, request, clock=fleet.clock, background=False, commit=3.0, latency=0.5)
                taken, failures = [], []
                while fleet.now < 4.5:
                    before = loop.answer, loop.failure
                    fleet.obey(loop.step(fleet.reports()))
                    if loop.answer is not before[0]:
                        taken.append(fleet.now)
                    if loop.failure not in (None, before[1]):
                        failures.append((fleet.now, type(loop.failure), str(loop.failure)))
                    self.assertEqual(loop.overran, [])
                    fleet.drive(0.125)
                self.assertEqual(taken, times)
                dropped = [(3.5, PlanDropped, "['a'] could not stop before gates of the plan")]
                self.assertEqual(failures, dropped if len(times) == 3 else [])
                for robot in "ab":
                    self.assertAlmostEqual(fleet.pose(robot)["x"], 0.5 + fleet.now - 0.5, delta=0.05)

    def test_dependencies_that_are_missing_are_asked_for(self):
        client = WithoutDependencies(self.client)
        day = Day(client, 12).run(5.0)
        self.assert_nobody_was_met(day)
        self.assertGreaterEqual(client.asked, 5)

    def test_goals_that_are_refused_are_reported_and_dropped(self):
        day = Day(self.client, 12).run(2.0)
        robot = day.request["robots"][0]["id"]
        day.loop.give(robot, [{"x": -5.0, "y": 0.0}])
        with self.assertRaisesRegex(RequestRefused, "does not fit|map"):
            day.run(6.0)
        day.run(10.0)
        self.assertIsNone(day.loop.failure)
        self.assert_nobody_was_met(day)

    def test_the_first_request_is_reported_if_it_is_refused(self):
        with self.assertRaises(RequestRefused):
            FleetLoop(self.client, {"map": {"rows": ["."]}, "robots": []}, background=False).step()

    def test_a_robot_that_is_held_stands(self):
        day = Day(self.client, 12).run(3.0)
        robot = next(robot for robot in day.fleet.legs if robot not in day.loop.idle)
        day.loop.hold(robot, 8.0)
        day.run(5.0)
        held = day.fleet.pose(robot)
        day.run(10.5)
        self.assertEqual(day.fleet.pose(robot), held)
        day.run(25.0)
        self.assertNotEqual(day.fleet.pose(robot), held)
        self.assert_nobody_was_met(day)

    def test_requests_may_be_changed_before_they_are_planned(self):
        person = {"id": "person", "radius": 0.3, "motion": [{"t": 0.0, "x": 15.25, "y": 9.75}], "after": "stays"}
        seen = []

        def change(request):
            seen.append(request)
            request["obstacles"] = [person]
        day = Day(self.client, 4, change=change).run(20.0)
        self.assertGreaterEqual(len(seen), 19)
        for legs in day.fleet.legs.values():
            for leg in legs:
                self.assertGreater(abs(leg.end["x"] - 15.25) + abs(leg.end["y"] - 9.75), 0.3)

    def test_plans_are_made_while_robots_go_on(self):
        request = json.loads((PROJECT / "tests/scenarios/warehouse.json").read_text())
        request["robots"] = request["robots"][:12]
        fleet, client = SimulatedFleet(request), Slow(self.client, 0.5)
        moves = 0  # steps in which robots moved while a plan was made
        with FleetLoop(client, request, period=0.2) as loop:
            while client.plans < 5:
                under_way = client.under_way
                fleet.obey(loop.step(fleet.reports()))
                fleet.drive(0.05)
                moves += under_way and any(legs and legs[-1].begin != legs[-1].end for legs in fleet.legs.values())
                time.sleep(0.05)
            self.assertIsNone(loop.failure)
        self.assertGreater(moves, 10)
        self.assertEqual(met(request, fleet), ([], []))


class Slow:
    """A client whose plans take some time."""

    def __init__(self, client, seconds):
        self.client, self.seconds, self.plans, self.under_way = client, seconds, 0, False

    def __getattr__(self, name):
        return getattr(self.client, name)

    def plan(self, request):
        self.under_way = True
        time.sleep(self.seconds)
        answer = self.client.plan(request)
        self.plans, self.under_way = self.plans + 1, False
        return answer


class WithoutDependencies:
    """A client whose plans lack their dependencies, as if the time budget had not sufficed."""

    def __init__(self, client):
        self.client, self.asked = client, 0

    def __getattr__(self, name):
        return getattr(self.client, name)

    def plan(self, request):
        return {**self.client.plan(request), "dependencies": None, "tight": None}

    def dependencies(self, request, answer):
        self.asked += 1
        return self.client.dependencies(request, answer)


class WithGate:
    """A client of which one plan has a gate within what is committed."""

    def __init__(self, client, number, gate, until):
        """The gate is in this plan, from 1. `gate`, `until`: a robot, and metres of its first action."""
        self.client, self.number, self.gate, self.until, self.count = client, number, gate, until, 0

    def __getattr__(self, name):
        return getattr(self.client, name)

    def plan(self, request):
        answer = self.client.plan(request)
        self.count += 1
        if self.count == self.number:
            first = {plan["robot"]: plan["actions"][0] for plan in answer["plans"]}
            gate, until = ({"robot": robot, "action": 0,
                            "progress": metres / (first[robot]["to"]["x"] - first[robot]["from"]["x"])}
                           for robot, metres in (self.gate, self.until))
            answer["dependencies"].append({"gate": gate, "until": until, "slack": 0.0})
        return answer


def stands_of(legs):
    """Where a robot has stood, and for how long: [(pose, seconds)]."""
    stands = []
    for leg in legs:
        if leg.begin != leg.end:
            stands.append((leg.end, 0.0))
        elif stands:
            stands[-1] = leg.end, stands[-1][1] + leg.t_end - leg.t_start
    return stands


def near(place, pose):
    return abs(place["x"] - pose["x"]) + abs(place["y"] - pose["y"]) < 0.1


if __name__ == "__main__":
    unittest.main()
