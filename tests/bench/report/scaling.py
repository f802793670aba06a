"""Time and cost against the number of robots, and against the size of the map."""

import itertools

import markdown
from jobs import HALLS, PAPER_SIDE, workload
from markdown import decimal, mebibytes, seconds
from summary import summarise

ROBOTS = [10, 25, 50, 100, 200, 300]
SIDES = [32, 64, 128, 256, 512]  # cells
FEW_ROBOTS = 50  # on every map; the smallest still leaves them room to move
DENSE_SIDES = [32, 64, 128, 256]
DENSITY = 60  # robots for PAPER_SIDE x PAPER_SIDE cells


def size(side):
    return f"{side} x {side}"


def dense_robots(side):
    return DENSITY * side * side // PAPER_SIDE**2


# Of each table: title, names of the first columns, and rows as (texts of the first columns, side, robots).
TABLES = [
    (f"Robots on {size(PAPER_SIDE)} cells:", ["robots"],
     [([str(robots)], PAPER_SIDE, robots) for robots in ROBOTS]),
    (f"{FEW_ROBOTS} robots on maps of other sizes:", ["cells"],
     [([size(side)], side, FEW_ROBOTS) for side in SIDES]),
    ("Maps of other sizes, with as many robots per cell:", ["cells", "robots"],
     [([size(side), str(dense_robots(side))], side, dense_robots(side)) for side in DENSE_SIDES]),
]
HEAD = [f"{hall} {column}" for hall in HALLS for column in ("solved", "median s", "/ bound", "MiB")]


def scaling_jobs(seeds):
    """A job for each seed of each hall of each row, in the order of the tables."""
    return [workload(f"{hall}-{side}/{seed}", hall, side, seed, robots)
            for _, _, rows in TABLES for _, side, robots in rows for hall in HALLS for seed in seeds]


def scaling_report(runs, seeds):
    """The tables of the runs of scaling_jobs."""
    batches = iter(runs)

    def cells():
        summary = summarise(list(itertools.islice(batches, len(seeds))))
        return [f"{summary.solved} of {summary.runs}", seconds(summary.median_seconds),
                decimal(summary.flowtime_by_bound, 3), mebibytes(summary.peak_memory)]

    return "\n".join(f"{title}\n\n" + markdown.table(
        first + HEAD, [sum((cells() for _ in HALLS), start=list(texts)) for texts, _, _ in rows])
        for title, first, rows in TABLES)
