#!/usr/bin/env python3
"""Runs the client of docs/execution.md against a server of this build, many times with random delays. Replays what its
robots have done: no disks overlap with dependencies, and some do without.

FLEETPLAN_RUNS is the number of executions (default 30).

Usage: execution_test.py FLEETPLAN_BINARY [unittest arguments]
"""

import json
import os
import pathlib
import re
import subprocess
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

import drive  # noqa: E402
from geometry import closest_of_paths  # noqa: E402

PROJECT = pathlib.Path(__file__).resolve().parent.parent.parent
DOCUMENT = (PROJECT / "docs/execution.md").read_text()
SERVICE = "http://localhost:8080"  # as the document writes it
RUNS = int(os.environ.get("FLEETPLAN_RUNS", "30"))
MAX_LINES = 60
CONTACT = 1e-5  # metres: the tolerance of the check, and of the sums of a replay
BINARY = None


def client_source():
    (found,) = re.findall(r"^```python\n(.*?)^```$", DOCUMENT, re.MULTILINE | re.DOTALL)
    return found


def whole_paths(request, trace):
    """The paths of all robots, also while they stand, until all have arrived."""
    end = max([pieces[-1][1] for pieces in trace.values() if pieces] + [0.0]) + 1.0
    paths = {}
    for robot in request["robots"]:
        now, x, y = 0.0, robot["start"]["x"], robot["start"]["y"]
        path = []
        for t_start, t_end, *line in trace.get(robot["id"], []):
            if t_start > now:
                path.append((now, t_start, x, y, x, y))
            path.append((t_start, t_end, *line))
            now, x, y = t_end, *line[2:]
        path.append((now, end, x, y, x, y))
        paths[robot["id"]] = path
    return paths


def overlaps(request, trace):
    """The pairs of robots that overlap, and by how much."""
    paths = whole_paths(request, trace)
    radii = {robot["id"]: {**request.get("robot_defaults", {}), **robot}["radius"] for robot in request["robots"]}
    names = sorted(paths)
    found = []
    for i, first in enumerate(names):
        for second in names[i + 1:]:
            distance, _ = closest_of_paths(paths[first], paths[second])
            depth = radii[first] + radii[second] - distance
            if depth > CONTACT:
                found.append((first, second, depth))
    return found


class Client(unittest.TestCase):
    def setUp(self):
        self.service = drive.Service(BINARY)
        self.addCleanup(self.service.stop)
        self.client = {"__name__": "client"}
        exec(compile(client_source().replace(SERVICE, self.service.url), "docs/execution.md", "exec"), self.client)
        self.request = json.loads((PROJECT / "tests/scenarios/warehouse.json").read_text())
        self.request["options"] = {"dependencies": True, "interval_margin": 0.5, "time_budget_ms": 60000}

    def plan(self):
        answer = self.service.post("/v1/plan", self.request)
        self.assertEqual(answer["status"], "solved")
        self.assertEqual(answer["tight"], [])
        return answer

    def test_it_is_as_short_as_promised_and_runs_as_written(self):
        self.assertLessEqual(len(client_source().splitlines()), MAX_LINES)
        done = subprocess.run([sys.executable, "-c", client_source().replace(SERVICE, self.service.url)], cwd=PROJECT,
                              capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr[-2000:])
        self.assertRegex(done.stdout, r"^[\d.]+ seconds instead of [\d.]+$")

    def test_robots_that_obey_never_overlap_whatever_their_delays(self):
        answer = self.plan()
        for seed in range(RUNS):
            trace = self.client["execute"](answer, seed)
            self.assertEqual(overlaps(self.request, trace), [], f"seed {seed}")
            for plan in answer["plans"]:
                if plan["actions"]:
                    goal = plan["actions"][-1]["to"]
                    self.assertEqual(trace[plan["robot"]][-1][4:], [goal["x"], goal["y"]])

    def test_without_dependencies_the_same_robots_collide(self):
        answer = self.plan()
        collided = sum(bool(overlaps(self.request, self.client["execute"](answer, seed, obeys=False)))
                       for seed in range(5))
        self.assertEqual(collided, 5)

    def test_new_times_without_delays_are_those_of_the_plan(self):
        answer = self.plan()
        body = {"robots": self.request["robots"], "plans": answer["plans"], "dependencies": answer["dependencies"],
                "at": 5.0, "states": []}
        times = self.service.post("/v1/retime", body)
        self.assertEqual(times["late"], [])
        for plan, robot in zip(answer["plans"], times["robots"]):
            self.assertEqual(plan["robot"], robot["robot"])
            self.assertAlmostEqual(robot["t_end"], max(5.0, plan["cost"]))

    def test_a_robot_that_is_held_is_the_reason_why_others_are_late(self):
        answer = self.plan()
        held = answer["dependencies"][0]["until"]
        body = {"robots": self.request["robots"], "plans": answer["plans"], "dependencies": answer["dependencies"],
                "at": 0.0, "states": [{"robot": held["robot"], "action": 0, "progress": 0.0, "held_s": 60.0}]}
        times = self.service.post("/v1/retime", body)
        self.assertGreater(len(times["late"]), 1)
        self.assertEqual({late["because_of"] for late in times["late"]}, {held["robot"]})
        for late in times["late"]:
            self.assertEqual(late["waits_for"] is None, late["robot"] == held["robot"])
            self.assertLessEqual(late["delay"], 60.0 + 1e-6)


class TheReplayOfExecutions(unittest.TestCase):
    def test_it_finds_robots_that_overlap_while_one_of_them_stands(self):
        request = {"robot_defaults": {"radius": 0.5},
                   "robots": [{"id": "a", "start": {"x": 0.0, "y": 0.0}}, {"id": "b", "start": {"x": 5.0, "y": 0.0}}]}
        self.assertEqual(overlaps(request, {"a": [[2.0, 6.0, 0.0, 0.0, 4.0, 0.0]]}), [])
        ((first, second, depth),) = overlaps(request, {"a": [[2.0, 6.0, 0.0, 0.0, 4.25, 0.0]]})
        self.assertEqual((first, second), ("a", "b"))
        self.assertAlmostEqual(depth, 0.25)


if __name__ == "__main__":
    BINARY = sys.argv.pop(1)
    unittest.main()
