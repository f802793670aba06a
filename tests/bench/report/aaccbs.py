#!/usr/bin/env python3
"""Comparison with AA-CCBS, the optimal any-angle planner, on its published instances. scripts/bench --aaccbs builds and
starts this.

Yakovlev, Andreychuk and Stern: Optimal and bounded suboptimal any-angle multi-agent pathfinding, IROS 2024. FOLDER has
the content of the branch AA-CCBS of the repository of Continuous-CBS. `Instances` has an archive of each map.
`ExpResults` has a workbook; each of its sheets has the results on one map. The archive of empty-16-16 is missing there
and comes from the branch master.

Usage: aaccbs.py PROGRAM [ARGUMENTS of scripts/bench --aaccbs...]
"""

import argparse
import json
import math
import pathlib
import re
import sys
import xml.etree.ElementTree as ET
import zipfile

import markdown
from arguments import between
from markdown import decimal
from measuring import measure
from results import Run, read_file
from summary import mean, percentile
from tables import closing_lines
from workbook import read_sheets

WORKBOOK = "ExpResults/AA-CCBS_raw_data.xlsx"
# Of the archive of a map, the first that is there, and in it the number of the scenario.
ARCHIVES = ["{}.zip", "{}-random.zip", "{}_random.zip"]
SCENARIO = re.compile(r"(?:.*/)?[^/]*-random-([0-9]+)\.xml")
# Columns of a variant in a sheet: scenario, number of robots, seconds, cost, expansions. Rows are solved instances.
COLUMNS = 5
OPTIMAL = "(1.0)"  # ends the names of variants whose costs are optimal; others allow more, such as (1.1)
LIMIT_S = 300  # of AA-CCBS
# Its disks of radius sqrt(2)/4 may touch, and turn in no time: here half a turn takes 31 microseconds. The radius is a
# little smaller, so that rounding does not forbid touching.
ROBOT = {"radius": math.floor(math.sqrt(2) / 4 * 1e8) / 1e8, "linear_speed": 1.0, "angular_speed": 1e5}
FIRST_BUDGET_S = 60.0
SOON_S = 1.0


def published(folder):
    """The costs that each variant reports: {map: {variant: {(scenario, robots): cost}}}."""
    return {sheet: variants(rows) for sheet, rows in read_sheets(pathlib.Path(folder, WORKBOOK)).items()}


def variants(rows):
    """Of the rows of a sheet: names of variants, names of columns, then results."""
    found = {}
    for column, name in rows[0].items():
        cells = [[row.get(column + number) for number in range(COLUMNS)] for row in rows[2:]]
        found[name] = {(int(scenario), int(robots)): float(cost)
                       for scenario, robots, _, cost, _ in cells if scenario is not None}
    return found


def best(found, optimal):
    """The least cost of the optimal variants, or of the others, by scenario and number of robots."""
    costs = {}
    for name, results in found.items():
        if name.endswith(OPTIMAL) == optimal:
            for instance, cost in results.items():
                costs[instance] = min(cost, costs.get(instance, math.inf))
    return costs


def archive(folder, name):
    for form in ARCHIVES:
        file = pathlib.Path(folder, "Instances", form.format(name))
        if file.exists():
            return file
    raise ValueError(f"{folder}/Instances has no archive of {name}")


def read_requests(file):
    """The requests of an archive by the number of the scenario, each with all its robots."""
    with zipfile.ZipFile(file) as opened:
        names = opened.namelist()
        grid = next((name for name in names if pathlib.PurePosixPath(name).name == "map.xml"), None)
        if grid is None:
            raise ValueError(f"{file} has no map.xml")
        rows = map_rows(opened.read(grid))
        found = {int(match[1]): name for name in names if (match := SCENARIO.fullmatch(name))}
        return {number: request(rows, opened.read(name)) for number, name in sorted(found.items())}


def map_rows(text):
    """The rows of a map as in requests, from the top; 0 is free."""
    grid = [row.text.split() for row in ET.fromstring(text).iter("row")]
    return ["".join("." if cell == "0" else "#" for cell in row) for row in grid]


def request(rows, text):
    """One cell is one metre; robots stand in the middle of cells. Row 0 is the top one."""
    def middle(agent, what):
        return {"x": int(agent.get(what + "_j")) + 0.5, "y": len(rows) - int(agent.get(what + "_i")) - 0.5}

    robots = [{"id": f"r{number}", "start": middle(agent, "start"), "goal": middle(agent, "goal")}
              for number, agent in enumerate(ET.fromstring(text).iter("agent"))]
    return {"map": {"rows": rows, "resolution": 1.0}, "robot_defaults": ROBOT, "robots": robots}


def counts_of(instances, scenario, largest):
    """The numbers of robots with which a scenario was solved; or only the largest."""
    counts = sorted(robots for number, robots in instances if number == scenario)
    return counts[-1:] if largest else counts


def jobs_of(name, requests, costs, arguments):
    """Two lists of jobs for fleetplan_bench. The first list is for first solutions, with every number of robots that
    AA-CCBS solved, and with one robot more. The second list is for `anytime`. It has no robot more, or only the largest
    numbers that the optimal and the other variants of AA-CCBS solved."""
    first, anytime = [], []
    for scenario, body in requests.items():
        solved = counts_of(costs["any"], scenario, False)
        if not solved:
            continue
        file = pathlib.Path(arguments.output, "aaccbs", f"{name}-{scenario}.json")
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(json.dumps(body), encoding="utf-8")
        more = [solved[-1] + 1] if solved[-1] < len(body["robots"]) else []
        improved = {count for kind in ("optimal", "bounded")
                    for count in counts_of(costs[kind], scenario, not arguments.every)}
        instance = {"name": f"{name}/{scenario}", "file": str(file)}
        first.append(job(instance, solved + more, "first", FIRST_BUDGET_S))
        anytime.append(job(instance, sorted(improved), "anytime", arguments.budget))
    return first, anytime


def job(instance, counts, mode, budget):
    return {**instance, "robots": counts, "budget": budget, "repeats": 1,
            "options": {"mode": mode, "time_budget_ms": math.ceil(1000 * budget)}}


def costs_by_kind(found):
    optimal, bounded = best(found, True), best(found, False)
    return {"optimal": optimal, "bounded": bounded, "any": {**optimal, **bounded}}


def instance_of(run):
    """The map of a run, and its scenario and number of robots."""
    name, _, scenario = run.file.rpartition("/")
    return name, (int(scenario), run.robots)


def ratios(runs, costs, kind):
    """Our flowtime over the published cost of each run that both solved."""
    found = []
    for run in runs:
        name, instance = instance_of(run)
        if run.solved and instance in costs[name][kind]:
            found.append(run.flowtime / costs[name][kind][instance])
    return found


def solved_soon(runs):
    """Runs solved within a second of CPU time: plans take one core, and other work may take its share of it."""
    return [run for run in runs if run.solved and run.cpu_seconds <= SOON_S]


def of(part, whole):
    return f"{len(part)} of {len(whole)}"


def most_solved(found, optimal):
    """The most instances that any of the optimal variants solved, or any of the others."""
    return max((len(results) for name, results in found.items() if name.endswith(OPTIMAL) == optimal), default=0)


def of_map(runs, name):
    return [run for run in runs if instance_of(run)[0] == name]


def solved_row(name, runs, found, costs):
    known = [run for run in runs if instance_of(run)[1] in costs["any"]]
    more = [run for run in runs if instance_of(run)[1] not in costs["any"]]
    return [name, str(len(costs["any"])), str(most_solved(found, True)), str(most_solved(found, False)),
            of(solved_soon(known), known), of(solved_soon(more), more),
            decimal(max((run.cpu_seconds for run in runs), default=None), 2)]


def solved_report(runs, found, costs):
    """First solutions beside what AA-CCBS solved within its limit."""
    rows = [solved_row(name, of_map(runs, name), found[name], costs[name]) for name in costs]
    known = [run for run in runs if instance_of(run)[1] in costs[instance_of(run)[0]]["any"]]
    more = [run for run in runs if run not in known]
    head = ["map", "AA-CCBS solved", "its best optimal variant", "its best other variant", "here", "one robot more",
            "longest s"]
    return (markdown.table(head, rows) +
            f"\nHere within {decimal(SOON_S, 0)} s of CPU time: {of(solved_soon(known), known)} that a variant of "
            f"AA-CCBS solved within {LIMIT_S} s, and {of(solved_soon(more), more)} with one robot more than any "
            "solved.\n")


def cost_cells(runs, costs, kind):
    """The number of compared runs, the mean and the largest ratio."""
    found = ratios(runs, costs, kind)
    return [str(len(found)), decimal(mean(found), 4), decimal(max(found, default=None), 4)]


def cost_report(title, runs, costs):
    """Our flowtimes over the best published ones."""
    rows = [[name, *cost_cells(each, costs, "optimal"), *cost_cells(each, costs, "bounded")]
            for name, each in [*((name, of_map(runs, name)) for name in costs), ("all", runs)]]
    head = [title, "optimal", "mean", "worst", "bounded", "mean", "worst"]
    spent = percentile([run.cpu_seconds for run in runs], 0.5)
    return (markdown.table(head, rows) + f"\nSolved: {of([run for run in runs if run.solved], runs)}; median CPU time "
            f"{decimal(spent, 2)} s.\n")


def report(first, anytime, found):
    costs = {name: costs_by_kind(each) for name, each in found.items()}
    parts = [solved_report(first, found, costs), cost_report("first solution / AA-CCBS", first, costs)]
    if anytime:
        parts.append(cost_report("anytime / AA-CCBS", anytime, costs))
    return "\n".join(parts) + "\n" + closing_lines([*first, *anytime])


def measure_all(program, found, arguments):
    first, anytime = [], []
    for name, each in found.items():
        requests = read_requests(archive(arguments.folder, name))
        jobs = jobs_of(name, requests, costs_by_kind(each), arguments)
        first += jobs[0]
        anytime += jobs[1]
    measure(program, first, arguments.first_csv)
    measure(program, anytime, arguments.anytime_csv)


def make_parser():
    parser = argparse.ArgumentParser(
        prog="scripts/bench --aaccbs", allow_abbrev=False,
        description="Plans the instances that AA-CCBS solved, and compares with the costs that it reports.")
    add = parser.add_argument
    add("folder", metavar="FOLDER", help="with Instances and ExpResults of its branch; the archive of empty-16-16 is "
                                         "that of the branch master")
    add("--budget", type=between(0.001, 3600.0, float), default=3.0, metavar="SECONDS",
        help="time budget of anytime; default 3")
    add("--every", action="store_true",
        help="anytime with every number of robots that AA-CCBS solved, instead of the largest of each scenario; hours")
    add("--maps", metavar="NAMES", help="only these, such as den312d,maze-32-32-4")
    add("--read", action="store_true", help="report the runs that are in the output folder instead of measuring")
    add("--output", metavar="FOLDER", default=".",
        help="folder for requests, and for the runs, aaccbs-first.csv and aaccbs-anytime.csv")
    return parser


def parse(words):
    arguments = make_parser().parse_args(words)
    arguments.first_csv = str(pathlib.Path(arguments.output, "aaccbs-first.csv"))
    arguments.anytime_csv = str(pathlib.Path(arguments.output, "aaccbs-anytime.csv"))
    return arguments


def chosen(found, names):
    """Only the named maps; all without names."""
    wanted = names.split(",") if names else list(found)
    if unknown := set(wanted) - set(found):
        raise ValueError(f"there are no results on {', '.join(sorted(unknown))}")
    return {name: found[name] for name in wanted}


def main(program, words):
    arguments = parse(words)
    try:
        found = chosen(published(arguments.folder), arguments.maps)
        if not arguments.read:
            measure_all(program, found, arguments)
        first, anytime = (read_file(file, Run) for file in (arguments.first_csv, arguments.anytime_csv))
    except (OSError, ValueError, zipfile.BadZipFile, ET.ParseError) as error:
        print(f"bench: {error}", file=sys.stderr)
        return 1
    print(report(first, anytime, found), end="")
    return 0 if all(run.valid for run in [*first, *anytime]) else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2:]))
