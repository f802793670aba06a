#!/usr/bin/env python3
"""Sends a server more requests than it can answer.

Usage: overload.py [--binary FLEETPLAN | --url URL] [--seconds N] [--times N]

Measures how many plans per second the server returns, sends four times as many for a minute at a steady rate, and then
measures how it recovers. The exit status is 1 if

- an answer was wrong or lost,
- an accepted request exceeded its budget,
- a rejection took 50 ms (the 99th percentile) or had no Retry-After,
- or the server did not return to its usual latency at once.

Then the cases of fair.py: clients that compete for the workers.
"""

import argparse
import asyncio
import json
import multiprocessing
import re
import sys
import time

import fair
import workload
from client import Connection, request
from report import percentile, spread, verdict
from server import Server

SCENARIO = "hall-100"
BUDGET_MS = 1000
REJECTION_MS = 50.0
SLACK_MS = 100.0  # for sending, waking up and reading, which only the client's time includes
MAX_IDLE_S = 0.5


def posted():
    instance = workload.scenarios()[SCENARIO]
    instance["options"]["time_budget_ms"] = BUDGET_MS
    return request("POST", "/v1/plan", json.dumps(instance).encode())


class Load:
    """Requests at a steady rate from one process, on as many connections as are needed."""

    def __init__(self, host, port):
        self.address, self.data = (host, port), posted()
        self.idle = []      # connections and the time of their last use
        self.answers = []   # latency in seconds, status, milliseconds in the service or None
        self.faults = []

    async def offer(self, rate, seconds):
        loop, begin, tasks = asyncio.get_running_loop(), time.monotonic(), []
        for index in range(int(rate * seconds)):
            await asyncio.sleep(max(0.0, begin + index / rate - time.monotonic()))
            tasks.append(loop.create_task(self.ask(begin + index / rate)))
        await asyncio.gather(*tasks)

    async def ask(self, due):
        try:
            status, service_ms = await asyncio.wait_for(self.exchange(), 60)
            self.answers.append((time.monotonic() - due, status, service_ms))
        except (OSError, asyncio.TimeoutError, asyncio.IncompleteReadError, ValueError) as fault:
            self.faults.append(f"{type(fault).__name__} {fault}")

    async def exchange(self):
        while self.idle and time.monotonic() - self.idle[-1][2] > MAX_IDLE_S:
            self.idle.pop()[1].close()
        reader, writer = self.idle.pop()[:2] if self.idle else await asyncio.open_connection(*self.address, limit=1 << 20)
        writer.write(self.data)
        head = (await reader.readuntil(b"\r\n\r\n")).decode("latin-1")
        status = int(head.split(" ", 2)[1])
        body = await reader.readexactly(int(re.search(r"(?i)\r\ncontent-length: (\d+)", head).group(1)))
        if "\r\nConnection: close" in head:
            writer.close()
        else:
            self.idle.append((reader, writer, time.monotonic()))
        if status == 503 and not re.search(r"(?i)\r\nretry-after: [1-9]", head):
            raise ValueError("503 without Retry-After")
        total = re.search(rb'"total":\s*([0-9.e+-]+)', body) if status == 200 else None
        return status, float(total.group(1)) if total else None


def run_process(host, port, rate, seconds, results):
    load = Load(host, port)
    asyncio.run(load.offer(rate, seconds))
    results.put((load.answers, load.faults))


def offer(server, rate, seconds, processes):
    """Answers and faults of an open loop, which sends at its rate whether or not answers arrive."""
    results = multiprocessing.Queue()
    children = [multiprocessing.Process(target=run_process,
                                        args=(server.host, server.port, rate / processes, seconds, results))
                for _ in range(processes)]
    for child in children:
        child.start()
    parts = [results.get(timeout=seconds + 300) for _ in children]
    for child in children:
        child.join()
    return [a for answers, _ in parts for a in answers], [f for _, faults in parts for f in faults]


def closed_loop(host, port, seconds, results):
    connection, data, times, until = Connection(host, port), posted(), [], time.monotonic() + seconds
    while time.monotonic() < until:
        begin = time.monotonic()
        connection.send(data)
        if connection.receive().status == 200:
            times.append(time.monotonic() - begin)
    results.put(times)


def capacity(server, workers, seconds):
    """Plans per second with two clients per worker, each of which sends its next request after an answer."""
    results = multiprocessing.Queue()
    children = [multiprocessing.Process(target=closed_loop, args=(server.host, server.port, seconds, results))
                for _ in range(2 * workers)]
    for child in children:
        child.start()
    count = sum(len(results.get(timeout=seconds + 60)) for _ in children)
    for child in children:
        child.join()
    return count / seconds


def one_by_one(server, count):
    """Latencies of a single client."""
    connection, data, times = Connection(server.host, server.port), posted(), []
    for _ in range(count):
        begin = time.monotonic()
        connection.send(data)
        status = connection.receive().status
        times.append(time.monotonic() - begin if status == 200 else float("inf"))
    connection.close()
    return times


def ms(values):
    if not values:
        return "none"
    p50, p99, most = (1000 * value for value in spread(values))
    return f"p50 {p50:8.1f} ms   p99 {p99:8.1f} ms   max {most:8.1f} ms"


def main():
    parser = argparse.ArgumentParser(description="Sends a server more requests than it can answer.")
    parser.add_argument("--binary", help="the server to start and to measure")
    parser.add_argument("--url", help="a server that is already running")
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--times", type=float, default=4.0, help="the load as a multiple of the capacity")
    parser.add_argument("--processes", type=int, default=2, help="number of client processes")
    arguments = parser.parse_args()
    server = Server(arguments.binary, arguments.url)
    workers = server.get("/v1/limits")["workers"]

    one_by_one(server, 10)
    usual = one_by_one(server, 100)
    print(f"{SCENARIO}, budget {BUDGET_MS} ms; alone     {ms(usual)}")
    rate = capacity(server, workers, 10.0)
    print(f"capacity: {rate:.0f} plans per second with {workers} workers; sending {arguments.times * rate:.0f} per second")
    answers, faults = offer(server, arguments.times * rate, arguments.seconds, arguments.processes)
    after = one_by_one(server, 20)

    accepted = [answer for answer in answers if answer[1] == 200]
    rejected = [seconds for seconds, status, _ in answers if status == 503]
    others = len(answers) - len(accepted) - len(rejected)
    print(f"sent {len(answers) + len(faults)}: {len(accepted)} accepted ({len(accepted) / arguments.seconds:.0f} per second), "
          f"{len(rejected)} rejected, {others} others, {len(faults)} lost")
    print(f"accepted, latency of the client   {ms([a[0] for a in accepted])}")
    print(f"accepted, by timings_ms.total     {ms([a[2] / 1000 for a in accepted])}")
    print(f"rejected                          {ms(rejected)}")
    print(f"the next 20 requests              {ms(after)}   the first {1000 * after[0]:.1f} ms")

    failures = [f"lost: {fault}" for fault in faults[:5]]
    if others or faults:
        failures.append(f"{others} answers with another status, {len(faults)} lost")
    if over := sum(1 for a in accepted if a[2] > BUDGET_MS):
        failures.append(f"{over} accepted requests exceeded their budget")
    if over := sum(1 for a in accepted if 1000 * a[0] > BUDGET_MS + SLACK_MS):
        failures.append(f"{over} accepted requests reached the client after their budget")
    if rejected and 1000 * percentile(rejected, 0.99) >= REJECTION_MS:
        failures.append("rejections were slow")
    if percentile(after, 0.5) > 2 * percentile(usual, 0.5) or after[0] > 2 * max(usual):
        failures.append("the server did not recover at once")
    failures += fair.cases(server, arguments.seconds / 2)
    if code := server.end():
        failures.append(f"the server ended with {code}")
    return verdict(failures)


if __name__ == "__main__":
    sys.exit(main())
