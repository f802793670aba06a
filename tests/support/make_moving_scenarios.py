#!/usr/bin/env python3
"""Writes the request files of fleets in motion in tests/scenarios.

Usage: tests/support/make_moving_scenarios.py URL [FOLDER]   (URL of a running service, default: tests/scenarios)

What robots do already, and were planned to do, comes from plans of the service. Their titles are in
make_scenarios.py, which writes the index. Python standard library only.
"""

import json
import math
import pathlib
import sys
import urllib.request

from make_scenarios import PI, Map, Places, faults, pose, robot, text, warehouse

SERVICE_S = 2.0  # at every goal of the warehouse
STEP_S = 2.5  # between two plans of the running warehouse
COMMIT_S = 1.0  # that its robots go on with what they do


class Service:
    def __init__(self, url):
        self.url = url.rstrip("/")

    def post(self, path, body):
        request = urllib.request.Request(self.url + path, json.dumps(body).encode(),
                                         {"Content-Type": "application/json"})
        with urllib.request.urlopen(request) as reply:
            return json.load(reply)

    def plan(self, request):
        options = {**request.get("options", {}), "time_budget_ms": 60000}
        answer = self.post("/v1/plan", {**request, "options": options})
        if answer["status"] != "solved":
            raise SystemExit(f"not solved: {answer['unplanned']}")
        return answer["plans"]


# ---------------------------------------------------------------- the scenarios

def crossing_people(_service):
    grid = Map(36, 24, 0.5)
    grid.block(11, 8, 3, 8)
    grid.block(22, 8, 3, 8)
    cart = {"radius": 0.35, "linear_speed": 1.2, "angular_speed": 2.0}
    up, down = PI / 2, -PI / 2

    def person(name, points, begin=0.0, speed=1.25, after="leaves"):
        t, motion = begin, []
        for index, (x, y) in enumerate(points):
            if index:
                t += math.dist(points[index - 1], (x, y)) / speed
            motion.append({"t": round(t, 3), "x": x, "y": y})
        return {"id": name, "radius": 0.3, "motion": motion, "after": after}

    return {
        "map": grid.json(),
        "robots": [
            robot("cart-1", pose(1.25, 6.25, 0.0), pose(16.75, 5.75, 0.0), **cart),
            robot("cart-2", pose(16.75, 6.25, PI), pose(1.25, 5.75, PI), **cart),
            robot("cart-3", pose(9.25, 1.25, up), pose(9.25, 10.75, up), **cart),
            robot("cart-4", pose(8.25, 10.75, down), pose(8.25, 1.25, down), **cart),
            robot("cart-5", pose(3.25, 1.25, 0.0), pose(15.25, 10.25, up), **cart),
            robot("cart-6", pose(14.75, 1.75, PI), pose(2.75, 10.25, up), **cart),
        ],
        "obstacles": [
            person("walker-1", [(0.0, 2.5), (18.0, 2.5)]),
            person("walker-2", [(18.0, 9.5), (9.0, 8.75), (0.0, 9.5)], begin=1.0),
            person("walker-3", [(3.5, 12.0), (4.0, 6.0), (3.5, 0.0)], begin=2.0, speed=1.0),
            person("walker-4", [(14.0, 0.0), (14.0, 12.0)], begin=4.0, speed=1.5),
            person("walker-5", [(7.75, 12.0), (7.75, 8.0), (10.0, 4.5), (10.0, 0.0)], begin=3.0),
            person("visitor", [(18.0, 7.5), (16.0, 8.0)], begin=5.0, after="stays"),
        ],
        "options": {"time_budget_ms": 10000},
    }


class Goals:
    """New goals beside the shelves of the warehouse example, or between its west wall and shelves for pallets. Goals of
    robots do not overlap."""

    def __init__(self, request, seed):
        self.grid = Map.from_picture(request["map"]["rows"], request["map"]["resolution"])
        shelves = [(c, r) for c in range(12, 66) for r in range(2, 42)
                   if not self.grid.blocked(c, r) and (self.grid.blocked(c, r + 1) or self.grid.blocked(c, r - 1))]
        lane = [(c, r) for c in range(5, 11) for r in range(2, 42)]
        self.cells = {"tote": shelves, "pallet": lane}
        self.places = Places(self.grid, seed)

    def draw(self, request, robot_of):
        """A goal for a robot that overlaps no other goal of the request."""
        kind = robot_of["id"].partition("-")[0]
        self.places.taken = [(goal["x"], goal["y"], each["radius"]) for each in request["robots"]
                             for goal in goals_of(each)]
        x, y = self.places.take(robot_of["radius"], self.cells[kind])
        faces_up = self.grid.blocked(int(x / 0.5), int(y / 0.5) + 1)
        theta = 0.0 if kind == "pallet" else PI / 2 if faces_up else -PI / 2
        return {**pose(x, y, theta), "service": SERVICE_S}


def goals_of(made):
    return made["goals"] if "goals" in made else [made["goal"]]


def running_warehouse(service, seconds, seed):
    """The request of a warehouse that has run for `seconds`; robots that have one goal left get a second one."""
    request = warehouse()
    goals = Goals(request, seed)
    for made in request["robots"]:
        made["goals"] = [{**made.pop("goal"), "service": SERVICE_S}]
    request["options"] = {"start_safe_interval": 0.0, "replan": "where_needed"}
    give_second_goals(request, goals)
    for _ in range(round(seconds / STEP_S)):
        request = service.post("/v1/advance", {"request": request, "plans": service.plan(request), "at": STEP_S,
                                               "commit": COMMIT_S})
        give_second_goals(request, goals)
    return request


def give_second_goals(request, goals):
    for made in request["robots"]:
        if len(goals_of(made)) < 2:
            made["goals"] = [*goals_of(made), goals.draw(request, made)]
            made.pop("goal", None)
            made.pop("previous", None)


def rush_hour(service):
    request = running_warehouse(service, 300.0, 300)
    request["options"] = {"start_safe_interval": 0.0, "replan": "where_needed", "time_budget_ms": 10000}
    return request


def late_pallet(service):
    request = warehouse()
    request["options"] = {"start_safe_interval": 0.0}
    plans = service.plan(request)
    holds = [{"robot": "pallet-04", "until": 12.0}]
    request = service.post("/v1/advance", {"request": request, "plans": plans, "at": 4.0, "holds": holds})
    request["options"] = {"start_safe_interval": 0.0, "replan": "where_needed", "time_budget_ms": 10000}
    return request


SCENARIOS = [("crossing-people", crossing_people), ("rush-hour", rush_hour), ("late-pallet", late_pallet)]


def main():
    service = Service(sys.argv[1])
    default = pathlib.Path(__file__).resolve().parent.parent / "scenarios"
    folder = pathlib.Path(sys.argv[2]) if len(sys.argv) > 2 else default
    for name, make in SCENARIOS:
        request = make(service)
        found = faults({**request, "robots": [{**made, "goal": goals_of(made)[-1]} for made in request["robots"]]})
        if found:
            raise SystemExit(f"{name}:\n  " + "\n  ".join(found))
        (folder / f"{name}.json").write_text(text(request))


if __name__ == "__main__":
    main()
