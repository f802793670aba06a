#!/usr/bin/env python3
"""Drives robots for a simulated time by the loop of docs/fleet_loop.md against a real server. Replays what they have
executed by its own reading of the contract.

  drive.py --binary build/release/server/fleetplan --robots 40 --seconds 3600 --commit 1 --holds 60
  drive.py --url http://localhost:8080 --robots 12 --seconds 60

Each period, every robot executes its plan, robots that have served their last goals get new random goals, and the fleet
is planned again. With --holds N, robots are held for 30 s at N random moments. With --late N, robots fall behind by
less than --margin seconds (options.interval_margin). They also leave their paths by up to --noise metres, which their
measured poses tell. With --obstacles N, people walk across the map. --options has further options of the requests.

The exit status is 1 if

- a request was not answered within its budget,
- a robot was stranded,
- disks overlapped,
- or an answer contradicts its request.

Random choices depend only on --seed. Python standard library only.
"""

import argparse
import collections
import json
import math
import pathlib
import random
import re
import subprocess
import sys
import time
import urllib.error
import urllib.request

from geometry import pose_in
from replay import Replay

SCENARIOS = pathlib.Path(__file__).resolve().parent.parent / "scenarios"
HOLD = 30.0  # seconds
STRANDED = 120.0  # seconds without a plan
GRACE_MS = 250.0  # the machine may be busy: the client's own work is in what it measures


class Refused(Exception):
    """The server does not answer 200."""


class Service:
    """A server of this test, or a server that runs already."""

    def __init__(self, binary=None, url=None):
        self.process, self.url = None, url
        if binary:
            self.process = subprocess.Popen([binary, "--port", "0", "--log-level", "off"], stdout=subprocess.PIPE,
                                            text=True)
            self.url = re.search(r"http://\S+", self.process.stdout.readline()).group()

    def post(self, path, body):
        request = urllib.request.Request(self.url + path, json.dumps(body).encode(),
                                         {"Content-Type": "application/json"})
        try:
            with urllib.request.urlopen(request, timeout=300) as answer:
                return json.load(answer)
        except urllib.error.HTTPError as error:
            raise Refused(f"{path}: {error.code} {error.read().decode()}") from error

    def stop(self):
        if self.process:
            self.process.terminate()
            self.process.wait()
            self.process.stdout.close()


class Places:
    """Where robots may go: centres of cells in which the largest of them fits."""

    def __init__(self, request, replay, rng, parked):
        self.rng, self.radius = rng, max(robot["radius"] for robot in replay.robots.values())
        walls = replay.walls
        self.all = []
        for row in range(walls.height):
            for column in range(walls.width):
                x, y = walls.x + (column + 0.5) * walls.size, walls.y + (row + 0.5) * walls.size
                if walls.clearance(x, y, x, y, 2 * self.radius) < self.radius + 0.01:
                    continue
                if self.is_clear(x, y, parked):
                    self.all.append((x, y))
        # Where every robot stops once, so that no robot rests for ever in a passage that others need.
        given = [pose for robot in request["robots"]
                 for pose in (robot["start"], robot.get("goal"), *robot.get("goals", ())) if pose]
        self.last = [(pose["x"], pose["y"]) for pose in given
                     if walls.clearance(pose["x"], pose["y"], pose["x"], pose["y"], 2 * self.radius) >= self.radius]

    def is_clear(self, x, y, taken):
        return all(math.hypot(x - tx, y - ty) > 2 * self.radius + 0.02 for tx, ty in taken)

    def goals(self, taken):
        """Some goals on the way, with services, and a last goal that is clear of the places taken."""
        way = [{"x": x, "y": y, "service": round(self.rng.uniform(0.0, 4.0), 3)}
               for x, y in self.rng.sample(self.all, self.rng.choice((0, 0, 1, 2)))]
        for _ in range(1000):
            x, y = self.rng.choice(self.last)
            if self.is_clear(x, y, taken):
                return [*way, {"x": x, "y": y, "service": 2.0}]
        raise SystemExit("no place is left for a goal")


class Drive:
    """The loop, and what is counted in it."""

    def __init__(self, service, request, options):
        self.service, self.request, self.options = service, request, options
        self.rng = random.Random(options.seed)
        self.replay = Replay(request, options.noise)
        self.last = {robot["id"]: self.last_goal(robot) for robot in request["robots"] if self.last_goal(robot)}
        self.parked = [(robot["start"]["x"], robot["start"]["y"]) for robot in request["robots"]
                       if robot["id"] not in self.last]
        self.places = Places(request, self.replay, self.rng, self.parked)
        self.holds = {}  # until when, by robot
        self.hold_times = sorted(self.rng.uniform(0.0, options.seconds) for _ in range(options.holds))
        self.late_times = sorted(self.rng.uniform(0.0, options.seconds) for _ in range(options.late))
        self.walk_times = sorted(self.rng.uniform(0.0, options.seconds) for _ in range(options.obstacles))
        self.commit = {} if options.commit is None else {"commit": options.commit}
        self.count = collections.Counter()
        self.latency_ms = []
        self.without_plan = {}  # since when, by robot
        self.problems = []
        self.people = 0

    @staticmethod
    def last_goal(robot):
        """Where it ends, if it has goals."""
        goals = robot.get("goals", [robot["goal"]] if "goal" in robot else [])
        return (goals[-1]["x"], goals[-1]["y"]) if goals else None

    def run(self):
        answer = self.plan()
        while self.replay.now < self.options.seconds:
            period = self.options.period
            actions = {entry["robot"]: entry["actions"]
                       for entry in [*answer["unplanned"], *answer["plans"]] if "actions" in entry}
            poses = self.new_delays(actions, period)
            met = len(self.replay.met)
            self.replay.execute(actions, period, self.request.get("obstacles", ()))
            self.judge_meetings(self.replay.met[met:], answer)
            goals = self.new_goals(answer, period, {entry["robot"] for entry in poses})
            self.request = self.service.post("/v1/advance", {
                "request": self.request, "plans": answer["plans"], "at": period, **self.commit,
                "holds": self.new_holds(answer), "goals": goals, "poses": poses})
            self.add_people()
            answer = self.plan()
            self.compare(answer, {entry["robot"] for entry in goals})
        return self

    def plan(self):
        began = time.monotonic()
        answer = self.service.post("/v1/plan", self.request)
        elapsed = (time.monotonic() - began) * 1000.0
        self.count["plans"] += 1
        self.latency_ms.append(elapsed)
        budget = self.request["options"]["time_budget_ms"]
        if answer["timings_ms"]["total"] > budget or elapsed > budget + GRACE_MS:
            self.problem(f"answered after {elapsed:.0f} ms of {budget} ms: {answer['timings_ms']}")
        self.judge(answer)
        return answer

    def problem(self, text):
        self.problems.append(f"t = {self.replay.now:.3f} s: {text}")

    def judge(self, answer):
        """What every answer has to satisfy, besides what the replay checks."""
        plans = {plan["robot"]: plan for plan in answer["plans"]}
        unplanned = {entry["robot"]: entry for entry in answer["unplanned"]}
        for entry in unplanned.values():
            self.count[entry["reason"]] += 1
        for robot in self.request["robots"]:
            name, committed = robot["id"], robot.get("committed", [])
            if (name in plans) == (name in unplanned):
                self.problem(f"{name} is in both lists or in none")
                continue
            actions = plans.get(name, unplanned.get(name)).get("actions", [])
            if actions[:len(committed)] != committed or (name in unplanned and actions != committed):
                self.problem(f"the actions of {name} do not begin with the committed ones")
            if name in plans:
                self.judge_plan(robot, plans[name])
                self.without_plan.pop(name, None)
            else:
                since = self.without_plan.setdefault(name, self.replay.now)
                if self.replay.now - since > STRANDED:
                    self.problem(f"{name} is stranded since {since} s: {unplanned[name]}")
                    self.without_plan[name] = self.replay.now

    def judge_plan(self, robot, plan):
        goals = robot.get("goals", [robot["goal"]] if "goal" in robot else [])
        end = plan["actions"][-1]["to"] if plan["actions"] else robot["start"]
        if goals and math.hypot(end["x"] - goals[-1]["x"], end["y"] - goals[-1]["y"]) > 1e-6:
            self.problem(f"the plan of {robot['id']} does not end at its last goal")
        if plan["actions"] and plan["actions"][-1]["t_end"] != plan["cost"]:
            self.problem(f"the cost of {robot['id']} is not its last time")
        if "visits" in plan and [visit["goal"] for visit in plan["visits"]] != list(range(len(goals))):
            self.problem(f"{robot['id']} has {len(goals)} goals and the visits {plan['visits']}")

    def judge_meetings(self, met, answer):
        """A robot meets a person only where the answer says that it cannot be avoided."""
        told = {(entry.get("robot"), entry.get("obstacle")) for entry in answer.get("unavoidable", ())}
        for robot, obstacle, t in met:
            if (robot, obstacle) not in told:
                self.problem(f"{robot} meets {obstacle} at {t} s, and the answer does not tell")

    def new_delays(self, actions, period):
        """Some robots end this period in the middle of a translation, later than planned: their poses. Their actions
        become what they execute."""
        poses = []
        while self.late_times and self.late_times[0] <= self.replay.now:
            self.late_times.pop(0)
            lag = self.rng.uniform(0.2, 0.9) * self.options.margin
            driving = [(robot, k) for robot, list_ in actions.items() for k, action in enumerate(list_)
                       if action["type"] == "translate" and robot not in self.holds
                       and all(pose["robot"] != robot for pose in poses)
                       and action["t_start"] < period - lag and action["t_end"] >= period]
            if not driving:
                continue
            robot, k = self.rng.choice(driving)
            x, y, theta = pose_in(actions[robot][k], period - lag)
            aside = self.rng.uniform(-1.0, 1.0) * self.options.noise
            pose = {"x": x - aside * math.sin(theta), "y": y + aside * math.cos(theta), "theta": theta}
            driven = {**actions[robot][k], "t_end": period - lag, "to": pose}
            stop = {"type": "wait", "t_start": period - lag, "t_end": period, "from": pose, "to": pose}
            actions[robot] = [*actions[robot][:k], driven, stop]
            poses.append({"robot": robot, **pose})
            self.count["late"] += 1
        return poses

    def new_goals(self, answer, period, late):
        given = []
        for plan in answer["plans"]:
            robot = plan["robot"]
            if plan["cost"] > period or robot not in self.last or robot in late:
                continue
            if self.replay.visits[robot].goals:
                self.replay.fault(f"{robot} has not served {list(self.replay.visits[robot].goals)}")
            self.count["goals"] += 1
            others = [*self.parked, *(place for name, place in self.last.items() if name != robot)]
            here = self.replay.poses[robot]
            goals = self.places.goals([*others, here[:2]])
            self.last[robot] = goals[-1]["x"], goals[-1]["y"]
            self.replay.give(robot, goals)
            given.append({"robot": robot, "goals": goals})
        return given

    def new_holds(self, answer):
        """The holds that go on, and the holds that begin."""
        now = self.replay.now
        while self.hold_times and self.hold_times[0] <= now:
            self.hold_times.pop(0)
            moving = [plan["robot"] for plan in answer["plans"] if plan["cost"] > self.options.period]
            if moving:
                self.holds[self.rng.choice(moving)] = now + HOLD
                self.count["holds"] += 1
        self.holds = {robot: until for robot, until in self.holds.items() if until > now}
        return [{"robot": robot, "until": until - now} for robot, until in self.holds.items()]

    def add_people(self):
        """People who cross the map straight, from 5 s later on."""
        walls = self.replay.walls
        while self.walk_times and self.walk_times[0] <= self.replay.now:
            self.walk_times.pop(0)
            self.people += 1
            x = [walls.x + self.rng.random() * walls.width * walls.size for _ in range(2)]
            height = walls.height * walls.size
            motion = [{"t": 5.0, "x": x[0], "y": walls.y}, {"t": 5.0 + height / 1.2, "x": x[1], "y": walls.y + height}]
            self.request.setdefault("obstacles", []).append(
                {"id": f"person-{self.people}", "radius": 0.25, "motion": motion})

    def compare(self, answer, given):
        """How many of the robots under way that keep their goals got another plan."""
        previous = {robot["id"]: robot["previous"] for robot in self.request["robots"] if robot.get("previous")}
        plans = {plan["robot"]: plan["actions"] for plan in answer["plans"]}
        for robot, actions in previous.items():
            if robot in given:
                continue
            self.count["under way"] += 1
            self.count["changed"] += plans.get(robot) != actions

    def report(self):
        latency = sorted(self.latency_ms)
        meetings = self.replay.met
        return {
            "robots": len(self.request["robots"]),
            "seconds": round(self.replay.now, 3),
            "plans": self.count["plans"],
            "goals_served": self.count["goals"],
            "metres": round(self.replay.travelled, 1),
            "latency_ms": {"median": round(latency[len(latency) // 2], 1),
                           "p99": round(latency[int(len(latency) * 0.99)], 1), "most": round(latency[-1], 1)},
            "holds": self.count["holds"],
            "late": self.count["late"],
            "people": self.people,
            "meetings_with_people": len(meetings),
            "plans_under_way": self.count["under way"],
            "plans_changed": self.count["changed"],
            "least_gap": self.replay.least_gap,
            "unplanned": {key: value for key, value in self.count.items()
                          if key not in ("plans", "goals", "holds", "late", "under way", "changed")},
            "problems": len(self.problems) + len(self.replay.faults),
            "first_problems": (self.problems + self.replay.faults)[:10],
        }


def instance(options):
    """The first robots of a scenario, with options for the loop."""
    request = json.loads((SCENARIOS / f"{options.scenario}.json").read_text())
    request["robots"] = request["robots"][:options.robots]
    request["options"] = {"time_budget_ms": options.budget_ms, "start_safe_interval": 0}
    if options.margin:
        request["options"]["interval_margin"] = options.margin
    if options.replan != "all":
        request["options"]["replan"] = options.replan
    request["options"].update(options.options)
    return request


def arguments(argv=None):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    server = parser.add_mutually_exclusive_group(required=True)
    server.add_argument("--binary")
    server.add_argument("--url")
    parser.add_argument("--scenario", default="warehouse")
    parser.add_argument("--robots", type=int, default=40)
    parser.add_argument("--seconds", type=float, default=3600.0)
    parser.add_argument("--period", type=float, default=1.0)
    parser.add_argument("--commit", type=float, help="seconds; by default, the move under way")
    parser.add_argument("--budget-ms", type=int, default=1000)
    parser.add_argument("--replan", choices=("all", "where_needed"), default="where_needed")
    parser.add_argument("--holds", type=int, default=0)
    parser.add_argument("--late", type=int, default=0)
    parser.add_argument("--noise", type=float, default=0.0, help="how far late robots are beside their path, metres")
    parser.add_argument("--margin", type=float, default=0.0)
    parser.add_argument("--obstacles", type=int, default=0)
    parser.add_argument("--options", type=json.loads, default={}, help="further options of the requests, JSON")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep", help="a file for the last request, if the drive fails")
    return parser.parse_args(argv)


def main():
    options = arguments()
    service = Service(options.binary, options.url)
    drive = Drive(service, instance(options), options)
    try:
        drive.run()
    except Refused as refused:
        drive.problem(str(refused))
    finally:
        service.stop()
    report = drive.report()
    print(json.dumps(report, indent=2))
    if report["problems"] and options.keep:
        pathlib.Path(options.keep).write_text(json.dumps(drive.request))
    return 1 if report["problems"] else 0


if __name__ == "__main__":
    sys.exit(main())
