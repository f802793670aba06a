#!/usr/bin/env python3
"""Runs examples/plan.py and plan.sh with a server of this build.

Usage: examples_test.py FLEETPLAN_BINARY [unittest arguments]
plan.sh needs curl and jq; without them it is skipped.
"""

import contextlib
import pathlib
import re
import shutil
import socket
import subprocess
import sys
import tempfile
import threading
import unittest

PROJECT = pathlib.Path(__file__).resolve().parent.parent.parent
EXAMPLES = PROJECT / "examples"
REQUEST = PROJECT / "tests/scenarios/corridor-swap.json"
BINARY = None


def run(*command):
    return subprocess.run(command, capture_output=True, text=True, check=False, timeout=60)


class Examples(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.server = subprocess.Popen([BINARY, "--port", "0", "--log-level", "off"],
                                      stdout=subprocess.PIPE, text=True)
        cls.url = re.search(r"http://\S+", cls.server.stdout.readline()).group()

    @classmethod
    def tearDownClass(cls):
        cls.server.terminate()
        cls.server.wait()
        cls.server.stdout.close()

    def python(self, *arguments):
        return run(sys.executable, "-B", EXAMPLES / "plan.py", *arguments, "--url", self.url)

    def assert_solved(self, done):
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stdout, r"(?m)^east-bound arrives after \d+\.\d+ s")
        self.assertRegex(done.stdout, r"(?m)^solved, flowtime \d+\.\d+ s$")

    def test_the_python_example_plans_its_own_request_and_one_of_a_file(self):
        self.assert_solved(self.python())
        self.assert_solved(self.python(REQUEST))

    def test_the_python_example_tells_what_is_wrong(self):
        with tempfile.NamedTemporaryFile("w", suffix=".json") as file:
            file.write('{"map": {"rows": ["..#"]}, "robots": [{"id": "a"}]}')
            file.flush()
            done = self.python(file.name)
        self.assertEqual(done.returncode, 2)
        self.assertIn("/robots/0", done.stderr)
        refused = run(sys.executable, "-B", EXAMPLES / "plan.py", "--url", "http://127.0.0.1:1")
        self.assertEqual(refused.returncode, 2, refused.stderr)

    @unittest.skipUnless(shutil.which("curl") and shutil.which("jq"), "needs curl and jq")
    def test_the_shell_example_plans_the_request_of_a_file(self):
        self.assert_solved(run("bash", EXAMPLES / "plan.sh", REQUEST, self.url))

    @unittest.skipUnless(shutil.which("curl") and shutil.which("jq"), "needs curl and jq")
    def test_the_shell_example_tells_what_is_wrong(self):
        with tempfile.NamedTemporaryFile("w", suffix=".json") as file:
            file.write('{"map": {"rows": ["..#"]}, "robots": [{"id": "a"}]}')
            file.flush()
            done = run("bash", EXAMPLES / "plan.sh", file.name, self.url)
        self.assertEqual(done.returncode, 2)
        self.assertIn("/robots/0", done.stderr)

    def test_the_examples_tell_that_an_answer_is_none(self):
        commands = [[sys.executable, "-B", EXAMPLES / "plan.py", "--url"]]
        if shutil.which("curl") and shutil.which("jq"):
            commands.append(["bash", EXAMPLES / "plan.sh", REQUEST])
        for answer in (b"HTTP/1.1 200 OK\r\nContent-Length: 6\r\n\r\n<html>", b"HTTP/1.1 502 x\r\nContent-Length: 6\r\n\r\n<html>",
                       b"HTTP/1.1 200 OK\r\nContent-Length: 600\r\n\r\n{", b"HTTP/1.1 200 OK\r\nContent-Length: 2\r\n\r\n{}",
                       b"HTTP/1.1 200 OK\r\nContent-Length: 2\r\n\r\n[]", b"HTTP/1.1 503 x\r\nContent-Length: 0\r\n\r\n",
                       b"HTTP/1.1 200 OK\r\nContent-Length: 0\r\n\r\n", b"", b"x"):
            for command in commands:
                with self.subTest(answer=answer, command=command), answering(answer) as url:
                    done = run(*command, url)
                    self.assertEqual(done.returncode, 2, done.stdout)
                    self.assertNotIn("Traceback", done.stderr)
                    self.assertNotEqual(done.stderr, "")

    def test_the_examples_give_up_a_silent_server(self):
        with tempfile.NamedTemporaryFile("w", suffix=".json") as file, socket.create_server(("127.0.0.1", 0)) as silent:
            file.write('{"options": {"time_budget_ms": 10}}')
            file.flush()
            url = f"http://127.0.0.1:{silent.getsockname()[1]}"
            self.assertEqual(run(sys.executable, "-B", EXAMPLES / "plan.py", file.name, "--url", url).returncode, 2)
            if shutil.which("curl") and shutil.which("jq"):
                self.assertEqual(run("bash", EXAMPLES / "plan.sh", file.name, url).returncode, 2)


@contextlib.contextmanager
def answering(answer):
    """The URL of a server that answers one request with these bytes, and ends the connection."""
    with socket.create_server(("127.0.0.1", 0)) as listener:
        def serve():
            connection, _ = listener.accept()
            with connection:
                received = b""
                while b"\r\n\r\n" not in received:
                    received += connection.recv(1 << 16)
                head, _, body = received.partition(b"\r\n\r\n")
                length = int(re.search(rb"(?i)content-length: (\d+)", head).group(1))
                while len(body) < length:
                    body += connection.recv(1 << 16)
                connection.sendall(answer)
        thread = threading.Thread(target=serve)
        thread.start()
        yield f"http://127.0.0.1:{listener.getsockname()[1]}"
        thread.join()


if __name__ == "__main__":
    BINARY = sys.argv.pop(1)
    unittest.main()
