"""Time against cells and robots on generated buildings of 5 cm, beside another planner's or commit's if it was run."""

import json
import pathlib
import sys

import markdown
from comparison import Comparison
from markdown import decimal, mebibytes, seconds
from summary import mean, percentile, summarise

sys.path.append(str(pathlib.Path(__file__).resolve().parents[2] / "support"))
from make_buildings import building_request  # noqa: E402  (of tests/support)

KIND = "office"
SIDES = [500, 1000, 2000, 4000]  # cells
ROBOTS = [10, 30, 60]
HEAD = ["cells", "robots", "solved", "median s", "parse s", "plan s", "check s", "write s", "MiB", "flowtime", "/ bound"]
REFERENCE_HEAD = ["reference solved", "reference s", "flowtime ratio"]


def building_jobs(seeds, folder, form, sides):
    """A job for each seed of each building; writes the requests that are not in the folder yet."""
    return [building_job(side, seed, pathlib.Path(folder), form) for side in sides for seed in seeds]


def building_job(side, seed, folder, form):
    file = folder / f"{KIND}-{side}-{seed}.{form}.json"
    if not file.exists():
        folder.mkdir(parents=True, exist_ok=True)
        part = file.with_suffix(".part")  # an interrupted run leaves no half request
        part.write_text(json.dumps(building_request(KIND, side, side, max(ROBOTS), seed, form)))
        part.rename(file)
    return {"name": f"{KIND}-{side}/{seed}", "file": str(file), "robots": ROBOTS}


def is_building(run):
    return run.file.startswith(KIND + "-")


def building_report(runs, reference):
    """A row for each size and number of robots."""
    rows = {}
    for run in filter(is_building, runs):
        rows.setdefault((int(run.file.removeprefix(KIND + "-").partition("/")[0]), run.robots), []).append(run)
    beside = any(map(is_building, reference))
    table = [row(side, group, reference, beside) for (side, _), group in rows.items()]
    return "Buildings of 5 cm cells:\n\n" + markdown.table(HEAD + (REFERENCE_HEAD if beside else []), table)


def row(side, runs, reference, beside):
    summary = summarise(runs)
    steps = [percentile([value for run in runs if (value := getattr(run, step)) is not None], 0.5)
             for step in ("parse_seconds", "plan_seconds", "verify_seconds", "write_seconds")]
    made = [f"{side} x {side}", str(summary.robots), f"{summary.solved} of {summary.runs}",
            seconds(summary.median_seconds), *map(seconds, steps), mebibytes(summary.peak_memory),
            decimal(summary.flowtime, 1), decimal(summary.flowtime_by_bound, 3)]
    if beside:
        pairs = Comparison(runs, reference).pairs
        made += [f"{sum(pair.reference.solved for pair in pairs)} of {len(pairs)}",
                 seconds(percentile([pair.reference.seconds for pair in pairs], 0.5)),
                 decimal(mean([pair.flowtime_ratio for pair in pairs if pair.both_solved]), 3)]
    return made
