#!/usr/bin/env python3
"""Plans a request with a running service and prints when robots arrive. Needs nothing but Python.

    plan.py [REQUEST.json] [--url http://localhost:8080]

Without a file it plans two robots that swap the ends of a corridor. The exit code is 0 if every robot has a plan, 1 if
not, and 2 if there is no answer, or an error.
"""

import argparse
import http.client
import json
import signal
import sys
import urllib.error
import urllib.request

LARGEST = 256 << 20  # bytes of an answer

SWAP = {
    "map": {"rows": ["####.####",
                     "........."], "resolution": 1.0},
    "robot_defaults": {"radius": 0.3, "linear_speed": 1.0, "angular_speed": 3.0},
    "robots": [
        {"id": "east-bound", "start": {"x": 0.5, "y": 0.5}, "goal": {"x": 8.5, "y": 0.5}},
        {"id": "west-bound", "start": {"x": 8.5, "y": 0.5, "theta": 3.14159}, "goal": {"x": 0.5, "y": 0.5}},
    ],
    "options": {"time_budget_ms": 2000},
}


def post(url, body, seconds):
    """The answer to a request, which is an object, within so many seconds. Prints what is wrong if there is none, such as
    the faults of a request that is refused, and exits."""
    request = urllib.request.Request(url, json.dumps(body).encode(), {"Content-Type": "application/json"})
    if hasattr(signal, "SIGALRM"):  # the timeout of urllib is for silence only
        signal.signal(signal.SIGALRM, lambda *_: give_up(f"{url}: the answer takes too long"))
        signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        with urllib.request.urlopen(request, timeout=seconds) as response:
            return read_object(response)
    except urllib.error.HTTPError as error:
        with error:
            problem = read_object(error)
        faults = [f"{fault['pointer']}: {fault['detail']}" for fault in problem.get("errors", [])]
        give_up("\n".join([problem["detail"], *faults]))


def read_object(response):
    text = response.read(LARGEST)
    try:
        value = json.loads(text)
    except (ValueError, RecursionError):
        value = None
    if not isinstance(value, dict):
        raise ValueError(f"an answer of status {response.status} that is no JSON object; is this a proxy?")
    return value


def give_up(why):
    print(why, file=sys.stderr)
    sys.exit(2)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("request", nargs="?", help="file of the request, instead of the built-in one")
    parser.add_argument("--url", default="http://localhost:8080", help="of the service")
    arguments = parser.parse_args()

    request = SWAP
    if arguments.request:
        with open(arguments.request, encoding="utf-8") as file:
            request = json.load(file)
    seconds = request.get("options", {}).get("time_budget_ms", 5000) / 1000.0 + 5.0
    try:
        answer = post(arguments.url + "/v1/plan", request, seconds)
        return print_plan(answer)
    except (OSError, http.client.HTTPException, KeyError, TypeError, ValueError) as error:
        give_up(f"{arguments.url}: {error}")


def print_plan(answer):
    lines = [f"{plan['robot']} arrives after {plan['cost']:.2f} s, with {len(plan['actions'])} actions"
             for plan in answer["plans"]]
    lines += [f"{robot['robot']} has no plan: {robot['detail']}" for robot in answer["unplanned"]]
    print(*lines, f"{answer['status']}, flowtime {answer['flowtime']:.2f} s", sep="\n")
    return 0 if answer["status"] == "solved" else 1


if __name__ == "__main__":
    sys.exit(main())
