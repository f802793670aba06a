#!/usr/bin/env python3
"""Keeps requests and answers of a release, for tests/documents to compare later versions with.

Usage: keep_answers.py FLEETPLAN_BINARY FOLDER
Writes FOLDER/NAME.json for each request: {"path", "request", "answer"}.
"""

import json
import pathlib
import re
import subprocess
import sys
import urllib.request

PROJECT = pathlib.Path(__file__).resolve().parent.parent.parent


def requests(post):
    """Names, paths and requests; later requests contain the answers of earlier ones."""
    def scenario(name):
        return json.loads((PROJECT / "tests" / "scenarios" / f"{name}.json").read_text())

    swap = {**scenario("corridor-swap"), "options": {"dependencies": True, "interval_margin": 0.5}}
    plan = post("/v1/plan", swap)
    yield "plan", "/v1/plan", swap
    yield "plan_partial", "/v1/plan", scenario("partly-solvable")
    yield "plan_horizon", "/v1/plan", {**scenario("corridor-swap"), "options": {"horizon": 5}}
    yield "validate", "/v1/validate", {**swap, "plans": plan["plans"]}
    yield "validate_fault", "/v1/validate", {**swap, "plans": plan["plans"][:1] + [
        {**plan["plans"][1], "actions": plan["plans"][1]["actions"][:1]}]}
    yield "simulate", "/v1/simulate", {**swap, "plans": plan["plans"], "policy": "open_loop", "runs": 20,
                                       "disturbance": {"speed": {"min": 0.5, "max": 1}}}
    yield "advance", "/v1/advance", {"request": swap, "plans": plan["plans"], "at": 2.0, "commit": 1.0}
    yield "dependencies", "/v1/dependencies", {**swap, "plans": plan["plans"]}
    yield "retime", "/v1/retime", {"robots": swap["robots"], "robot_defaults": swap.get("robot_defaults", {}),
                                   "plans": plan["plans"], "dependencies": plan["dependencies"], "at": 2.0,
                                   "states": [{"robot": swap["robots"][0]["id"], "action": 0, "progress": 0.1}]}
    robot = {**swap.get("robot_defaults", {}), **swap["robots"][0]}
    robot = {key: robot[key] for key in ("radius", "linear_speed", "angular_speed")}
    places = [one["start"] for one in swap["robots"]]
    yield "matrix", "/v1/matrix", {"map": swap["map"], "robot": robot, "from": places, "to": places}
    yield "assign", "/v1/assign", {"request": {**swap, "robots": [{key: value for key, value in one.items() if key != "goal"}
                                                                  for one in swap["robots"]]},
                                   "tasks": [{"id": one["id"], "goals": [one["goal"]]} for one in swap["robots"]]}
    yield "export_vda5050", "/v1/export/vda5050", {
        "version": "2.1.0", "manufacturer": "acme", "timestamp": "2026-01-31T12:00:00.000Z", "robots": swap["robots"],
        "robot_defaults": swap.get("robot_defaults", {}), "plans": plan["plans"], "dependencies": plan["dependencies"]}


def main(binary, folder):
    server = subprocess.Popen([binary, "--port", "0", "--log-level", "off"], stdout=subprocess.PIPE, text=True)
    url = re.search(r"http://\S+", server.stdout.readline()).group()

    def post(path, body):
        request = urllib.request.Request(url + path, json.dumps(body).encode(), {"Content-Type": "application/json"})
        with urllib.request.urlopen(request) as response:
            return json.load(response)

    try:
        for name, path, body in requests(post):
            kept = {"path": path, "request": body, "answer": post(path, body)}
            (pathlib.Path(folder) / f"{name}.json").write_text(json.dumps(kept) + "\n")
    finally:
        server.terminate()
        server.wait()


if __name__ == "__main__":
    main(*sys.argv[1:])
