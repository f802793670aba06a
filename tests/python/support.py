"""What the tests of the Python client share: a server of this build, a server that answers as told, and a replay."""

import contextlib
import http.server
import os
import pathlib
import re
import subprocess
import sys
import threading

PROJECT = pathlib.Path(__file__).resolve().parent.parent.parent
PACKAGE = PROJECT / "clients/python"
BINARY = os.environ.get("FLEETPLAN_BIN", str(PROJECT / "build/release/server/fleetplan"))
sys.path[:0] = [str(PACKAGE), str(PROJECT / "tests/motion")]

from execution_test import overlaps  # noqa: E402
from replay import Walls  # noqa: E402


@contextlib.contextmanager
def service(program=BINARY, **environment):
    """The URL of a server, by default of this build."""
    server = subprocess.Popen([program, "--port", "0", "--log-level", "off"], stdout=subprocess.PIPE, text=True,
                              env={**os.environ, **environment})
    try:
        yield re.search(r"http://\S+", server.stdout.readline()).group()
    finally:
        server.terminate()
        server.wait()
        server.stdout.close()


class Answers:
    """A server that gives these answers one after the other, and keeps what it was asked."""

    def __init__(self, *answers):
        """An answer is (status, header fields, body), or None to end the connection without one."""
        self.answers = list(answers)
        self.requests = []  # (method, path, header fields, body, port of the client)
        told = self

        class Handler(http.server.BaseHTTPRequestHandler):
            protocol_version = "HTTP/1.1"

            def answer(self):
                body = self.rfile.read(int(self.headers.get("Content-Length", 0)))
                told.requests.append((self.command, self.path, dict(self.headers), body, self.client_address[1]))
                answer = told.answers.pop(0)
                if answer is None:
                    self.close_connection = True
                    return
                status, fields, text = answer
                self.send_response(status)
                for name, value in {"Content-Length": str(len(text)), **fields}.items():
                    if value is not None:
                        self.send_header(name, value)
                with contextlib.suppress(BrokenPipeError):  # a client that has given up
                    self.end_headers()
                    self.wfile.write(text)

            do_GET = do_POST = answer

            def log_message(self, *_):
                pass

        self.server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        self.server.daemon_threads = True
        self.url = f"http://127.0.0.1:{self.server.server_address[1]}"
        self.thread = threading.Thread(target=self.server.serve_forever, args=(0.01,))

    def __enter__(self):
        self.thread.start()
        return self

    def __exit__(self, *_):
        self.server.shutdown()
        self.thread.join()
        self.server.server_close()


def met(request, fleet):
    """The pairs of robots that have overlapped, and by how much; and the robots that have overlapped a wall."""
    trace = {robot: [[leg.t_start, leg.t_end, leg.begin["x"], leg.begin["y"], leg.end["x"], leg.end["y"]]
                     for leg in legs] for robot, legs in fleet.legs.items()}
    walls = Walls(request["map"])
    hit = [robot["id"] for robot in request["robots"] if any(
        walls.clearance(*leg[2:], radius) < radius - 1e-5
        for radius in [{**request.get("robot_defaults", {}), **robot}["radius"]]
        for leg in trace[robot["id"]] if leg[2:4] != leg[4:6])]
    return overlaps(request, trace), hit
