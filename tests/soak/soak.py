#!/usr/bin/env python3
"""Keeps a server saturated with good, bad, cancelled, slow and huge requests, and checks every answer.

Usage: soak.py [--binary FLEETPLAN | --url URL] [--minutes N] [--costly]

Prints a table. The exit status is 1 if

- an answer was wrong or lost,
- the server ended,
- or its resident memory grew by more than 5 % after the first minute.

Memory is measured in a pause of all clients after each round of a minute. Maps that are kept for later requests do not
count, because they depend on the last requests, up to --map-cache.
"""

import argparse
import collections
import multiprocessing
import sys
import time

from clients import COSTLY, KINDS, run_process
from costly import costly_requests
from report import spread, verdict
from server import Server

ROUND_S = 60.0
PAUSE_S = 6.0  # the server returns unused memory to the system every five seconds
MAX_GROWTH = 0.05
MAX_LISTED = 10


def run_round(server, arguments, seed, limits, seconds, costly):
    """Runs all clients for this time; returns their records."""
    results = multiprocessing.Queue()
    processes = [multiprocessing.Process(target=run_process, args=(
        server.host, server.port, seed * 1000 + index, arguments.connections, limits, seconds, costly, results))
        for index in range(arguments.processes)]
    for process in processes:
        process.start()
    records = [results.get(timeout=seconds + 300) for _ in processes]
    for process in processes:
        process.join()
    return records


def print_report(records, seconds):
    sent, statuses, latencies = collections.Counter(), collections.Counter(), collections.defaultdict(list)
    for record in records:
        sent.update(record.sent)
        statuses.update(record.statuses)
        for kind, values in record.latencies.items():
            latencies[kind] += values
    print(f"\n{'kind':12} {'sent':>9} {'answers':>9} {'p50 ms':>9} {'p99 ms':>9} {'max ms':>9}   (without 503)")
    for kind in [*KINDS, *COSTLY, "validate"]:
        values = latencies[kind]
        times = [1000 * value for value in spread(values)] if values else []
        print(f"{kind:12} {sent[kind] or '':>9} {len(values):>9} " + " ".join(f"{time_:9.1f}" for time_ in times))
    print("\nstatuses: " + ", ".join(f"{status}: {count}" for status, count in sorted(statuses.items())))
    print(f"{sum(statuses.values())} answers in {seconds:.0f} s, {sum(statuses.values()) / seconds:.0f} per second; "
          f"{sum(record.validated for record in records)} plans validated")


def main():
    parser = argparse.ArgumentParser(description="Keeps a server saturated and checks every answer.")
    parser.add_argument("--binary", help="the server to start and to measure")
    parser.add_argument("--url", help="a server that is already running")
    parser.add_argument("--minutes", type=float, default=30.0)
    parser.add_argument("--processes", type=int, default=4, help="number of client processes")
    parser.add_argument("--connections", type=int, default=8, help="connections of each process")
    parser.add_argument("--costly", action="store_true", help="mix in requests that cost the server much")
    parser.add_argument("--seed", type=int, default=int(time.time()), help="of the random requests")
    arguments = parser.parse_args()
    if not arguments.binary and not arguments.url:
        parser.error("--binary or --url is required")

    # A connection may be idle while its client, on a busy machine, waits for the answers of others.
    server = Server(arguments.binary, arguments.url, ["--idle-timeout-ms", "600000"])
    print(f"seed {arguments.seed}, {arguments.processes} x {arguments.connections} connections, {server.url}")
    memory, kept_maps = [server.resident_kib()], [0.0]
    limits = server.get("/v1/limits")
    costly = costly_requests() if arguments.costly else []
    records, begin = [], time.monotonic()
    end = begin + 60.0 * arguments.minutes
    failures = []
    while (left := end - time.monotonic()) > 1.0 and not failures:
        records += run_round(server, arguments, arguments.seed + len(memory), limits, min(left, ROUND_S), costly)
        time.sleep(PAUSE_S)
        memory.append(server.resident_kib())
        kept_maps.append(server.kept_maps_kib() if memory[-1] else 0.0)
        print(f"{time.monotonic() - begin:7.0f} s  {sum(sum(r.statuses.values()) for r in records):9} answers"
              + (f"  {memory[-1] / 1024:7.1f} MiB, {kept_maps[-1] / 1024:.1f} of them kept maps" if memory[-1] else ""),
              flush=True)
        if not server.alive():
            failures.append("the server ended")
    print_report(records, time.monotonic() - begin)

    if memory[-1]:
        growth = (memory[-1] - kept_maps[-1]) / (memory[1] - kept_maps[1]) - 1
        print(f"resident memory: {memory[0] / 1024:.1f} MiB at the start, {memory[1] / 1024:.1f} MiB after the first round, "
              f"{memory[-1] / 1024:.1f} MiB at the end ({100 * growth:+.1f} % without kept maps), "
              f"{server.peak_kib() / 1024:.1f} MiB at most")
        if len(memory) > 2 and growth > MAX_GROWTH:
            failures.append(f"resident memory grew by {100 * growth:.1f} %")
    if code := server.end():
        failures.append(f"the server ended with {code}")
    wrong = [each for record in records for each in record.wrong]
    lost = [each for record in records for each in record.lost]
    print(f"wrong answers: {len(wrong)}, lost answers: {len(lost)}")
    for kind, faults in (("wrong", wrong), ("lost", lost)):
        for fault, times in collections.Counter(faults).most_common(MAX_LISTED):
            print(f"  {kind}, {times} x {fault}")
    if wrong or lost:
        failures.append("answers were wrong or lost")
    return verdict(failures)


if __name__ == "__main__":
    sys.exit(main())
