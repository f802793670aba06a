#!/usr/bin/env python3
"""A day in a warehouse. The loop of the client for Python drives simulated robots against a server. What they have
driven is judged independently. scripts/bench --day starts it.

Usage: day.py PROGRAM [ARGUMENTS of scripts/bench --day...]
"""

import argparse
import collections
import json
import pathlib
import statistics
import sys
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parents[2] / "clients/python"), str(HERE.parents[1] / "python"), str(HERE)]

from disturbances import Disturbances, Rates, Services  # noqa: E402
from fleetplan import Client, FleetLoop, FleetplanError, PlanDropped, RequestRefused  # noqa: E402
from fleetplan.simulation import SimulatedFleet  # noqa: E402
from support import service  # noqa: E402
from tasks import Tasks  # noqa: E402
from warehouse import make_request, make_warehouse  # noqa: E402
from watch import Watch  # noqa: E402

STEP = 0.1  # seconds between instructions
SPEED = 0.8, 1.0  # shares of the instructed speed that robots make
ACCELERATION = 1.0  # metres per second squared: of robots, also when they brake
BRAKES = 0.8  # metres per second squared: with which they are told to brake
COMMIT = 2.4  # seconds: the commitment of FleetLoop for its time budget and these brakes, whatever the budget is here
STARVED = 300.0  # seconds
MAX_TO_FINISH = 900.0  # seconds after the last task was offered


class Day:
    """Robots, tasks and what happens; see `run`."""

    def __init__(self, client, robots=50, per_hour=400.0, seed=1, rates=Rates(), latency=0.4, options=None,
                 profiles=False):
        """`profiles`: plans know how robots accelerate; otherwise they are at constant speeds."""
        warehouse = make_warehouse()
        request = make_request(warehouse, robots, seed)
        request["options"] = options or {}
        if profiles:
            request["robot_defaults"] = {"linear_acceleration": ACCELERATION, "linear_deceleration": BRAKES}
        self.client, self.request = client, request
        self.radii = {robot["id"]: robot["radius"] for robot in request["robots"]}
        self.fleet = SimulatedFleet(request, seed=seed, speed=SPEED, stops_per_hour=10.0, mean_stop=5.0,
                                    acceleration=ACCELERATION, noise=0.003)
        self.tasks = Tasks(warehouse, per_hour, seed)
        self.disturbances = Disturbances(rates, seed)
        self.watch = Watch(request)
        self.loop = FleetLoop(client, request, clock=self.fleet.clock, background=False, latency=latency,
                              commit=None if profiles else COMMIT, change=self.disturbances.change,
                              deceleration=BRAKES, reaction=STEP)
        self.rounds, self.failures, self.overran, self.lost = collections.Counter(), [], {}, []
        self.reports, self.stuck, self.wall_seconds = self.fleet.reports(), 0, 0.0
        self.offered_until = 0.0  # seconds

    def run(self, seconds, offer=True):
        """Goes on for so long; without `offer`, with the tasks that there are."""
        begin, end = time.monotonic(), self.fleet.now + seconds
        while self.fleet.now < end:
            self.assign(offer)
            instructions = self.step()
            self.fleet.obey(instructions)
            self.fleet.drive(STEP)
            speeds = {report.robot: report.speed for report in self.reports}
            self.disturbances.happen(self.fleet.now, STEP, self.fleet, self.loop, self.tasks, self.radii, speeds)
            self.watch.look(self.fleet, self.disturbances.standing())
            self.reports = Services.reports(self.fleet, instructions, self.tasks, STEP)
        if offer:
            self.offered_until = self.fleet.now
        self.wall_seconds += time.monotonic() - begin

    def finish(self, max_seconds):
        """Goes on without other tasks until all are done, or for so long."""
        end = self.fleet.now + max_seconds
        while (self.tasks.active or self.tasks.waiting) and self.fleet.now < end:
            self.run(1.0, offer=False)

    def assign(self, offer):
        """Gives tasks that wait to robots that have nothing to do, as the service assigns them."""
        now, idle = self.fleet.now, self.loop.idle
        for robot in [robot for robot in idle if robot in self.tasks.active]:
            task = self.tasks.finish(robot, now)
            left = self.watch.end(robot, self.fleet.pose(robot))
            if left:
                self.lost.append((round(now, 1), robot, left, task.goals))
        if offer:
            self.tasks.come(now, self.disturbances.closed_rectangles())
        for task in self.tasks.begin(self.assigned(idle), now):
            task.alone = self.alone(task)
            self.watch.begin(task.robot, task.goals, task.seconds)
            self.loop.give(task.robot, task.goals)

    def assigned(self, idle):
        """The robots of tasks that wait, by their numbers."""
        if not self.tasks.waiting or not idle:
            return {}
        tasks = [{"id": str(number), "goals": task.goals} for number, task in enumerate(self.tasks.waiting)]
        robots = [{**robot, "start": self.fleet.pose(robot["id"])} for robot in self.request["robots"]
                  if robot["id"] in idle]
        answer = self.client.assign({"map": self.request["map"], "robots": robots}, tasks)
        return {int(each["task"]): each["robot"] for each in answer["assigned"]}

    def step(self):
        before, failed = self.loop.answer, self.loop.failure
        try:
            instructions = self.loop.step(self.reports)
        except RequestRefused as error:
            self.failures.append(error)
            return []
        if isinstance(self.loop.failure, PlanDropped) and self.loop.failure is not failed:
            self.rounds["dropped"] += 1
        elif self.loop.failure is not None and self.loop.failure is not failed:
            self.failures.append(self.loop.failure)
        if self.loop.answer is not before:
            self.rounds[self.loop.answer["status"]] += 1
            self.stuck += len(self.loop.stuck)
        for robot in self.loop.overran:
            self.overran.setdefault(robot, self.fleet.now)
        return instructions

    def alone(self, task):
        """Seconds that the task takes the robot alone, at its mean speed, with the services as they are."""
        robot = next(robot for robot in self.request["robots"] if robot["id"] == task.robot)
        mean = statistics.mean(SPEED)
        lone = {**robot, "start": self.fleet.pose(task.robot), "linear_speed": robot["linear_speed"] * mean,
                "angular_speed": robot["angular_speed"] * mean, "goals": task.goals}
        try:
            answer = self.client.plan({"map": self.request["map"], "robots": [lone],
                                       "options": {"start_overlap": 0.15, "inflation": 0.05}})
            planned = answer["plans"][0]["cost"]
        except (FleetplanError, IndexError) as error:
            raise RuntimeError(f"{task.robot} alone has no plan for {task.goals}: {error}") from error
        return planned + sum(task.seconds) - sum(goal["service"] for goal in task.goals)

    def report(self):
        """The figures of the day. Rates refer to the time in which tasks were offered."""
        done = self.tasks.done
        ratios = sorted((task.end - task.begin) / task.alone for task in done)
        hours = self.offered_until / 3600.0
        in_time = sum(task.end <= self.offered_until for task in done)
        bound = len(self.radii) / statistics.mean(task.alone for task in done) * 3600.0 if done else 0.0
        return {"robots": len(self.radii), "simulated seconds": round(self.fleet.now),
                "offered": self.tasks.offered, "done": len(done), "done per hour": in_time / hours,
                "bound per hour": bound, "waiting share": self.watch.waited / max(1.0, self.watch.busy),
                "job over alone, median": statistics.median(ratios) if ratios else None,
                "job over alone, 95 %": ratios[int(0.95 * len(ratios))] if ratios else None,
                "longest wait": max(self.watch.longest_waits.values()), "starved": self.watch.starved(STARVED),
                "goals lost": self.lost, "overlaps": {" ".join(pair): depth for pair, depth in self.watch.overlaps.items()},
                "overran": self.overran, "rounds": dict(self.rounds), "stuck plans": self.stuck,
                "failures": collections.Counter(str(error)[:200] for error in self.failures),
                "disturbances": {**self.disturbances.count, "robots that stopped before people": len(self.disturbances.near)}, "wall seconds": round(self.wall_seconds)}


def main(program, words):
    parser = argparse.ArgumentParser(prog="scripts/bench --day", allow_abbrev=False, description=__doc__.split("\n\n")[0])
    parser.add_argument("--robots", type=int, default=50)
    parser.add_argument("--seconds", type=float, default=3600.0, help="simulated time; default 3600")
    parser.add_argument("--tasks", type=float, default=400.0, help="offered per hour; default 400")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--latency", type=float, default=0.4, help="seconds from a request to its plan; default 0.4")
    parser.add_argument("--options", type=json.loads, default={}, metavar="JSON", help="more options of the requests")
    parser.add_argument("--profiles", action="store_true", help="plan with the acceleration of the robots; by default at "
                        "constant speeds, to which --options '{\"wait_before_move\": 0.5}' adds time to start")
    parser.add_argument("--output", metavar="FOLDER", default=".", help="folder for day.json")
    arguments = parser.parse_args(words)
    with service(program) as url:
        day = Day(Client(url), arguments.robots, arguments.tasks, arguments.seed, latency=arguments.latency,
                  options=arguments.options, profiles=arguments.profiles)
        while day.fleet.now < arguments.seconds - STEP / 2.0:
            day.run(min(60.0, arguments.seconds - day.fleet.now))
            print(f"{day.fleet.now:.0f} s: {len(day.tasks.done)} of {day.tasks.offered} tasks done, {dict(day.rounds)}, "
                  f"{len(day.failures)} failures, {len(day.watch.overlaps)} overlaps", *day.failures[-1:],
                  file=sys.stderr, flush=True)
        day.finish(MAX_TO_FINISH)
    report = day.report()
    pathlib.Path(arguments.output, "day.json").write_text(json.dumps(report, indent=1) + "\n")
    for name, value in report.items():
        print(f"{name}: {value:.3f}" if isinstance(value, float) else f"{name}: {value}")
    wrong = [name for name in ("overlaps", "goals lost", "failures", "overran", "starved") if report[name]]
    return 1 if wrong or report["done"] < report["offered"] else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2:]))
