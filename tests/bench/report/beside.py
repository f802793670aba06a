"""Two programs side by side on the same instances."""

import markdown
from comparison import Comparison
from markdown import decimal, seconds, times
from summary import geometric_mean, grouped, mean, percentile

HEAD = ["instances", "robots", "solved", "other", "median s", "other s", "speed-up", "/ bound", "other / bound",
        "flowtime ratio"]


def beside_report(runs, others):
    """A row for every hall or file and number of robots, and one for all."""
    rows = [row(name, str(robots), group, others) for (name, robots), group in grouped(runs).items()]
    table = markdown.table(HEAD, [*rows, row("all", "", runs, others)])
    invalid = sum(not run.valid for run in others)
    return f"""Beside the other program, in turn:

{table}
Speed-ups and flowtime ratios are geometric means over the instances that both solved: the other's seconds over these,
and this flowtime over the other's. Invalid plans of the other program: {invalid}.
"""


def row(name, robots, runs, others):
    pairs = Comparison(runs, others).pairs
    sides = [[pair.ours for pair in pairs], [pair.reference for pair in pairs]]
    both = [pair for pair in pairs if pair.both_solved]
    bounds = [mean([side.flowtime_by_bound for side in of if side.flowtime_by_bound is not None])
              for of in ([pair.ours for pair in both], [pair.reference for pair in both])]
    return [name, robots, *(f"{sum(run.solved for run in side)} of {len(side)}" for side in sides),
            *(seconds(percentile([run.seconds for run in side], 0.5)) for side in sides),
            times(geometric_mean([pair.speedup for pair in both])), *(decimal(bound, 3) for bound in bounds),
            decimal(geometric_mean([pair.flowtime_ratio for pair in both]), 4)]
