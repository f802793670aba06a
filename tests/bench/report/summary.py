"""Summaries of many runs with the same number of robots."""

import collections
import dataclasses
import math
import re
import statistics


def percentile(values, share):
    """The value below which a share (0 to 1) of the values lies, linear between neighbours; None without values."""
    if not values:
        return None
    ordered = sorted(values)
    rank = share * (len(ordered) - 1)
    below, above = ordered[math.floor(rank)], ordered[math.ceil(rank)]
    return below + (above - below) * (rank - math.floor(rank))


def mean(values):
    """The arithmetic mean; None without values."""
    return statistics.fmean(values) if values else None


def geometric_mean(values):
    """Of positive values; None without any."""
    return statistics.geometric_mean(values) if values else None


@dataclasses.dataclass(frozen=True)
class Summary:
    robots: int
    runs: int
    solved: int
    # Seconds of all runs, including runs that solved nothing.
    median_seconds: float
    percentile_90_seconds: float
    longest_seconds: float
    peak_memory: int  # bytes, of all runs
    # Means of the solved runs; None without any.
    flowtime: float | None
    makespan: float | None
    flowtime_by_bound: float | None
    makespan_by_bound: float | None

    @property
    def success_rate(self):
        return self.solved / self.runs


def summarise(runs):
    """The summary of at least one run, all with the same number of robots."""
    seconds = [run.seconds for run in runs]
    solved = [run for run in runs if run.solved]
    return Summary(
        robots=runs[0].robots, runs=len(runs), solved=len(solved), median_seconds=percentile(seconds, 0.5),
        percentile_90_seconds=percentile(seconds, 0.9), longest_seconds=max(seconds),
        peak_memory=max(run.peak_memory for run in runs), flowtime=mean([run.flowtime for run in solved]),
        makespan=mean([run.makespan for run in solved]),
        flowtime_by_bound=mean([run.flowtime_by_bound for run in solved if run.flowtime_by_bound is not None]),
        makespan_by_bound=mean([run.makespan_by_bound for run in solved if run.makespan_by_bound is not None]))


def grouped(runs):
    """The runs by their instances and numbers of robots: of generated ones named HALL/SEED by the hall, of others by
    the file."""
    groups = collections.defaultdict(list)
    for run in runs:
        generated = re.fullmatch(r"([a-z0-9-]+)/[0-9]+", run.file)
        groups[generated[1] if generated else run.file, run.robots].append(run)
    return groups


def summarise_by_robots(runs):
    """A summary for every number of robots, ascending."""
    groups = collections.defaultdict(list)
    for run in runs:
        groups[run.robots].append(run)
    return [summarise(groups[robots]) for robots in sorted(groups)]


def summarise_halls(runs):
    """The summaries of every hall by its name, for runs of workloads named HALL/SEED."""
    groups = collections.defaultdict(list)
    for run in runs:
        groups[run.file.partition("/")[0]].append(run)
    return {hall: summarise_by_robots(groups[hall]) for hall in sorted(groups)}
