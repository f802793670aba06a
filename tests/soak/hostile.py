#!/usr/bin/env python3
"""Measures the effect of hostile clients on honest ones.

Usage: hostile.py [--binary FLEETPLAN | --url URL] [--seconds N] [--late-ms N]

Measures small plans of one honest client alone, then beside each kind of hostile client in turn. Meanwhile, probes
health on the admin port (not with --url). The exit status is 1 if

- an honest answer was wrong, lost or, in the median, more than twice as slow as alone and slower than 25 ms,
- too many requests were rejected with 503,
- a health probe failed,
- or the server ended or used more than 1 GiB.

Then sends requests that are costly for the server. Each must get the right answer, within its time and its memory. No
work may go on after the client has left. Last, checks that servers survive a log that nobody reads and a lack of
descriptors, and that a server whose listener breaks ends.
"""

import argparse
import contextlib
import gzip
import http.client
import json
import multiprocessing
import os
import resource
import socket
import sys
import threading
import time
import urllib.request

import costly
import front_door
from client import Connection, Lost, request
from report import percentile, spread, verdict
from server import Server

MAX_SLOWDOWN = 2.0
FAST_MS = 25.0  # the kernel's part of an attack, on the same machine, takes CPU from an answer of a millisecond
MAX_REJECTED = 0.1
HEALTH_TIMEOUT_S = 5.0
MAX_MEMORY_KIB = 1 << 20

HONEST = {"map": {"rows": ["......"] * 4}, "robots": [
    {"id": "a", "start": {"x": 0.5, "y": 0.5}, "goal": {"x": 5.5, "y": 0.5}},
    {"id": "b", "start": {"x": 5.5, "y": 0.5}, "goal": {"x": 0.5, "y": 0.5}}],
    "robot_defaults": {"radius": 0.3, "linear_speed": 1.0, "angular_speed": 2.0}}
POST = b"POST /v1/plan HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n"


class Attackers:
    """A process with `count` sockets, each used by its own thread until the process is killed. On this machine, they have
    an address of their own, as the server shares its time among addresses."""

    def __init__(self, address, count, act):
        self.process = multiprocessing.Process(target=self._run, args=(address, count, act), daemon=True)

    @staticmethod
    def _run(address, count, act):
        _, most = resource.getrlimit(resource.RLIMIT_NOFILE)
        resource.setrlimit(resource.RLIMIT_NOFILE, (most, most))
        threading.stack_size(256 * 1024)
        os.nice(10)  # they would be on other machines, and take no CPU time from the server
        source = ("127.0.0.2", 0) if address[0] == "127.0.0.1" else None

        def attack():
            while True:
                with contextlib.suppress(OSError):
                    with socket.create_connection(address, 10, source) as socket_:
                        act(socket_)
                time.sleep(0.01)
        for _ in range(count):
            threading.Thread(target=attack, daemon=True).start()
        threading.Event().wait()

    def __enter__(self):
        self.process.start()

    def __exit__(self, *_):
        self.process.kill()
        self.process.join()


class Health:
    """Probes health on the admin port, on a new connection each time, as orchestrators do."""

    def __init__(self, server):
        self.url, self.times, self.faults, self.ending = server.admin_url, [], [], threading.Event()
        self.thread = threading.Thread(target=self._probe, daemon=True)

    def _probe(self):
        while not self.ending.wait(0.05):
            begin = time.monotonic()
            try:
                with urllib.request.urlopen(self.url + "/healthz", timeout=HEALTH_TIMEOUT_S) as response:
                    response.read()
                self.times.append(1000 * (time.monotonic() - begin))
            except (OSError, http.client.HTTPException) as fault:
                self.faults.append(str(fault))

    def worst(self):
        return f"{max(self.times):10.2f}" if self.times else f"{'-':>10}"

    def __enter__(self):
        if self.url:
            self.thread.start()
        return self

    def __exit__(self, *_):
        self.ending.set()
        if self.url:
            self.thread.join()
            if not self.times and not self.faults:
                self.faults.append("no probe was sent")


def idle(socket_):
    """Sends nothing until the server closes the connection."""
    socket_.settimeout(60)
    socket_.recv(1)


def read_until_closed(socket_):
    """Reads until the server closes the connection."""
    socket_.settimeout(5)
    with contextlib.suppress(OSError):
        while socket_.recv(1 << 16):
            pass


def drip(data, pause):
    """Sends a head or a body byte by byte, with a pause in seconds after each."""
    def act(socket_):
        for at in range(len(data)):
            socket_.sendall(data[at:at + 1])
            time.sleep(pause)
    return act


def drip_rest(begin, data, pause):
    """The same after a beginning that is sent at once."""
    def act(socket_):
        socket_.sendall(begin)
        drip(data, pause)(socket_)
    return act


def send_and_read(data):
    def act(socket_):
        socket_.sendall(data)
        read_until_closed(socket_)
    return act


def flood(begin, data):
    """Sends the same without end after a beginning."""
    def act(socket_):
        socket_.sendall(begin)
        while True:
            socket_.sendall(data)
    return act


def send_and_leave(data):
    return lambda socket_: socket_.sendall(data)


def never_read(data):
    """Requests large answers and reads nothing of them."""
    def act(socket_):
        socket_.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        for _ in range(50):
            socket_.sendall(data)
        time.sleep(60)
    return act


def large_body():
    """Sends all of a large body except its end."""
    block = b" " * (1 << 20)

    def act(socket_):
        socket_.settimeout(2)
        socket_.sendall(POST + b"Content-Length: 33554432\r\n\r\n")
        for _ in range(31):
            socket_.sendall(block)
        time.sleep(60)
    return act


def half_closed(data):
    def act(socket_):
        socket_.sendall(data)
        socket_.shutdown(socket.SHUT_WR)
        read_until_closed(socket_)
    return act


def posted(body, *fields):
    return request("POST", "/v1/plan", body, fields)


def attacks():
    """Triples of name, number of sockets, and the function that each socket runs."""
    small = json.dumps(HONEST).encode()
    flat = gzip.compress(b" " * 33_000_000, 9)
    bomb = gzip.compress(bytes(1 << 30), 9)
    chunks = POST + b"Transfer-Encoding: chunked\r\n\r\n" + b"1\r\n[\r\n" * 200_000
    heads = b"GET / HTTP/1.1\r\nHost: localhost\r\n" + b"".join(b"X-%d: y\r\n" % i for i in range(5000)) + b"\r\n"
    streams = gzip.compress(json.dumps(HONEST).encode() + b" " * 4_000_000, 9)
    rough = costly.posted(costly.rough_way(options={"time_budget_ms": 500}), "/v1/simulate")
    masks = costly.posted(costly.mask_of_many_parts(), "/v1/advance")
    trace = costly.posted(costly.rough_way(options={"time_budget_ms": 3600}, trace=0), "/v1/simulate")
    ids = {**HONEST, "robots": [{**robot, "id": robot["id"] * 1_000_000} for robot in HONEST["robots"]]}
    return [
        ("500 idle sockets", 500, idle),
        ("3000 idle sockets", 3000, idle),
        ("3000 slow heads", 3000, drip(b"GET / HTTP/1.1\r\nHost: localhost\r\nX: " + b"y" * 1000, 3)),
        ("3000 slow bodies", 3000, drip_rest(POST + b"Content-Length: 1000\r\n\r\n", b" " * 1000, 3)),
        ("3000 slow readers", 3000, never_read(request("GET", "/v1/examples/hall-100"))),
        ("slow heads", 200, drip(b"GET / HTTP/1.1\r\nHost: localhost\r\nX: " + b"y" * 1000, 0.5)),
        ("slow empty lines", 200, drip(b"\r\n" * 1000, 0.5)),
        ("slow extensions of chunks", 200, drip_rest(POST + b"Transfer-Encoding: chunked\r\n\r\n1;", b"a" * 1000, 0.5)),
        ("slow trailers", 200, drip_rest(POST + b"Transfer-Encoding: chunked\r\n\r\n0\r\n", b"A: b\r\n" * 200, 0.5)),
        ("empty lines without end", 8, flood(b"", b"\r\n" * 8192)),
        ("empty lines after a request", 8, flood(request("GET", "/healthz"), b"\r\n" * 8192)),
        ("chunks of a byte without end", 8, flood(POST + b"Transfer-Encoding: chunked\r\n\r\n", b"0000000000000001\r\n \r\n" * 400)),
        ("slow bodies", 200, drip(POST + b"Content-Length: 1000\r\n\r\n" + b" " * 1000, 0.5)),
        ("a scheme as request target", 8, send_and_read(b"GET http HTTP/1.1\r\nHost: localhost\r\n\r\n")),
        ("header floods", 8, send_and_read(heads)),
        ("conflicting lengths", 8, send_and_read(POST + b"Content-Length: 1\r\nContent-Length: 2\r\n\r\nab")),
        ("negative lengths", 8, send_and_read(POST + b"Content-Length: -1\r\n\r\n")),
        ("huge lengths", 50, send_and_read(POST + b"Content-Length: 33554432\r\n\r\n")),
        ("60 unfinished 32 MB bodies", 60, large_body()),
        ("40 gzipped 32 MB bodies", 40, send_and_read(posted(flat, ("Content-Encoding", "gzip")))),
        ("one-byte chunks", 4, send_and_read(chunks)),
        ("gzip bombs, 1 MB for 1 GB", 2, send_and_read(posted(bomb, ("Content-Encoding", "gzip")))),
        ("deep JSON", 4, send_and_read(posted(b"[" * 1_000_000))),
        ("repeated keys, long pointer", 2, send_and_read(posted(b'{"' + b"k" * 500_000 + b'":{"a":0' + b',"a":0' * 50_000 + b"}}"))),
        ("1 MB ids", 4, send_and_read(posted(json.dumps(ids).encode()))),
        ("clients that never read", 50, never_read(request("GET", "/v1/examples/hall-100"))),
        ("60 answers that nobody reads", 60, never_read(trace)),
        ("1000 gzip streams at once", 1000, send_and_read(posted(streams, ("Content-Encoding", "gzip")))),
        ("4 simulations of rough ways", 4, send_and_read(rough)),
        ("4 masks of many parts", 4, send_and_read(masks)),
        ("4 matrices on large maps", 4, send_and_read(costly.posted(costly.travel_times_on_a_large_map(), "/v1/matrix"))),
        ("half-closed clients", 8, half_closed(posted(small))),
        ("disconnect after sending", 8, send_and_leave(posted(small))),
        ("500 requests at once", 4, send_and_read(request("GET", "/healthz") * 500)),
        ("connect and disconnect", 8, send_and_leave(b"")),
    ]


def honest_times(server, seconds):
    """The milliseconds of each plan of an honest client and the number of rejections; raises if one is wrong or lost."""
    connection, times, until = Connection(server.host, server.port, 20), [], time.monotonic() + seconds
    rejected = 0
    body = json.dumps(HONEST).encode()
    while time.monotonic() < until:
        begin = time.monotonic()
        connection.send(posted(body))
        answer = connection.receive()
        if answer.status == 503:
            rejected += 1
            time.sleep(0.01)
        elif answer.status != 200 or answer.json()["status"] != "solved":
            raise Lost(f"{answer.status}: {answer.body[:200]}")
        else:
            times.append(1000 * (time.monotonic() - begin))
        time.sleep(0.005)  # an honest client does not saturate the server
    connection.close()
    return times, rejected


def main():
    parser = argparse.ArgumentParser(description="Measures the effect of hostile clients on honest ones.")
    parser.add_argument("--binary", help="the server to start and to measure")
    parser.add_argument("--url", help="a server that is already running")
    parser.add_argument("--seconds", type=float, default=5.0, help="of each attack")
    parser.add_argument("--late-ms", type=float, default=100.0,
                        help="how late the answer to a costly request may be; more on a busy machine")
    arguments = parser.parse_args()
    server = Server(arguments.binary, arguments.url, ["--admin-port", "0"])
    failures = []
    print(f"{'beside':30} {'plans':>8} {'rejected':>8} {'p50 ms':>8} {'p99 ms':>8} {'max ms':>8} {'ratio':>7} {'MiB':>7} "
          f"{'health, ms':>10}")

    def judge(name, times, rejected, usual, health):
        """Prints a line of the table and adds failures."""
        p50, p99, most = spread(times)
        slower = p50 / usual
        print(f"{name:30} {len(times):8} {rejected:8} {p50:8.2f} {p99:8.2f} {most:8.2f} {slower:7.2f} "
              f"{(server.resident_kib() or 0) / 1024:7.1f} {health.worst()}", flush=True)
        if slower > MAX_SLOWDOWN and p50 > FAST_MS:
            failures.append(f"{name}: more than {MAX_SLOWDOWN} times slower, {p50:.1f} ms")
        if rejected > MAX_REJECTED * (len(times) + rejected):
            failures.append(f"{name}: {rejected} of {len(times) + rejected} were rejected")

    honest_times(server, 1.0)
    with Health(server) as health:
        alone, rejected = honest_times(server, arguments.seconds)
    usual = percentile(alone, 0.5)
    judge("no other client", alone, rejected, usual, health)
    for name, count, act in attacks():
        try:
            with Health(server) as health, Attackers((server.host, server.port), count, act):
                time.sleep(0.5)
                times, rejected = honest_times(server, arguments.seconds)
            if times:
                judge(name, times, rejected, usual, health)
            else:
                failures.append(f"{name}: every request was rejected")
            if health.faults:
                failures.append(f"{name}: {len(health.faults)} health probes failed, e.g. {health.faults[0]}")
        except (Lost, OSError) as fault:
            failures.append(f"{name}: {fault}")
            print(f"{name:30} {fault}")
        if not server.alive():
            failures.append(f"{name}: the server ended")
            break
    peak = server.peak_kib()
    if peak:
        print(f"{peak / 1024:.0f} MiB at most")
        if peak > MAX_MEMORY_KIB:
            failures.append("the server used more than 1 GiB")
    if code := server.end():
        failures.append(f"the server ended with {code}")
    failures += costly.measure(arguments.binary, arguments.url, arguments.late_ms)
    if arguments.binary:
        for name, check in front_door.CHECKS.items():
            fault = check(arguments.binary)
            print(f"{name:30} {fault or 'passed'}", flush=True)
            if fault:
                failures.append(f"{name}: {fault}")
    return verdict(failures)


if __name__ == "__main__":
    sys.exit(main())
