#!/usr/bin/env python3
"""Runs fleetplan_lifelong, which simulates running warehouses, and reports what it measures; scripts/bench --lifelong
builds and starts both.

Usage: lifelong.py PROGRAM [ARGUMENTS of scripts/bench --lifelong...]
"""

import argparse
import csv
import json
import pathlib
import subprocess
import sys

import markdown
from arguments import between, json_object, robot_counts
from markdown import decimal

LARGE_FLEET = 100  # robots; from then on in the large warehouse
SMALL, LARGE = [3, 8], [10, 20]  # columns and rows of shelves
STRATEGIES = {
    "stop the world": {"strategy": "stop"},
    "snapshots": {"strategy": "snapshots"},
    "snapshots, start_safe_interval 0": {"strategy": "snapshots", "options": {"start_safe_interval": 0}},
    "snapshots, 1 s to stop and restart": {"strategy": "snapshots", "halt": 1.0,
                                           "options": {"start_safe_interval": 0}},
    "committed": {"strategy": "committed", "options": {"replan": "where_needed"}},
    "committed, horizon": {"strategy": "committed", "options": {"horizon": 20}},
    "committed, improved": {"strategy": "committed", "options": {"mode": "anytime", "max_iterations": 40}},
}
NOTES = """\
"of bound": throughput over that of as many robots that are each alone in the warehouse. "waiting": share of the
robots' time. "changed": of the robots under way, those that a plan gave other moves. "late": plans that took longer
than their budget.
"""


def strategies(text):
    """Names of strategies, or their beginnings, separated by semicolons."""
    chosen = [name for name in STRATEGIES if any(name.startswith(part.strip()) for part in text.split(";"))]
    if not chosen:
        raise argparse.ArgumentTypeError(f"'{text}' is not a choice of {'; '.join(STRATEGIES)}")
    return chosen


def make_parser():
    parser = argparse.ArgumentParser(
        prog="scripts/bench --lifelong", allow_abbrev=False,
        description="Simulates a running warehouse: each robot gets a new random goal beside a shelf after 2 s of "
                    "service, and a plan is made whenever a robot is free. Planning's real time passes on the simulated "
                    "clock.")
    add = parser.add_argument
    add("--seconds", type=between(1.0, 86_400.0, float), default=3600.0, help="simulated time; default 3600")
    add("--robots", type=robot_counts, default=[20, 40, 80, 150], metavar="LIST",
        help=f"default 20,40,80,150; {LARGE_FLEET} or more drive in a warehouse of 10 x 20 shelves, fewer in that of the "
             "examples")
    add("--strategies", type=strategies, default=list(STRATEGIES), metavar="NAMES",
        help="separated by semicolons: " + "; ".join(STRATEGIES))
    add("--seed", type=int, default=1)
    add("--budget", type=between(0.001, 120.0, float), metavar="SECONDS",
        help="time budget of a plan; default 0.1, or 0.3 in the large warehouse")
    add("--commit", type=between(0.001, 120.0, float), metavar="SECONDS",
        help="time for which robots go on while a plan is made; default: the budget")
    add("--options", type=json_object, default={}, metavar="JSON", help="more options of the requests")
    add("--clock", choices=["wall", "cpu", "none"], default="wall",
        help="cpu: only the CPU time of planning passes on the simulated clock, as if nothing else ran; none: planning "
             "takes no time")
    add("--output", metavar="FOLDER", default=".", help="folder for the CSV file")
    add("--csv", metavar="FILE", help="write the results to this file instead")
    add("--read", metavar="FILE", help="report this CSV file instead of measuring")
    return parser


def parse(words):
    arguments = make_parser().parse_args(words)
    arguments.csv = arguments.csv or str(pathlib.Path(arguments.output, "lifelong.csv"))
    return arguments


def make_job(name, robots, arguments):
    """See tests/bench/lifelong/lifelong_job.h."""
    is_large = robots >= LARGE_FLEET
    budget = arguments.budget or (0.3 if is_large else 0.1)
    strategy = STRATEGIES[name]
    return {"name": name, "strategy": strategy["strategy"], "shelves": LARGE if is_large else SMALL, "robots": robots,
            "seconds": arguments.seconds, "seed": arguments.seed, "budget_ms": round(1000 * budget),
            "commit": arguments.commit or budget, "halt": strategy.get("halt", 0.0), "clock": arguments.clock,
            "options": {**strategy.get("options", {}), **arguments.options}}


def measure(program, arguments):
    """Writes every row to the CSV file as soon as it arrives."""
    jobs = [make_job(name, robots, arguments) for robots in arguments.robots for name in arguments.strategies]
    pathlib.Path(arguments.csv).parent.mkdir(parents=True, exist_ok=True)
    with open(arguments.csv, "w", encoding="utf-8") as file:
        for index, job in enumerate(jobs):
            made = subprocess.run([program], input=json.dumps(job) + "\n", stdout=subprocess.PIPE, text=True, check=False)
            if made.returncode != 0:
                raise ValueError("the measurement failed")
            header, row = made.stdout.splitlines(keepends=True)
            file.write(row if index else header + row)
            file.flush()


def read(file):
    with open(file, encoding="utf-8", newline="") as lines:
        return list(csv.DictReader(lines))


def share(text):
    return decimal(100 * float(text), 1) + " %"


def milliseconds(text):
    return decimal(1000 * float(text), 0)


def report(rows):
    head = ["strategy", "robots", "of bound", "tasks per robot-hour", "waiting", "plans", "changed", "median ms",
            "99 % ms", "longest ms", "budget ms", "late", "unplanned"]
    return markdown.table(head, [
        [row["name"], row["robots"], decimal(float(row["of_bound"]), 3), decimal(float(row["tasks_per_hour"]), 1),
         share(row["waiting"]), row["replans"], share(row["changed"]), milliseconds(row["median_s"]),
         milliseconds(row["p99_s"]), milliseconds(row["longest_s"]), milliseconds(row["budget_s"]), row["late"],
         row["unplanned"]] for row in rows]) + "\n" + NOTES


def main(program, words):
    arguments = parse(words)
    try:
        if not arguments.read:
            measure(program, arguments)
        rows = read(arguments.read or arguments.csv)
    except (OSError, ValueError) as error:
        print(f"bench: {error}", file=sys.stderr)
        return 1
    print(report(rows), end="")
    return 0 if all(int(row["valid"]) for row in rows) else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2:]))
