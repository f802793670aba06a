"""What requests say of vehicles that have no order, are not available, or are released to the end of their goals."""

import copy
import unittest

from support import service

from fleetplan import Client
from fleetplan.unavailable import put_aside, serve_once, start_where_measured

HERE, THERE = {"x": 1.5, "y": 1.5, "theta": 0.0}, {"x": 4.5, "y": 1.5, "theta": 0.0}
LAST = {**HERE, "service": 2.0, "actions": [{"type": "pick"}]}
SERVICE = {"type": "wait", "t_start": 0.0, "t_end": 2.0, "from": HERE, "to": HERE, "goal": 0}
LEAVING = {"type": "translate", "t_start": 2.0, "t_end": 5.0, "from": HERE, "to": THERE}


def request_of(committed, goals):
    robot = {"id": "a", "radius": 0.4, "linear_speed": 1, "angular_speed": 2, "start": HERE, "committed": committed}
    if goals:
        robot["goals"] = goals
    return copy.deepcopy({"map": {"rows": ["." * 8] * 3}, "options": {"time_budget_ms": 5000}, "robots": [robot]})


def goals_of(request):
    return request["robots"][0].get("goals", [])


class ServedOnce(unittest.TestCase):
    def test_a_service_that_is_released_is_planned_once_though_the_robot_leaves(self):
        with service() as url, Client(url) as client:
            services = {}
            for is_asked in (False, True):
                request = request_of([SERVICE, LEAVING], [LAST])
                if is_asked:
                    serve_once(request, {})
                actions = client.plan(request)["plans"][0]["actions"]
                services[is_asked] = [(action["t_start"], action["goal"]) for action in actions if "goal" in action]
                self.assertEqual([actions[-1]["to"][name] for name in "xy"], [1.5, 1.5])
        self.assertEqual(services[True], [(0.0, 0)])
        self.assertNotEqual(services[False], services[True], "serve_once is not needed any more")

    def test_one_that_is_not_available_stays_where_it_is_released_to(self):
        request = request_of([SERVICE, LEAVING], [LAST, {"x": 6.5, "y": 1.5}])
        self.assertEqual(put_aside(request, {"a"}, {}, {}), {"a": [{"x": 6.5, "y": 1.5}]})
        serve_once(request, {"a"})
        self.assertEqual(goals_of(request), [LAST, THERE])

    def test_rounds_without_it_add_nothing(self):
        request = request_of([SERVICE, LEAVING], [LAST])
        waiting = {}
        for _ in range(3):
            waiting = put_aside(request, {"a"}, waiting, {})
            serve_once(request, {"a"})
        self.assertEqual((goals_of(request), waiting), ([LAST, THERE], {"a": []}))
        put_aside(request, {}, waiting, {})
        serve_once(request, {})
        self.assertEqual(goals_of(request), [LAST, THERE])

    def test_a_part_of_a_service_is_none(self):
        request = request_of([{**SERVICE, "t_end": 1.0}], [LAST])
        serve_once(request, {})
        self.assertEqual(goals_of(request), [LAST])

    def test_a_goal_that_is_not_the_last_one_needs_nothing(self):
        request = request_of([SERVICE], [LAST, {"x": 6.5, "y": 1.5}])
        serve_once(request, {})
        self.assertEqual(len(goals_of(request)), 2)


class Starts(unittest.TestCase):
    MEASURED = {"robot": "a", "action": 0, "progress": 0.0, "x": 1.53, "y": 1.5, "theta": 0.1}
    POSE = {"x": 1.53, "y": 1.5, "theta": 0.1}

    def test_one_that_is_committed_to_stand_stands_where_it_is_measured(self):
        stand = {name: value for name, value in SERVICE.items() if name != "goal"}
        request = request_of([stand], [])
        start_where_measured(request, [self.MEASURED], {})
        robot = request["robots"][0]
        self.assertEqual((robot["start"], robot["committed"]), (self.POSE, [{**stand, "from": self.POSE, "to": self.POSE}]))

    def test_a_commitment_that_moves_or_serves_stays(self):
        for committed in ([SERVICE], [LEAVING]):
            request = request_of(committed, [LAST])
            start_where_measured(request, [self.MEASURED], {})
            self.assertEqual(request["robots"][0]["start"], HERE)


if __name__ == "__main__":
    unittest.main()
