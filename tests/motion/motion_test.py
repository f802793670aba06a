#!/usr/bin/env python3
"""Runs the loop of docs/fleet_loop.md for its hundred rounds and a short drive, against a server of this build. Also
tests the replay that judges drives.

Usage: motion_test.py FLEETPLAN_BINARY [unittest arguments]
"""

import contextlib
import http.server
import math
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import threading
import unittest
import urllib.request

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

import drive  # noqa: E402
from geometry import closest_of_paths, pose_in, to_rectangle  # noqa: E402
from replay import Replay, Visits  # noqa: E402

PROJECT = pathlib.Path(__file__).resolve().parent.parent.parent
DOCUMENT = (PROJECT / "docs/fleet_loop.md").read_text()
SERVICE = "http://localhost:8080"  # as the document writes it
BINARY = None


def block(language):
    (found,) = re.findall(rf"^```{language}\n(.*?)^```$", DOCUMENT, re.MULTILINE | re.DOTALL)
    return found


class Loops(unittest.TestCase):
    def setUp(self):
        self.service = drive.Service(BINARY)
        self.addCleanup(self.service.stop)

    def expect_a_hundred_rounds(self, done):
        self.assertEqual(done.returncode, 0, done.stderr[-2000:])
        rounds = done.stdout.splitlines()
        self.assertEqual([line.split()[0] for line in rounds], [str(second) for second in range(100)])
        self.assertLessEqual({line.split()[2] for line in rounds}, {"solved,"}, done.stdout)
        self.assertGreater(sum(int(re.search(r"(\d+) arrived", line).group(1)) for line in rounds), 40)

    @unittest.skipUnless(shutil.which("curl") and shutil.which("jq"), "needs curl and jq")
    def test_the_loop_in_the_shell_runs_for_a_hundred_rounds(self):
        place = SERVICE.removeprefix("http://")
        script = block("sh")
        self.assertIn(place, script)
        with tempfile.TemporaryDirectory() as folder:
            (pathlib.Path(folder) / "tests").symlink_to(PROJECT / "tests")
            (pathlib.Path(folder) / ".curlrc").write_text("fail\nsilent\nshow-error\n")
            self.expect_a_hundred_rounds(subprocess.run(
                ["bash", "-euo", "pipefail", "-c", script.replace(place, self.service.url.removeprefix("http://"))],
                cwd=folder, env={**os.environ, "CURL_HOME": folder}, capture_output=True, text=True, check=False))

    @unittest.skipUnless(shutil.which("curl") and shutil.which("jq"), "needs curl and jq")
    def test_the_loop_in_the_shell_goes_on_after_answers_that_are_none(self):
        broken = [(503, b'{"detail": "draining"}'), (200, b"<html>"), (200, b"{}"), (302, b"{}"), (200, b""), None]
        place = SERVICE.removeprefix("http://")
        for path in ("/v1/plan", "/v1/advance"):
            with self.subTest(path), spoiling(self.service.url, path, 3, broken) as url, tempfile.TemporaryDirectory() as folder:
                (pathlib.Path(folder) / "tests").symlink_to(PROJECT / "tests")
                script = block("sh").replace(place, url.removeprefix("http://")).replace("seq 0 99", "seq 0 15")
                done = subprocess.run(["bash", "-uo", "pipefail", "-c", script], cwd=folder, capture_output=True, text=True,
                                      check=False, timeout=300)
                ages = [int(age) for age in re.findall(r"solved, \d+ arrived, planned (\d+) s ago", done.stdout)]
                self.assertEqual(len(ages), 16, done.stdout + done.stderr[-2000:])
                self.assertGreater(max(ages), 4)
                self.assertEqual(ages[-1], 1)


@contextlib.contextmanager
def spoiling(service, path, first, answers):
    """The URL of a proxy that answers some requests of this path, from a number on, in this way: a status and a body,
    or None to break off."""
    left, count = list(answers), [0]

    class Handler(http.server.BaseHTTPRequestHandler):
        def do_POST(self):
            body = self.rfile.read(int(self.headers["Content-Length"]))
            count[0] += self.path == path
            answer = left.pop(0) if self.path == path and count[0] >= first and left else ()
            if answer is None:
                self.wfile.write(b"HTTP/1.0 200 OK\r\nContent-Length: 600\r\n\r\n{")
                return
            if answer == ():
                request = urllib.request.Request(service + self.path, body, {"Content-Type": "application/json"})
                with urllib.request.urlopen(request) as response:
                    answer = response.status, response.read()
            self.send_response(answer[0])
            self.send_header("Content-Length", str(len(answer[1])))
            self.end_headers()
            self.wfile.write(answer[1])

        def log_message(self, *_):
            pass

    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    thread = threading.Thread(target=server.serve_forever, args=(0.01,))
    thread.start()
    try:
        yield f"http://127.0.0.1:{server.server_address[1]}"
    finally:
        server.shutdown()
        thread.join()
        server.server_close()


class Drives(unittest.TestCase):
    def drive(self, *arguments):
        options = drive.arguments(["--binary", BINARY, "--robots", "12", "--seconds", "60", "--commit", "1",
                                   "--budget-ms", "5000", *arguments])
        service = drive.Service(BINARY)
        self.addCleanup(service.stop)
        done = drive.Drive(service, drive.instance(options), options).run().report()
        self.assertEqual(done["first_problems"], [])
        self.assertEqual(done["plans"], 61)
        self.assertGreater(done["metres"], 100.0)
        self.assertGreater(done["goals_served"], 5)
        return done

    def test_twelve_robots_drive_for_a_minute_without_a_problem(self):
        done = self.drive()
        self.assertEqual(done["unplanned"], {})

    def test_robots_are_held_and_others_keep_their_plans(self):
        done = self.drive("--holds", "3")
        self.assertEqual(done["holds"], 3)
        self.assertLess(done["plans_changed"], done["plans_under_way"] / 5)

    def test_late_robots_tell_where_they_are_and_nobody_collides_with_them(self):
        done = self.drive("--late", "6", "--margin", "0.5", "--noise", "0.02", "--options", '{"inflation": 0.03}')
        self.assertEqual(done["late"], 6)


def action(kind, t0, t1, a, b):
    def pose(values):
        return dict(zip(("x", "y", "theta"), values))
    return {"type": kind, "t_start": t0, "t_end": t1, "from": pose(a), "to": pose(b)}


def two_robots():
    return {"map": {"rows": ["......", "......", "......"]},
            "robot_defaults": {"radius": 0.4, "linear_speed": 1.0, "angular_speed": 1.0},
            "robots": [{"id": "a", "start": {"x": 0.5, "y": 0.5}}, {"id": "b", "start": {"x": 5.5, "y": 0.5}}]}


class TheReplay(unittest.TestCase):
    def faults_of(self, actions, seconds=4.0, request=None):
        replay = Replay(request or two_robots())
        replay.execute(actions, seconds)
        return replay.faults

    def test_a_drive_beside_others_has_no_fault(self):
        self.assertEqual(self.faults_of({"a": [action("translate", 0, 3, (0.5, 0.5, 0), (3.5, 0.5, 0))]}), [])

    def test_disks_that_overlap_are_found_between_events(self):
        near = action("translate", 0, 4, (0.5, 0.5, 0), (4.5, 0.5, 0))
        self.assertEqual(self.faults_of({"a": [near]}, 4.4), [])
        faults = self.faults_of({"a": [action("translate", 0, 4.5, (0.5, 0.5, 0), (5.0, 0.5, 0))]}, 4.6)
        self.assertEqual(len(faults), 1)
        self.assertIn("a and b overlap", faults[0])

    def test_jumps_speed_walls_and_sideways_motion_are_found(self):
        cases = {"jumps": action("translate", 0, 1, (0.6, 0.5, 0), (1.0, 0.5, 0)),
                 "too fast": action("translate", 0, 1, (0.5, 0.5, 0), (2.5, 0.5, 0)),
                 "wall": action("translate", 0, 1, (0.5, 0.5, -0.5), (0.5 + math.cos(0.5), 0.5 - math.sin(0.5), -0.5)),
                 "aside": action("translate", 0, 1, (0.5, 0.5, 0), (0.5, 1.4, 0)),
                 "moves in a wait": action("wait", 0, 1, (0.5, 0.5, 0), (0.8, 0.5, 0))}
        for word, moved in cases.items():
            with self.subTest(word):
                self.assertTrue(any(word in fault for fault in self.faults_of({"a": [moved]})))

    def test_people_that_robots_meet_are_counted(self):
        replay = Replay(two_robots())
        person = {"id": "p", "radius": 0.2, "motion": [{"t": 0, "x": 3.0, "y": 2.0}, {"t": 2, "x": 3.0, "y": 0.5}]}
        replay.execute({}, 4.0, [person])
        self.assertEqual(replay.met, [])
        replay.execute({"a": [action("translate", 0, 2, (0.5, 0.5, 0), (2.5, 0.5, 0))]}, 4.0, [person])
        self.assertEqual([met[:2] for met in replay.met], [("a", "p")])

    def test_a_service_takes_time_at_rest_in_the_pose_of_its_goal(self):
        visits = Visits([{"x": 1.0, "y": 1.0, "service": 2.0}, {"x": 1.0, "y": 1.0, "theta": 0.5}])
        visits.rests((1.0, 2.0, 0.0), 0.0, 9.0)
        visits.rests((1.0, 1.0, 0.0), 9.0, 10.0)
        self.assertEqual(len(visits.goals), 2)
        visits.rests((1.0, 1.0, 0.0), 15.0, 16.0)  # it goes on
        self.assertEqual(len(visits.goals), 1)
        visits.rests((1.0, 1.0, 0.5), 18.0, 18.0)
        self.assertEqual(len(visits.goals), 0)

    def test_distances_are_those_of_continuous_motion(self):
        crossing = closest_of_paths([(0.0, 2.0, 0.0, 0.0, 2.0, 0.0)], [(0.0, 2.0, 1.0, -1.0, 1.0, 1.0)])
        self.assertAlmostEqual(crossing[0], 0.0)
        self.assertAlmostEqual(crossing[1], 1.0)
        self.assertAlmostEqual(to_rectangle(0.0, 2.0, 4.0, 2.0, 1.0, 0.0, 2.0, 1.0), 1.0)
        self.assertEqual(to_rectangle(0.0, 0.5, 4.0, 0.5, 1.0, 0.0, 2.0, 1.0), 0.0)
        turning = action("rotate", 0.0, 1.0, (1.0, 1.0, 3.0), (1.0, 1.0, -3.0))
        self.assertAlmostEqual(abs(pose_in(turning, 0.5)[2]), math.pi)


if __name__ == "__main__":
    BINARY = sys.argv.pop(1)
    unittest.main()
