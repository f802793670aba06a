#!/usr/bin/env python3
"""Plans a request with a running service and prints when robots arrive. Needs nothing but Python.

    plan.py [REQUEST.json] [--url http://localhost:8080]

Without a file it plans two robots that swap the ends of a corridor. The exit code is 0 if every robot has a plan.
"""

import argparse
import json
import sys
import urllib.error
import urllib.request

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


def post(url, body):
    """The answer to a request; prints the faults of one that is refused, and exits."""
    request = urllib.request.Request(url, json.dumps(body).encode(), {"Content-Type": "application/json"})
    try:
        with urllib.request.urlopen(request) as response:
            return json.load(response)
    except urllib.error.HTTPError as error:
        with error:
            problem = json.load(error)
        print(problem["detail"], file=sys.stderr)
        for fault in problem.get("errors", []):
            print(f"{fault['pointer']}: {fault['detail']}", file=sys.stderr)
    except urllib.error.URLError as error:
        print(f"{url}: {error.reason}", file=sys.stderr)
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
    answer = post(arguments.url + "/v1/plan", request)

    for plan in answer["plans"]:
        print(f"{plan['robot']} arrives after {plan['cost']:.2f} s, with {len(plan['actions'])} actions")
    for robot in answer["unplanned"]:
        print(f"{robot['robot']} has no plan: {robot['detail']}")
    print(f"{answer['status']}, flowtime {answer['flowtime']:.2f} s")
    return 0 if answer["status"] == "solved" else 1


if __name__ == "__main__":
    sys.exit(main())
