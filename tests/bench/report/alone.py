"""The time of planning a fleet over the time of planning each of its robots alone on the static map."""

import markdown
from markdown import decimal, percent, seconds, times
from summary import geometric_mean, grouped, mean, percentile

HEAD = ["instances", "robots", "floor", "solved", "plan s", "alone s", "ratio", "longest"]


def alone_report(runs):
    """A row for every hall or file and number of robots; empty if no robots were planned alone."""
    rows = [row(name, robots, group) for (name, robots), group in grouped(runs).items()
            if all(run.alone_seconds for run in group)]
    if not rows:
        return ""
    return f"""Planning together, and each robot alone on the static map:

{markdown.table(HEAD, rows)}
"floor" is the share of the free floor that the disks cover; the ratio of seconds is a geometric mean. Neither time has
parsing, checking and writing.

"""


def row(name, robots, runs):
    ratios = [run.plan_seconds / run.alone_seconds for run in runs]
    return [name, str(robots), percent(mean([run.floor_share for run in runs])),
            f"{sum(run.solved for run in runs)} of {len(runs)}",
            *(seconds(percentile([getattr(run, field) for run in runs], 0.5))
              for field in ("plan_seconds", "alone_seconds")),
            times(geometric_mean(ratios)), times(max(ratios))]
