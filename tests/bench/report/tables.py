"""The reports as text."""

import markdown
from comparison import SHORTEST_REFERENCE_S
from jobs import HALLS
from markdown import decimal, mebibytes, percent, seconds, times
from paper import CLAIMS, claimed_success
from summary import mean

# Below this share of CPU time in wall time, other work disturbed the times.
IDLE_SHARE = 0.95

HALL_NOTES = """\
Seconds are of all runs, from parsing to writing; flowtime and makespan are means of the solved ones.
"/ bound" is the flowtime or the makespan over its lower bound: the sum or the maximum of bounds for each robot alone
on the map.
"""


def hall_table(hall, summaries):
    """A hall of the paper: success rate beside the paper's, times and costs by number of robots."""
    rows = [[str(summary.robots), percent(summary.success_rate), claimed_success(hall, summary.robots),
             seconds(summary.median_seconds), seconds(summary.percentile_90_seconds),
             seconds(summary.longest_seconds), decimal(summary.flowtime, 0), decimal(summary.flowtime_by_bound, 3),
             decimal(summary.makespan, 1), decimal(summary.makespan_by_bound, 3), mebibytes(summary.peak_memory)] for summary in summaries]
    return markdown.table([f"{hall}: robots", "solved", "paper", "median s", "90 % s", "max s", "flowtime", "/ bound",
                           "makespan", "/ bound", "MiB"], rows)


def hall_report(halls):
    """The tables of summaries by hall, and what the paper claims of its own."""
    tables = [hall_table(hall, summaries) for hall, summaries in halls.items()]
    return "\n".join([*tables, HALL_NOTES, *([CLAIMS] if set(halls) & set(HALLS) else [])])


def run_report(runs):
    """A row for each run."""
    rows = [[run.file, str(run.robots), str(run.planned), seconds(run.seconds), str(run.attempts),
             str(run.expansions), mebibytes(run.peak_memory), decimal(run.flowtime, 1),
             decimal(run.flowtime_by_bound, 3), decimal(run.makespan, 1), decimal(run.makespan_by_bound, 3)]
            for run in runs]
    return markdown.table(["file", "robots", "planned", "s", "attempts", "expansions", "MiB", "flowtime", "/ bound",
                           "makespan", "/ bound"], rows)


def comparison_report(comparison):
    """A row for each run beside the reference's, and the totals."""
    def measured(result):
        return seconds(result.seconds) + ("" if result.solved else " failed")

    rows = [[pair.ours.file, str(pair.ours.robots), measured(pair.reference), measured(pair.ours),
             times(pair.speedup), decimal(pair.reference.flowtime, 1), decimal(pair.ours.flowtime, 1),
             decimal(pair.flowtime_ratio, 3), decimal(pair.ours.flowtime_by_bound, 3)] for pair in comparison.pairs]
    table = markdown.table(["file", "robots", "reference s", "s", "speed-up", "reference flowtime", "flowtime",
                            "ratio", "/ bound"], rows)
    return table + "\n" + comparison_totals(comparison)


def comparison_totals(comparison):
    """Both planners on all rows."""
    by_bound = [pair.ours.flowtime_by_bound for pair in comparison.pairs if pair.ours.flowtime_by_bound is not None]
    return f"""\
solved: {comparison.solved_by_us} of {len(comparison.pairs)}, the reference {comparison.solved_by_reference}, \
only the reference {comparison.solved_only_by_reference}
speed-up where the reference took {SHORTEST_REFERENCE_S} s or more ({comparison.counted} rows): \
geometric mean {times(comparison.mean_speedup)}, smallest {times(comparison.smallest_speedup)}
flowtime ratio: mean {decimal(comparison.mean_flowtime_ratio, 3)}, largest \
{decimal(comparison.largest_flowtime_ratio, 3)}
flowtime / bound: mean {decimal(mean(by_bound), 3)}, largest {decimal(max(by_bound, default=None), 3)}
"""


def closing_lines(runs):
    """Totals of all runs: invalid answers, memory, and whether the machine was busy."""
    invalid = sum(not run.valid for run in runs)
    wall = sum(run.seconds for run in runs)
    cpu = sum(run.cpu_seconds for run in runs)
    busy = ": the machine was busy, and an idle one is faster" if cpu < IDLE_SHARE * wall else ""
    return (f"Plans: {len(runs)}, all checked in continuous time; invalid: {invalid}.\n"
            f"Peak resident memory {mebibytes(max((run.peak_memory for run in runs), default=0))} MiB. "
            f"Wall time {seconds(wall)} s, CPU time {seconds(cpu)} s{busy}.\n")
