#!/usr/bin/env python3
"""Runs fleetplan_bench and reports what it measures; scripts/bench builds and starts both.

Usage: bench.py PROGRAM [ARGUMENTS of scripts/bench...]
"""

import pathlib
import sys

import chart
from alone import alone_report
from arguments import parse, request_options
from beside import beside_report
from building_scaling import building_jobs, building_report, is_building
from comparison import Comparison
from jobs import (file_jobs, hall_jobs, named_workload, reference_jobs, single_jobs,
                  within_reference_times)
from measuring import measure, measure_in_turn
from results import Run, read_file
from scaling import scaling_jobs, scaling_report
from summary import summarise_halls
from tables import closing_lines, comparison_report, comparison_totals, hall_report, run_report


def jobs_of(arguments, reference, form="png"):
    """The jobs. `form`: the form of the maps of buildings."""
    if arguments.buildings:
        return buildings_of(arguments, form)
    if arguments.scaling:
        return scaling_jobs(arguments.seeds) + buildings_of(arguments, form)
    if arguments.reference:
        jobs = reference_jobs(arguments.inputs, arguments.robots, reference, arguments.root)
        return within_reference_times(jobs, reference) if arguments.reference_budget else jobs
    if arguments.inputs:
        return file_jobs(arguments.inputs, arguments.robots)
    return hall_jobs(arguments.halls, arguments.seeds, arguments.robots)


def buildings_of(arguments, form):
    return building_jobs(arguments.seeds, pathlib.Path(arguments.output, "buildings"), form, arguments.sides)


def with_options(jobs, arguments):
    """The jobs with all that fleetplan_bench has to know."""
    def complete(job):
        budget = job.get("budget", arguments.budget)
        return {**job, "budget": budget, "options": request_options(arguments, budget), "repeats": arguments.repeat,
                "robot_defaults": arguments.robot_defaults, "alone": arguments.alone}
    return [complete(job) for job in jobs]


def measure_all(program, arguments, reference):
    jobs = with_options(jobs_of(arguments, reference), arguments)
    if not arguments.binary:
        measure(program, jobs, arguments.csv)
        return
    other = str(pathlib.Path(arguments.binary).resolve())
    other_jobs = with_options(jobs_of(arguments, reference, "rows"), arguments)  # a form that every commit reads
    measure_in_turn(program, single_jobs(jobs), arguments.csv, other, single_jobs(other_jobs), arguments.binary_csv)


def report(runs, others, reference, arguments):
    parts = [main_report(runs, others or reference, reference, arguments)]
    if others and reference:
        parts.append("The other program against the reference:\n\n" + comparison_totals(Comparison(others, reference)))
    if others and not arguments.buildings:
        parts.append(beside_report([run for run in runs if not is_building(run)], others))
    return "\n".join(parts) + "\n" + alone_report(runs)


def main_report(runs, beside, reference, arguments):
    if arguments.buildings:
        return building_report(runs, beside)
    if arguments.scaling:
        halls = [run for run in runs if not is_building(run)]
        return scaling_report(halls, arguments.seeds) + "\n" + building_report(runs, beside)
    if arguments.reference:
        return comparison_report(Comparison(runs, reference))
    return hall_report(summarise_halls(runs)) if are_generated(runs) else run_report(runs)


def are_generated(runs):
    return all(named_workload(run.file, ()) for run in runs)


def main(program, words):
    arguments = parse(words)
    try:
        reference = read_file(arguments.reference) if arguments.reference else []
        if not arguments.read:
            measure_all(program, arguments, reference)
        runs = read_file(arguments.read or arguments.csv, Run)
        others = read_file(arguments.binary_csv, Run) if arguments.binary else []
        if arguments.svg and not are_generated(runs):
            raise ValueError("only the paper's workloads have a chart")
    except (OSError, ValueError) as error:
        print(f"bench: {error}", file=sys.stderr)
        return 1
    print(report(runs, others, reference, arguments), end="")
    print(closing_lines(runs), end="")
    if arguments.svg:
        chart.draw(chart.hall_panels(summarise_halls(runs)), arguments.svg)
    return 0 if all(run.valid for run in runs) else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2:]))
