#!/usr/bin/env python3
"""Runs fleetplan_bench and reports what it measures; scripts/bench builds and starts both.

Usage: bench.py PROGRAM [ARGUMENTS of scripts/bench...]
"""

import json
import pathlib
import subprocess
import sys
import threading

import chart
from arguments import parse, request_options
from building_scaling import building_jobs, building_report, is_building
from comparison import Comparison
from jobs import file_jobs, hall_jobs, named_workload, reference_jobs
from results import Run, read_file
from scaling import scaling_jobs, scaling_report
from summary import summarise_halls
from tables import closing_lines, comparison_report, hall_report, run_report


def jobs_of(arguments, reference):
    if arguments.buildings:
        return buildings_of(arguments, "png")
    if arguments.scaling:
        return scaling_jobs(arguments.seeds) + buildings_of(arguments, "png")
    if arguments.reference:
        return reference_jobs(arguments.inputs, arguments.robots, reference, arguments.root)
    if arguments.inputs:
        return file_jobs(arguments.inputs, arguments.robots)
    return hall_jobs(arguments.halls, arguments.seeds, arguments.robots)


def buildings_of(arguments, form):
    return building_jobs(arguments.seeds, pathlib.Path(arguments.output, "buildings"), form, arguments.sides)


def measure(program, jobs, arguments, file):
    """Measures the jobs. Writes every row to the CSV file as soon as it arrives."""
    how = {"options": request_options(arguments), "budget": arguments.budget, "repeats": arguments.repeat}
    text = "".join(json.dumps({**job, **how}) + "\n" for job in jobs)
    pathlib.Path(file).parent.mkdir(parents=True, exist_ok=True)
    with open(file, "w", encoding="utf-8") as csv, \
            subprocess.Popen([program], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
        feeder = threading.Thread(target=feed, args=(process.stdin, text))
        feeder.start()
        for row in process.stdout:
            csv.write(row)
            csv.flush()
        feeder.join()
    if process.returncode != 0:
        raise ValueError("the measurement failed")


def feed(stdin, text):
    try:
        with stdin:
            stdin.write(text)
    except BrokenPipeError:
        pass  # the program ended; its exit status is checked


def report(runs, reference, arguments):
    if arguments.buildings:
        return building_report(runs, reference)
    if arguments.scaling:
        halls = [run for run in runs if not is_building(run)]
        return scaling_report(halls, arguments.seeds) + "\n" + building_report(runs, reference)
    if arguments.reference:
        return comparison_report(Comparison(runs, reference))
    return hall_report(summarise_halls(runs)) if are_of_paper(runs) else run_report(runs)


def are_of_paper(runs):
    return all(named_workload(run.file, ()) for run in runs)


def main(program, words):
    arguments = parse(words)
    try:
        if arguments.binary:
            other = str(pathlib.Path(arguments.binary).resolve())
            jobs = buildings_of(arguments, "rows")  # which every commit reads
            measure(other, jobs, arguments, arguments.reference)
        reference = read_file(arguments.reference) if arguments.reference else []
        if not arguments.read:
            measure(program, jobs_of(arguments, reference), arguments, arguments.csv)
        runs = read_file(arguments.read or arguments.csv, Run)
        if arguments.svg and not are_of_paper(runs):
            raise ValueError("only the paper's workloads have a chart")
    except (OSError, ValueError) as error:
        print(f"bench: {error}", file=sys.stderr)
        return 1
    print(report(runs, reference, arguments))
    print(closing_lines(runs), end="")
    if arguments.svg:
        chart.draw(chart.hall_panels(summarise_halls(runs)), arguments.svg)
    return 0 if all(run.valid for run in runs) else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2:]))
