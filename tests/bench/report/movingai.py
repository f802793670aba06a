#!/usr/bin/env python3
"""The first robots of MovingAI scenarios; scripts/bench --movingai builds and starts this.

Usage: movingai.py PROGRAM [ARGUMENTS of scripts/bench --movingai...]
"""

import argparse
import dataclasses
import json
import pathlib
import statistics
import subprocess
import sys
import tempfile

import markdown

BAD_INPUT = 64  # the exit code of a command; smaller ones, but for 1, are of plans of all, some or no robots
FAILED = 1


@dataclasses.dataclass
class Outcome:
    map: str
    robots: int
    planned: int
    seconds: float  # of the request
    over_bound: float | None  # the costs of the planned robots over their lower bounds


def scenario_of(path):
    """The first scenario of a map, in the folder of the map."""
    found = sorted(path.parent.glob(f"{path.stem}-*.scen"))
    if not found:
        raise ValueError(f"{path}: there is no scenario {path.stem}-*.scen beside it")
    return found[0]


def run(command):
    ended = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)
    if ended.returncode in (FAILED, BAD_INPUT) or ended.returncode < 0:
        raise ValueError(ended.stderr.strip() or f"{command[0]} ended with {ended.returncode}")
    return ended.stdout


def outcome_of(name, answer):
    plans, left = answer["plans"], answer["unplanned"]
    bound = sum(plan["lower_bound"] for plan in plans)
    over_bound = sum(plan["cost"] for plan in plans) / bound if bound > 0 else None
    return Outcome(name, len(plans) + len(left), len(plans), answer["timings_ms"]["total"] / 1000.0, over_bound)


def measure(program, path, robots, options, workers, folder):
    """Plans as many robots of the first scenario of a map as there are, at most `robots`."""
    file = str(pathlib.Path(folder, "request.json"))
    run([program, "map2request", str(path), "--scenario", str(scenario_of(path)), "--count", str(robots), "-o", file])
    request = json.loads(pathlib.Path(file).read_text(encoding="utf-8"))
    request["options"] = options
    pathlib.Path(file).write_text(json.dumps(request), encoding="utf-8")
    flags = ["--quiet", "--workers", str(workers), "--max-budget-ms", str(int(options["time_budget_ms"]))]
    return outcome_of(path.stem, json.loads(run([program, "plan", file, *flags])))


def row_of(outcome):
    return [outcome.map, str(outcome.robots), str(outcome.planned), markdown.seconds(outcome.seconds),
            markdown.decimal(outcome.over_bound, 3)]


def summary(outcomes, robots):
    """What became of the fleets of a size, in a sentence."""
    solved = [each for each in outcomes if each.planned == each.robots]
    text = f"up to {robots} robots: {len(solved)} of {len(outcomes)} fleets planned whole"
    if solved:
        text += (f"; of these, seconds: median {markdown.seconds(statistics.median(each.seconds for each in solved))}, "
                 f"most {markdown.seconds(max(each.seconds for each in solved))}")
    return text


def main(program, words):
    parser = argparse.ArgumentParser(prog="scripts/bench --movingai", description="Maps and scenarios of MovingAI.")
    parser.add_argument("folder", type=pathlib.Path, help="of .map files, with their .scen files beside them")
    parser.add_argument("--output", help=argparse.SUPPRESS)
    parser.add_argument("--robots", default="100,300", help="the first robots of a scenario (default: 100,300)")
    parser.add_argument("--budget", type=float, default=60.0, help="seconds of a plan (default: 60)")
    parser.add_argument("--workers", type=int, default=1, help="threads of a plan (default: 1)")
    arguments = parser.parse_args(words)
    fleets = [int(each) for each in arguments.robots.split(",")]
    options = {"time_budget_ms": 1000.0 * arguments.budget}
    maps = sorted(arguments.folder.glob("*.map"))
    if not maps:
        print(f"{arguments.folder} has no .map file", file=sys.stderr)
        return 1
    outcomes = {robots: [] for robots in fleets}
    try:
        with tempfile.TemporaryDirectory() as folder:
            for path in maps:
                for robots in fleets:
                    print(f"{path.stem}, {robots} robots", file=sys.stderr)
                    outcomes[robots].append(
                        measure(program, path, robots, options, arguments.workers, folder))
    except ValueError as error:
        print(error, file=sys.stderr)
        return 1
    rows = [row_of(outcome) for several in zip(*outcomes.values()) for outcome in several]
    print(markdown.table(["map", "robots", "planned", "seconds", "cost over the bound"], rows))
    for robots, several in outcomes.items():
        print(summary(several, robots))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2:]))
