#!/usr/bin/env python3
"""The cost of idle robots that make way for others, and of goals that are interchangeable, beside TSWAP. scripts/bench
--goals starts it.

Usage: goals.py PROGRAM [ARGUMENTS of scripts/bench --goals...]
"""

import argparse
import collections
import pathlib
import statistics
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parents[2] / "clients/python"), str(HERE.parents[1] / "python"), str(HERE)]

from fleetplan import Client  # noqa: E402
from formations import formation, map_of, read_result, tswap_instance  # noqa: E402
from support import service  # noqa: E402
from warehouses import make_warehouse  # noqa: E402

LEAST_SUM = "-m", "3"  # of TSWAP: the assignment with the least sum of distances, not with the least longest one first


def flowtime_of(answer, ids):
    return sum(plan["cost"] for plan in answer["plans"] if plan["robot"] in ids)


def idle_robots(client, options, count):
    """Warehouses with and without idle robots: the cost of the others, and why robots have no plan. Returns whether none
    was blocked by robots."""
    ratios, moved, reasons = [], 0, collections.Counter()
    for seed in range(1, count + 1):
        request = make_warehouse(seed)
        workers = [robot for robot in request["robots"] if "goal" in robot]
        ids = {robot["id"] for robot in workers}
        alone = client.plan({**request, "robots": workers, "options": options})
        among = client.plan({**request, "options": options})
        reasons.update(each["reason"] for each in among["unplanned"])
        if alone["unplanned"] or among["unplanned"]:
            print(f"  seed {seed}: {len(alone['unplanned'])} robots without a plan, {len(among['unplanned'])} with idle "
                  "ones", file=sys.stderr)
            continue
        ratios.append(flowtime_of(alone, ids) / flowtime_of(among, ids))
        moved += sum(1 for plan in among["plans"] if plan["robot"] not in ids and plan["actions"])
    print(f"\n{len(ratios)} of {count} warehouses with 30 % idle robots solved both ways, {moved} idle robots moved")
    print("throughput of the others, over that without idle robots: "
          f"mean {statistics.mean(ratios):.4f}, median {statistics.median(ratios):.4f}, least {min(ratios):.4f}")
    print(f"robots without a plan, by reason: {dict(reasons) or 'none'}")
    return reasons["blocked_by_robots"] == 0


def interchangeable_goals(client, options, program, maps, fleets, seeds):
    """The same starts and goals for TSWAP, of the authors' program, and here. Returns whether all were planned."""
    print("\nflowtime of interchangeable goals on 4-connected grids, equal disks, mean over seeds\n")
    print("| map | robots | TSWAP | here | here / TSWAP | solved |\n|---|---|---|---|---|---|")
    complete = True
    for path in maps:
        grid = map_of(path)
        for robots in fleets:
            theirs, ours = [], []
            for seed in range(1, seeds + 1):
                problem = formation(grid, robots, seed)
                with tempfile.TemporaryDirectory() as folder:
                    files = pathlib.Path(folder, "instance.txt"), pathlib.Path(folder, "result.txt")
                    files[0].write_text(tswap_instance(path, problem), encoding="ascii")
                    subprocess.run([program, "-i", files[0], "-o", files[1], "-s", "TSWAP", *LEAST_SUM], check=True,
                                   stdout=subprocess.DEVNULL)
                    costs = read_result(files[1].read_text(encoding="ascii"))
                answer = client.plan({**problem.request, "options": options})
                if answer["status"] != "solved":
                    complete = False
                    continue
                theirs.append(costs)
                ours.append(answer["flowtime"])
            name = f"| {path.stem} | {robots} "
            if not ours:
                print(f"{name}| | | | 0 of {seeds} |")
                continue
            mine, other = statistics.mean(ours), statistics.mean(theirs)
            print(f"{name}| {other:.0f} | {mine:.0f} | {mine / other:.3f} | {len(ours)} of {seeds} |", flush=True)
    return complete


def main():
    parser = argparse.ArgumentParser(prog="scripts/bench --goals", description="Idle robots and interchangeable goals.")
    parser.add_argument("program", help=argparse.SUPPRESS)
    parser.add_argument("--output", help=argparse.SUPPRESS)
    parser.add_argument("--warehouses", type=int, default=100, help="with idle robots (default: 100)")
    parser.add_argument("--budget", type=float, default=10.0, help="seconds of a plan (default: 10)")
    parser.add_argument("--mode", choices=["first", "anytime"], default="first")
    parser.add_argument("--iterations", type=int, help="of anytime")
    parser.add_argument("--grid", action="store_true", help="robots drive in four directions only, as those of TSWAP")
    parser.add_argument("--tswap", metavar="PROGRAM", help="app of github.com/Kei18/tswap, to compare with")
    parser.add_argument("--maps", type=pathlib.Path, nargs="*", default=[], help="of MovingAI, which it finds, too")
    parser.add_argument("--robots", default="20,40,70", help="with interchangeable goals, 100 at most")
    parser.add_argument("--seeds", type=int, default=10, help="of each map and number of robots")
    arguments = parser.parse_args()
    options = {"mode": arguments.mode, "time_budget_ms": 1000.0 * arguments.budget}
    if arguments.grid:
        options |= {"any_angle": False, "connectivity": 4}
    if arguments.iterations is not None:
        options["max_iterations"] = arguments.iterations
    with service(arguments.program) as url, Client(url, timeout=arguments.budget + 60.0) as client:
        good = arguments.warehouses == 0 or idle_robots(client, options, arguments.warehouses)
        if arguments.tswap:
            fleets = [int(each) for each in arguments.robots.split(",")]
            good = interchangeable_goals(client, options, arguments.tswap, arguments.maps, fleets,
                                         arguments.seeds) and good
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
