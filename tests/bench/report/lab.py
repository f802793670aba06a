#!/usr/bin/env python3
"""The laboratory table of the AA-SIPP(m) paper, by simulation; scripts/bench --lab builds and starts this.

Usage: lab.py PROGRAM [ARGUMENTS of scripts/bench --lab...]
"""

import argparse
import json
import math
import pathlib
import random
import subprocess
import sys

import markdown
from markdown import decimal

# The paper's robots and polygon (ECMR 2019, Experiments with real robots).
ROBOTS = 6
SPEED = 0.1  # metres per second
TURN = math.radians(24)  # radians per second
BODY = 0.148  # metres
COLUMNS, ROWS, CELL = 108, 72, 0.05
OBSTACLES = [(26, 40, 16, 10), (52, 14, 10, 18), (74, 46, 14, 8)]  # column, row from the bottom, width, height
SHORTEST_WAY = 2.7  # metres from a start to its goal, half the length of the polygon
RADII = [0.15, 0.25, 0.35]  # metres, planned
WAITS = [0.0, 5.0]  # seconds before every translation
# Of plans that are executed with dependencies, without waits: metres added to the smallest radius. Robots leave their
# paths by CROSS_TRACK.
MARGINS = [0.0, 0.05, 0.1]
INTERVAL_MARGIN = 0.5  # seconds, of these plans
# RMSE of executed against planned positions of one robot over 20 runs, metres: the only figure that is fitted.
PAPER_RMSE = 0.3065
PAPER_LONE_RUNS = 20
# A robot is late because it begins every action late, by up to a delay that is fitted. It also drives a little slower
# than planned, and beside its path.
LARGEST_DELAY = 20.0  # seconds: the fit is below
SLOWEST = 0.97  # of the planned speed
CROSS_TRACK = {"sigma": 0.02, "correlation_length": 0.5}  # metres
STEP = 0.1  # seconds between compared positions
# What the paper's table says of the runs with six robots.
PAPER_SAFE = {(0.15, 0.0): "0 %", (0.35, 5.0): "100 %"}
PAPER_COST = {(0.35, 5.0): "about 2"}


class Service:
    """The endpoints in process, through fleetplan_ask."""

    def __init__(self, program):
        self.process = subprocess.Popen([program], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

    def post(self, path, body):
        self.process.stdin.write(json.dumps({"path": path, "body": body}) + "\n")
        self.process.stdin.flush()
        line = self.process.stdout.readline()
        if not line:
            raise ValueError("the program ended")
        answer = json.loads(line)
        if "code" in answer:
            raise ValueError(f"{path}: {answer['detail']}")
        return answer


def polygon():
    rows = [["."] * COLUMNS for _ in range(ROWS)]
    for column, row, width, height in OBSTACLES:
        for y in range(row, row + height):
            rows[ROWS - 1 - y][column:column + width] = "#" * width
    return {"rows": ["".join(row) for row in rows], "resolution": CELL}


def distance_from_walls(x, y):
    """To the nearest obstacle or edge of the polygon; 0 inside an obstacle."""
    least = min(x, y, COLUMNS * CELL - x, ROWS * CELL - y)
    for column, row, width, height in OBSTACLES:
        dx = max(column * CELL - x, 0.0, x - (column + width) * CELL)
        dy = max(row * CELL - y, 0.0, y - (row + height) * CELL)
        least = min(least, math.hypot(dx, dy))
    return least


def draw_places(chance, room):
    """Places for all robots with `room` metres around each, for bodies that are so large."""
    places = []
    while len(places) < ROBOTS:
        x, y = chance.uniform(0.0, COLUMNS * CELL), chance.uniform(0.0, ROWS * CELL)
        apart = min((math.dist((x, y), place) for place in places), default=math.inf)
        if distance_from_walls(x, y) > room and apart > 2 * room:
            places.append((x, y))
    return places


def instance(seed):
    """Robots that cross the polygon, with room for the largest radius at their starts and goals."""
    chance = random.Random(seed)
    room = max(RADII) + 0.02
    while True:
        starts, goals = draw_places(chance, room), draw_places(chance, room)
        if all(math.dist(start, goal) >= SHORTEST_WAY for start, goal in zip(starts, goals)):
            break
    return [{"id": f"rover-{k + 1}", "start": {"x": start[0], "y": start[1], "theta": chance.uniform(-3.1, 3.1)},
             "goal": {"x": goal[0], "y": goal[1]}} for k, (start, goal) in enumerate(zip(starts, goals))]


def request(robots, radius, wait, budget):
    return {"map": polygon(), "robots": robots,
            "robot_defaults": {"radius": radius, "linear_speed": SPEED, "angular_speed": TURN, "body_radius": BODY},
            "options": {"wait_before_move": wait, "start_safe_interval": 0.0, "time_budget_ms": math.ceil(1000 * budget)}}


def disturbance(delay):
    factor = {"min": SLOWEST, "max": 1.0}
    return {"speed": factor, "turn": factor, "start_delay": {"min": 0.0, "max": delay}, "cross_track": CROSS_TRACK}


def position_at(actions, t):
    for action in actions:
        if t <= action["t_end"]:
            duration = action["t_end"] - action["t_start"]
            part = (t - action["t_start"]) / duration if duration > 0 else 1.0
            return tuple((1 - part) * action["from"][axis] + part * action["to"][axis] for axis in "xy")
    return actions[-1]["to"]["x"], actions[-1]["to"]["y"]


def squared_errors(planned, executed):
    """Of positions at the same times until the later end."""
    end = max(planned[-1]["t_end"], executed[-1]["t_end"])
    return [math.dist(position_at(planned, k * STEP), position_at(executed, k * STEP)) ** 2
            for k in range(int(end / STEP) + 1)]


def lone_rmse(service, delay, plans):
    """The error of one robot that executes its plan alone, over runs as in the paper."""
    errors = []
    for number, (body, answer) in enumerate(plans):
        traced = service.post("/v1/simulate", {**body, "plans": answer["plans"], "policy": "open_loop", "runs": 1,
                                               "seed": number, "trace": 0, "disturbance": disturbance(delay)})
        errors += squared_errors(answer["plans"][0]["actions"], traced["trace"]["plans"][0]["actions"])
    return math.sqrt(sum(errors) / len(errors))


def fitted_delay(service, budget):
    """The largest start delay with which one robot alone has the paper's error, by bisection."""
    plans = []
    for seed in range(1, PAPER_LONE_RUNS + 1):
        body = request(instance(seed)[:1], RADII[0], WAITS[0], budget)
        plans.append((body, service.post("/v1/plan", body)))
    low, high = 0.0, LARGEST_DELAY
    for _ in range(12):
        middle = (low + high) / 2
        low, high = (middle, high) if lone_rmse(service, middle, plans) < PAPER_RMSE else (low, middle)
    return high, lone_rmse(service, high, plans)


def measure(service, arguments, delay):
    """By radius and wait: planned instances, the share of safe runs, and flowtime over the ideal one."""
    cells = {}
    for radius in RADII:
        for wait in WAITS:
            cells[radius, wait] = measure_cell(service, arguments, delay, radius, wait)
    return cells


def measure_dependencies(service, arguments, delay):
    """The same of the smallest radius without waits, by margin, when robots obey dependencies."""
    return {margin: measure_cell(service, arguments, delay, RADII[0], WAITS[0], margin) for margin in MARGINS}


def measure_cell(service, arguments, delay, radius, wait, margin=None):
    """With a margin, robots obey dependencies; without, they follow the clock as far as their waits allow."""
    solved, safe, costs = 0, [], []
    for seed in range(1, arguments.instances + 1):
        ideal = service.post("/v1/plan", request(instance(seed), RADII[0], WAITS[0], arguments.budget))
        body = request(instance(seed), radius, wait, arguments.budget)
        if margin is not None:
            body["options"].update(inflation=margin, execution_margin=margin, interval_margin=INTERVAL_MARGIN,
                                   dependencies=True)
        answer = service.post("/v1/plan", body)
        if answer["status"] != "solved" or answer.get("tight"):
            continue
        solved += 1
        body["options"]["time_budget_ms"] = 120_000
        how = {"policy": "absorb_waits"} if margin is None else {
            "policy": "dependencies", "dependencies": answer["dependencies"]}
        figures = service.post("/v1/simulate", {**body, **how, "plans": answer["plans"], "runs": arguments.runs,
                                                "seed": seed, "disturbance": disturbance(delay)})
        safe.append(1.0 - figures["collision_share"] - figures["deadlock_share"])
        costs.append(figures["flowtime"]["mean"] / ideal["lower_bound"]["flowtime"])
    return {"solved": solved, "safe": mean(safe), "cost": mean(costs)}


def mean(values):
    return sum(values) / len(values) if values else None


def cost_of(cell):
    return "-" if cell["cost"] is None else decimal(cell["cost"], 2)


def percent_of(share):
    return "-" if share is None else decimal(100 * share, 0) + " %"


def report(cells, obeying, delay, rmse):
    head = ["radius, cm", "wait, s", "planned", "safe", "safe, paper", "flowtime / ideal", "paper"]
    rows = [[decimal(100 * radius, 0), decimal(wait, 0), str(cell["solved"]), percent_of(cell["safe"]),
             PAPER_SAFE.get((radius, wait), "-"), cost_of(cell), PAPER_COST.get((radius, wait), "-")]
            for (radius, wait), cell in cells.items()]
    rows += [[f"{decimal(100 * RADII[0], 0)} + {decimal(100 * margin, 0)}, dependencies", "0", str(cell["solved"]),
              percent_of(cell["safe"]), "-", cost_of(cell), "-"] for margin, cell in obeying.items()]
    return (f"Actions begin up to {decimal(delay, 2)} s late: one robot alone has an RMSE of "
            f"{decimal(100 * rmse, 2)} cm, in the paper {decimal(100 * PAPER_RMSE, 2)} cm.\n\n" +
            markdown.table(head, rows) +
            "\n\"planned\": instances of which every robot has a plan. \"ideal\": every robot alone, at full speed, "
            "without waits. With dependencies, robots wait for each other instead of for the clock; the second number is "
            "the margin.\n")


def make_parser():
    parser = argparse.ArgumentParser(
        prog="scripts/bench --lab", allow_abbrev=False,
        description="Plans six slow robots on the paper's polygon with several radii and waits, and executes the plans "
                    "with disturbances that are fitted to one robot of the paper.")
    add = parser.add_argument
    add("--instances", type=int, default=10, help="default 10")
    add("--runs", type=int, default=200, help="executions of each plan; default 200")
    add("--budget", type=float, default=20.0, metavar="SECONDS", help="time budget of a plan; default 20")
    add("--output", metavar="FOLDER", default=".", help="folder for the results, lab.json")
    return parser


def main(program, words):
    arguments = make_parser().parse_args(words)
    try:
        service = Service(program)
        delay, rmse = fitted_delay(service, arguments.budget)
        cells = measure(service, arguments, delay)
        obeying = measure_dependencies(service, arguments, delay)
    except (OSError, ValueError) as error:
        print(f"bench: {error}", file=sys.stderr)
        return 1
    results = [{"radius": radius, "wait": wait, **cell} for (radius, wait), cell in cells.items()]
    results += [{"radius": RADII[0], "wait": WAITS[0], "margin": margin, **cell} for margin, cell in obeying.items()]
    pathlib.Path(arguments.output).mkdir(parents=True, exist_ok=True)
    pathlib.Path(arguments.output, "lab.json").write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")
    print(report(cells, obeying, delay, rmse), end="")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2:]))
