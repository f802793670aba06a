#!/usr/bin/env python3
"""Sends requests on several connections until SIGTERM or for `--seconds`, and checks every response. Prints one
line of JSON: the number of requests, the failures by kind, the rate, the latencies. With `--again N`, up to N
requests that got no response, or 502 from the balancer, are sent again once, as clients may.

Exit code 0 if no request failed, 1 otherwise.
"""

import argparse
import collections
import json
import pathlib
import signal
import sys
import threading
import time

TESTS = pathlib.Path(__file__).resolve().parent.parent.parent / "tests"
sys.path.insert(0, str(TESTS / "soak"))

from client import Connection, Lost, request  # noqa: E402


def hall(side, robots):
    """A request to plan: an empty hall of side x side cells, one byte each, whose robots change sides."""
    fleet = [{"id": f"r{i}", "start": {"x": 0.5, "y": i + 0.5}, "goal": {"x": side - 0.5, "y": robots - i - 0.5}}
             for i in range(robots)]
    return {"map": {"rows": ["." * side] * side}, "robots": fleet,
            "robot_defaults": {"radius": 0.3, "linear_speed": 1.0, "angular_speed": 2.0}}


def posted(path, body):
    return request("POST", path, json.dumps(body).encode())


def scenario(name):
    return posted("/v1/plan", json.loads((TESTS / "scenarios" / f"{name}.json").read_text()))


END_SIGNALS = {signal.SIGTERM, signal.SIGINT}

KINDS = {
    "get": lambda: request("GET", "/v1/limits"),
    "1kB": lambda: posted("/v1/plan", hall(20, 5)),
    "60kB": lambda: posted("/v1/plan", hall(240, 5)),
    "1MB": lambda: posted("/v1/plan", hall(1000, 5)),
    "hall-100": lambda: scenario("hall-100"),
}


class Load:
    def __init__(self, host, port, kinds, again):
        self.host, self.port, self.again = host, port, again
        self.requests = {kind: KINDS[kind]() for kind in kinds}
        self.ended = threading.Event()
        self.lock = threading.Lock()
        self.failures = collections.Counter()
        self.sent_again = 0
        self.seconds = {kind: [] for kind in kinds}

    def fault_of(self, answer, kind):
        """A description of what is wrong with an answer, or None."""
        if answer.status != 200:
            return f"{kind}: status {answer.status}"
        content = answer.json()
        if kind != "get" and content["status"] != "solved":
            return f"{kind}: {content['status']}"
        return None

    def ask_once(self, connection, kind):
        """An answer that is not the balancer's own; otherwise raises."""
        try:
            connection.send(self.requests[kind])
            answer = connection.receive()
        except (Lost, OSError):
            connection.close()
            raise
        if answer.status == 502:
            raise Lost("status 502")
        return answer

    def may_send_again(self):
        with self.lock:
            self.sent_again += 1
            return self.sent_again <= self.again

    def ask(self, connection, kind):
        """Sends a request; returns what failed, or None."""
        try:
            try:
                answer = self.ask_once(connection, kind)
            except (Lost, OSError):
                if not self.may_send_again():
                    raise
                answer = self.ask_once(connection, kind)
            return self.fault_of(answer, kind)
        except (Lost, OSError, ValueError) as error:
            return f"{kind}: {error}"

    def send_requests(self, offset):
        connection = Connection(self.host, self.port)
        kinds = list(self.requests)
        turn = offset
        while not self.ended.is_set():
            kind = kinds[turn % len(kinds)]
            begun = time.monotonic()
            fault = self.ask(connection, kind)
            elapsed = time.monotonic() - begun
            turn += 1
            if turn % 20 == 0:
                connection.close()  # as clients that reconnect
            with self.lock:
                self.seconds[kind].append(elapsed)
                if fault:
                    self.failures[fault] += 1
        connection.close()

    def run(self, connections, seconds):
        threads = [threading.Thread(target=self.send_requests, args=(i,)) for i in range(connections)]
        begun = time.monotonic()
        for thread in threads:
            thread.start()
        signal.sigtimedwait(END_SIGNALS, seconds)
        self.ended.set()
        for thread in threads:
            thread.join()
        return self.summary(time.monotonic() - begun)

    def summary(self, elapsed):
        latencies = sorted(s for of_kind in self.seconds.values() for s in of_kind)
        at = lambda share: round(1000 * latencies[int(share * (len(latencies) - 1))], 1) if latencies else None
        return {"requests": {kind: len(of_kind) for kind, of_kind in self.seconds.items()},
                "failed": sum(self.failures.values()), "failures": dict(self.failures.most_common(10)),
                "sent_again": self.sent_again,
                "per_second": round(len(latencies) / elapsed, 1), "seconds": round(elapsed, 1),
                "ms": {"median": at(0.5), "p99": at(0.99), "longest": at(1)}}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--host", default="127.0.0.1")
    parser.add_argument("--port", type=int, required=True)
    parser.add_argument("--connections", type=int, default=6)
    parser.add_argument("--seconds", type=float, default=600.0)
    parser.add_argument("--kinds", default="get,1kB,60kB", help=f"of {', '.join(KINDS)}")
    parser.add_argument("--again", type=int, default=0, help="number of requests that may be sent again")
    options = parser.parse_args()
    load = Load(options.host, options.port, options.kinds.split(","), options.again)
    signal.pthread_sigmask(signal.SIG_BLOCK, END_SIGNALS)
    summary = load.run(options.connections, options.seconds)
    print(json.dumps(summary))
    return 0 if summary["failed"] == 0 and all(summary["requests"].values()) else 1


if __name__ == "__main__":
    sys.exit(main())
