#!/usr/bin/env python3
"""The server under a limit of its address space (RLIMIT_AS). Requests that want more than their share of memory get an
answer, and honest requests are planned beside and after them. Also a command with more workers than threads fit into
it.

  memory_limit_test.py FLEETPLAN    the executable
"""

import concurrent.futures
import gzip
import json
import random
import resource
import subprocess
import sys
import unittest
import urllib.error
import urllib.request

MIB = 1 << 20
FLAGS = ["--workers", "1", "--queue", "4", "--max-plan-memory", "96MiB", "--map-cache", "32MiB", "--max-body",
         "16MiB"]
# Besides what is resident, the address space has the stacks of threads (8 MiB each) and what malloc sets apart for each
# arena (64 MiB).
ADDRESS_SPACE = 1024 * MIB
# The sum of docs/operations.md when one request is served: at rest, its body, as sent and decompressed, its plan, and the
# maps that are kept.
RESIDENT = 30 * MIB + 2 * 16 * MIB + 96 * MIB + 32 * MIB


def plan_request(columns, rows, robots, resolution=1.0, **options):
    return {
        "map": {"rows": ["." * columns] * rows, "resolution": resolution},
        "robot_defaults": {"radius": 0.3, "linear_speed": 1.0, "angular_speed": 2.0},
        "robots": robots,
        "options": options,
    }


def honest():
    """A robot that crosses a hall."""
    robot = {"id": "a", "start": {"x": 0.5, "y": 0.5}, "goal": {"x": 8.5, "y": 8.5}}
    return plan_request(10, 10, [robot], time_budget_ms=60000)


def long_ids():
    """Robots that all block each other."""
    def position(index, offset):
        return {"x": 60.0 * (index % 50) + 20.0 + offset, "y": 60.0 * (index // 50) + 20.0}

    robots = [{"id": f"{i:04}" + "x" * 252, "start": position(i, 0.0), "goal": position(i, 5.0)} for i in range(2000)]
    return plan_request(3, 3, robots, resolution=1000.0, inflation=900)


def occupied_door():
    """The goal is in a room, in whose door a robot is parked: a search floods the hall."""
    size = 600
    rows = [["."] * size for _ in range(size)]
    for k in range(11):
        rows[10][k] = rows[k][10] = "#"
    rows[5][10] = "."
    parked = {"id": "parked", "start": {"x": 10.5, "y": size - 5.5}}
    mover = {"id": "mover", "start": {"x": size - 5.5, "y": 5.5}, "goal": {"x": 5.5, "y": size - 5.5}}
    request = plan_request(1, 1, [parked, mover], time_budget_ms=20000)
    request["map"]["rows"] = ["".join(row) for row in rows]
    return request


def large_map(robots, **options):
    """Robots anywhere on the largest map."""
    rng = random.Random(1)
    places = [{"x": 2.0 * (k % 1000) + 0.5, "y": 2.0 * (k // 1000) + 0.5} for k in rng.sample(range(10**6), 2 * robots)]
    fleet = [{"id": str(i), "start": places[2 * i], "goal": places[2 * i + 1]} for i in range(robots)]
    return plan_request(2000, 2000, fleet, **options)


def empty_values(value):
    """14 MiB of empty values, whose parsed form is much larger."""
    return b'{"robots":[' + b",".join([value] * (14 * MIB // 3)) + b"]}"


class Server:
    def __init__(self, executable):
        self.process = subprocess.Popen(
            [executable, "--port", "0", "--log-level", "off", *FLAGS], stdout=subprocess.PIPE, text=True,
            preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (ADDRESS_SPACE, ADDRESS_SPACE)))
        self.url = self.process.stdout.readline().split()[-1]

    def post(self, request):
        """Status and JSON of the answer to a plan request, which is sent with gzip."""
        body = request if isinstance(request, bytes) else json.dumps(request).encode()
        fields = {"Content-Type": "application/json", "Content-Encoding": "gzip"}
        http_request = urllib.request.Request(self.url + "/v1/plan", gzip.compress(body, 1), fields)
        try:
            with urllib.request.urlopen(http_request, timeout=300) as answer:
                return answer.status, json.load(answer)
        except urllib.error.HTTPError as error:
            return error.code, json.load(error)

    def peak_resident(self):
        with open(f"/proc/{self.process.pid}/status", encoding="ascii") as status:
            return next(1024 * int(line.split()[1]) for line in status if line.startswith("VmHWM:"))

    def stop(self):
        self.process.terminate()
        self.process.stdout.close()
        return self.process.wait(60)


class MemoryLimit(unittest.TestCase):
    executable = None

    def setUp(self):
        self.server = Server(self.executable)

    def tearDown(self):
        status, answer = self.server.post(honest())
        self.assertEqual((status, answer.get("status")), (200, "solved"), answer)
        self.assertEqual(self.server.stop(), 0)

    def expect_answered(self, request):
        """The answer is a plan, which may be partial, or a refusal. A request may be refused if it needs too much
        memory, or more time for its check than a busy machine has."""
        status, answer = self.server.post(request)
        if status != 200:
            self.assertEqual(status, 422, answer)
            self.assertIn(answer["code"], ("memory_exceeded", "check_unfinished"), answer)
        return status, answer

    def expect_within_its_memory(self):
        self.assertLess(self.server.peak_resident(), RESIDENT)

    def test_robots_with_long_ids_that_all_block_each_other(self):
        self.expect_answered(long_ids())
        self.expect_within_its_memory()

    def test_a_search_that_floods_a_hall(self):
        status, answer = self.expect_answered(occupied_door())
        self.assertEqual((status, answer["status"]), (200, "partial"))
        self.expect_within_its_memory()

    def test_many_robots_on_the_largest_map(self):
        self.expect_answered(large_map(2000, time_budget_ms=2000))
        self.expect_within_its_memory()

    def test_an_anytime_plan_on_the_largest_map(self):
        self.expect_answered(large_map(100, mode="anytime", time_budget_ms=5000))
        self.expect_within_its_memory()

    def test_ten_large_bodies_of_empty_values_at_once(self):
        bodies = [empty_values(value) for value in (b"{}", b'""')] * 5
        with concurrent.futures.ThreadPoolExecutor(11) as clients:
            answers = [clients.submit(self.server.post, body) for body in bodies]
            for answer in answers:
                status, problem = answer.result()
                self.assertIn(status, (422, 503), problem)
        self.server.post(honest())


class Command(unittest.TestCase):
    """A command under the same limit."""

    def test_it_works_with_the_threads_that_the_system_grants(self):
        request = honest()
        request["options"] = {"mode": "anytime", "max_iterations": 200}
        request["robots"] += [{"id": "b", "start": {"x": 8.5, "y": 0.5}, "goal": {"x": 0.5, "y": 8.5}}]
        done = subprocess.run(
            [MemoryLimit.executable, "plan", "--workers", "1000"], input=json.dumps(request).encode(),
            capture_output=True, check=False,
            preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (ADDRESS_SPACE, ADDRESS_SPACE)))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(json.loads(done.stdout)["status"], "solved")


if __name__ == "__main__":
    MemoryLimit.executable = sys.argv.pop(1)
    unittest.main()
