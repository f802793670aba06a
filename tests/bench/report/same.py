#!/usr/bin/env python3
"""Compares the answers of two builds. scripts/bench --same builds and starts this.

Asks both builds the same requests:

- random lives with everything that requests may have (tests/soak/lives),
- the example requests, and given files,
- what follows from their plans: simulations, dependencies, orders of VDA 5050 and the like.

Answers are compared as a whole, except for times of this machine. Plans that a time budget has ended are not compared.
Prints how many requests had what. If valgrind is installed, also prints the instructions that some of them take in both
builds.

Usage: same.py PROGRAM LIVES --output FOLDER [--other COMMAND] [--environment NAME=VALUE] [--rounds N] [--seed N]
               [--counted N] [FILE|FOLDER...]
"""

import argparse
import concurrent.futures
import copy
import json
import os
import pathlib
import random
import re
import shlex
import shutil
import subprocess
import sys
import tempfile

SCENARIOS = pathlib.Path(__file__).resolve().parent.parent.parent / "scenarios"
BUDGET_MS = 2000  # of a plan; what needs longer is not compared
COUNTED_BUDGET_MS = 600000  # under valgrind
STEPS = 20  # of improvement
DERIVED_EVERY = 3  # plans of which other requests are made
AT_ONCE = os.cpu_count() or 1
SHOWN = 10
# Options that a request gets besides its own, in turn.
VARIED = {"mode": "anytime", "interval_margin": 0.2, "invalid_robots": "report", "start_safe_interval": 1.0, "seed": 7}
OF_THIS_MACHINE = ("request_id", "timings_ms")
# What a request may have that several parts of the planner know of, by the text of the request.
FEATURES = {"acceleration": "_acceleration\"", "added wait": "\"wait_before_move\"", "any_of": "\"any_of\"",
            "commitments": "\"committed\"", "horizon": "\"horizon\"", "idle": "\"idle\"", "inflation": "\"inflation\"",
            "interval margin": "\"interval_margin\"", "invalid robots": "\"invalid_robots\"", "loads": "_after\"",
            "obstacles": "\"obstacles\": *\\[\\{", "previous": "\"previous\"", "reverse": "\"may_reverse\"",
            "services": "\"service\"", "start safe interval": "\"start_safe_interval\"", "vicinity": "\"vicinity\"",
            "zones": "\"zones\": *\\[\\{"}


def main():
    arguments = parse_arguments()
    folder = pathlib.Path(arguments.output)
    requests = [*recorded(arguments.lives, arguments.rounds, arguments.seed, folder), *of_files([SCENARIOS]),
                *of_files(arguments.files)]
    requests = [repeatable(number, request) for number, request in enumerate(requests)]
    first = [arguments.program]
    other, environment = shlex.split(arguments.other or arguments.program), dict(arguments.environment)
    print(f"{len(requests)} requests", file=sys.stderr)
    answers = ask(first, {}, requests)
    more = [request for number, (request, answer) in enumerate(zip(requests, answers, strict=True))
            if request["path"] == "/v1/plan" and number % DERIVED_EVERY == 0 for request in following(request["body"], answer)]
    requests, answers = [*requests, *more], [*answers, *ask(first, {}, more)]
    print(f"{len(requests)} with what follows; the other build answers", file=sys.stderr)
    others = ask(other, environment, requests)
    differences, ended = compare(requests, answers, others)
    print_result(requests, answers, ended, differences)
    for number in differences[:SHOWN]:
        print(f"  {requests[number]['path']} {number}: "
              f"{first_difference(without_times(answers[number]), without_times(others[number]))}")
    with (folder / "same-differences.jsonl").open("w", encoding="utf-8") as file:
        for number in differences:
            file.write(json.dumps({**requests[number], "answer": answers[number], "other": others[number]}) + "\n")
    if arguments.counted > 0 and not environment:
        count_instructions(first, other, chosen(requests, answers, ended, arguments.counted, arguments.seed))
    return 1 if differences else 0


def parse_arguments():
    parser = argparse.ArgumentParser(prog="scripts/bench --same", description="Whether two builds answer the same.")
    parser.add_argument("program", help=argparse.SUPPRESS)
    parser.add_argument("lives", help=argparse.SUPPRESS)
    parser.add_argument("--output", required=True, help=argparse.SUPPRESS)
    parser.add_argument("--other", metavar="COMMAND", help="the fleetplan_ask of another commit, or a command that runs it; "
                        "by default the one of this commit")
    parser.add_argument("--environment", metavar="NAME=VALUE", action="append", default=[], type=lambda text: text.split("=", 1),
                        help="of the other build's process")
    parser.add_argument("--rounds", type=int, default=600, help="of random lives, with three requests each")
    parser.add_argument("--seed", type=int, default=0, help="of the first life")
    parser.add_argument("--counted", type=int, default=40, help="requests whose instructions are counted")
    parser.add_argument("files", nargs="*", help="requests for plans, or folders of them")
    return parser.parse_intermixed_args()


# ---------------------------------------------------------------- requests

def recorded(program, rounds, seed, folder):
    """What random lives ask."""
    folder.mkdir(parents=True, exist_ok=True)
    file = folder / "same-lives.jsonl"
    file.unlink(missing_ok=True)
    environment = {**os.environ, "FLEETPLAN_RECORD": str(file), "FLEETPLAN_ROUNDS": str(rounds),
                   "FLEETPLAN_FIRST_LIFE": str(seed)}
    # So few rounds need not have every pair of features, which is what this test fails for.
    subprocess.run([program, "--gtest_filter=Lives.*"], env=environment, stdout=subprocess.DEVNULL, check=False)
    return [json.loads(line) for line in file.read_text(encoding="utf-8").splitlines()]


def of_files(names):
    """The requests for plans in files and folders."""
    paths = [path for name in map(pathlib.Path, names)
             for path in (sorted(name.rglob("*.json")) if name.is_dir() else [name])]
    bodies = [json.loads(path.read_text(encoding="utf-8")) for path in paths]
    return [{"path": "/v1/plan", "body": body} for body in bodies if isinstance(body, dict) and "robots" in body]


def repeatable(number, request):
    """With a limit of steps instead of a time, and one or the other option more, if it is for a plan."""
    if request["path"] != "/v1/plan":
        return request
    body = copy.deepcopy(request["body"])
    options = body.setdefault("options", {})
    for turn, (name, value) in enumerate(VARIED.items()):
        if number % len(VARIED) == turn:
            options.setdefault(name, value)
    options.update(time_budget_ms=BUDGET_MS, dependencies=True)
    if options.get("mode") == "anytime":
        options["max_iterations"] = min(STEPS, options.get("max_iterations") or STEPS)
    return {"path": request["path"], "body": body}


def following(body, answer):
    """What can be asked of a plan."""
    if not answer.get("dependencies"):
        return
    plans = {"plans": answer["plans"]}
    whole = {**{name: value for name, value in body.items() if name != "unavoidable"}, **plans}
    yield {"path": "/v1/dependencies", "body": whole}
    yield {"path": "/v1/simulate", "body": {**whole, "policy": "absorb_waits", "runs": 3, "seed": 1,
                                            "disturbance": {"start_delay": {"min": 0.0, "max": 1.0}}}}
    robots = {name: body[name] for name in ("robots", "robot_defaults", "options") if name in body}
    yield {"path": "/v1/export/vda5050", "body": {
        **robots, **plans, "dependencies": answer["dependencies"], "version": "2.1.0", "manufacturer": "acme",
        "timestamp": "2026-01-31T12:00:00.000Z"}}
    first = {**body.get("robot_defaults", {}), **body["robots"][0]}
    # Other poses are refused where the map is narrow.
    poses = [{name: robot["start"][name] for name in ("x", "y") if name in robot["start"]} for robot in body["robots"][:6]]
    yield {"path": "/v1/matrix", "body": {
        **{name: body[name] for name in ("map", "zones") if name in body},
        "robot": {name: first[name] for name in ("id", "radius", "linear_speed", "angular_speed") if name in first},
        "from": poses, "to": poses}}


# ---------------------------------------------------------------- answers

def ask(command, environment, requests):
    """The answers, by as many processes as there are CPUs."""
    shares = [requests[number::AT_ONCE] for number in range(AT_ONCE)]
    with concurrent.futures.ThreadPoolExecutor(AT_ONCE) as threads:
        answers = list(threads.map(lambda share: ask_in_turn(command, environment, share), shares))
    return [answers[number % AT_ONCE][number // AT_ONCE] for number in range(len(requests))]


def ask_in_turn(command, environment, requests):
    text = "".join(json.dumps(request) + "\n" for request in requests)
    process = subprocess.run(command, input=text, stdout=subprocess.PIPE, text=True, check=False,
                             env={**os.environ, **environment})
    answers = process.stdout.splitlines()
    if process.returncode != 0 or len(answers) != len(requests):
        raise ValueError(f"{shlex.join(command)} has ended with {process.returncode} at request {len(answers)}: "
                         f"{json.dumps(requests[len(answers)])[:2000] if len(answers) < len(requests) else ''}")
    return [json.loads(answer) for answer in answers]


def compare(requests, answers, others):
    """The numbers of requests whose answers differ, and of requests that are not compared."""
    differences, ended = [], []
    for number, (request, answer, other) in enumerate(zip(requests, answers, others, strict=True)):
        if request["path"] == "/v1/plan" and not (is_repeatable(answer) and is_repeatable(other)):
            ended.append(number)
        elif without_times(answer) != without_times(other):
            differences.append(number)
    return differences, ended


def is_repeatable(answer):
    return answer.get("deterministic", "code" in answer)  # refusals are


def without_times(answer):
    return {name: value for name, value in answer.items() if name not in OF_THIS_MACHINE}


def first_difference(one, other, path=""):
    """Where two values differ first, and the values there."""
    if isinstance(one, dict) and isinstance(other, dict):
        pairs = [(f"{path}/{name}", one.get(name), other.get(name)) for name in {**one, **other}]
    elif isinstance(one, list) and isinstance(other, list) and len(one) == len(other):
        pairs = [(f"{path}/{number}", *pair) for number, pair in enumerate(zip(one, other, strict=True))]
    else:
        return f"{path or '/'}: {json.dumps(one)[:60]} and {json.dumps(other)[:60]}"
    return next((first_difference(a, b, where) for where, a, b in pairs if a != b), "")


def print_result(requests, answers, ended, differences):
    paths = sorted({request["path"] for request in requests})
    print(f"{len(requests)} requests, {len(ended)} of them ended by a time budget and not compared; "
          f"{len(differences)} answers differ")
    skipped = set(ended)
    compared = [number for number in range(len(requests)) if number not in skipped]
    for path in paths:
        of_path = [number for number in compared if requests[number]["path"] == path]
        refused = sum("code" in answers[number] for number in of_path)
        print(f"  {path}: {len(of_path)} compared, {refused} of them refusals")
    texts = [json.dumps(requests[number]["body"]) for number in compared]
    print("compared with " + ", ".join(f"{name}: {sum(bool(re.search(text, whole)) for whole in texts)}"
                                       for name, text in FEATURES.items()))


def chosen(requests, answers, ended, count, seed):
    """Plans that take neither too little nor too long to count what they take."""
    skipped = set(ended)
    fit = [request for number, (request, answer) in enumerate(zip(requests, answers, strict=True))
           if request["path"] == "/v1/plan" and number not in skipped
           and 2.0 <= sum((answer.get("timings_ms") or {}).values()) <= 300.0]
    picked = copy.deepcopy(random.Random(seed).sample(fit, min(count, len(fit))))
    for request in picked:
        request["body"]["options"]["time_budget_ms"] = COUNTED_BUDGET_MS
    return picked


def count_instructions(first, other, requests):
    if shutil.which("valgrind") is None:
        print("valgrind is not installed, so instructions are not counted")
        return
    with concurrent.futures.ThreadPoolExecutor(AT_ONCE) as threads:
        empty = [instructions(command, []) for command in (first, other)]
        pairs = list(threads.map(lambda request: [instructions(command, [request]) for command in (first, other)], requests))
    ratios = sorted((b - empty[1]) / (a - empty[0]) for a, b in pairs)
    whole = (sum(b for _, b in pairs) - len(pairs) * empty[1]) / (sum(a for a, _ in pairs) - len(pairs) * empty[0])
    print(f"instructions of {len(pairs)} plans, other build / this one: {whole:.4f} in all, median "
          f"{ratios[len(ratios) // 2]:.4f}, from {ratios[0]:.4f} to {ratios[-1]:.4f}")


def instructions(command, requests):
    text = "".join(json.dumps(request) + "\n" for request in requests)
    with tempfile.NamedTemporaryFile() as counts:
        subprocess.run(["valgrind", "--tool=callgrind", f"--callgrind-out-file={counts.name}", *command], input=text,
                       capture_output=True, text=True, check=True)
        told = re.search(rb"^(?:summary|totals): (\d+)", pathlib.Path(counts.name).read_bytes(), re.MULTILINE)
        return int(told.group(1))


if __name__ == "__main__":
    sys.exit(main())
