"""What to measure: jobs for fleetplan_bench, see tests/bench/job.h."""

import json
import os
import pathlib
import re

from comparison import SHORTEST_REFERENCE_S

HALLS = ["empty", "rects"]
PAPER_SIDE = 64  # cells
PAPER_ROBOTS = 300
# Of each hall: cells of a side, and robots of which an instance has the first ones.
SIZES = {**{hall: (PAPER_SIDE, PAPER_ROBOTS) for hall in HALLS}, "crowd": (32, 512)}


def workload(name, hall, side, seed, robots, counts=()):
    return {"name": name, "workload": {"hall": hall, "side": side, "seed": seed, "robots": robots},
            "robots": list(counts)}


def named_workload(name, counts):
    """The job of the workload with a name such as "empty/1"; None for any other name."""
    found = re.fullmatch(f"({'|'.join(SIZES)})/([0-9]+)", name)
    if not found:
        return None
    side, robots = SIZES[found[1]]
    return workload(name, found[1], side, int(found[2]), robots, counts)


def hall_jobs(halls, seeds, counts):
    """The halls, seed by seed."""
    return [named_workload(f"{hall}/{seed}", counts) for seed in seeds for hall in halls]


def is_request(file):
    try:
        document = json.loads(file.read_bytes())
    except ValueError:
        raise ValueError(f"{file} is not JSON") from None
    return isinstance(document, dict) and "map" in document and isinstance(document.get("robots"), list)


def request_files(paths):
    """Each file itself, and all request files of a folder, at any depth and sorted by name."""
    files = []
    for path in map(pathlib.Path, paths):
        if path.is_dir():
            files += sorted(file for file in path.rglob("*.json") if is_request(file))
        elif path.exists():
            files.append(path)
        else:
            raise ValueError(f"{path} does not exist")
    return files


def file_jobs(paths, counts):
    return [{"name": file.as_posix(), "file": str(file), "robots": list(counts)} for file in request_files(paths)]


def reference_jobs(paths, counts, reference, root):
    """The instances of the reference, or only the instances of the given files. The numbers of robots are the
    reference's, unless others are given. The reference names files relative to `root`."""
    robots = {}
    for result in reference:
        robots.setdefault(result.file, []).append(result.robots)
    if paths:
        files = {reference_name(file, root): file for file in request_files(paths)}
    else:
        files = {name: pathlib.Path(root, name) for name in robots}
    return [reference_job(name, file, counts or robots.get(name, [])) for name, file in files.items()]


def reference_name(file, root):
    """The file's path relative to the root, or as it was given if it is not below the root."""
    relative = pathlib.Path(os.path.relpath(file, root))
    return file.as_posix() if ".." in relative.parts else relative.as_posix()


def reference_job(name, file, counts):
    if file.exists():
        return {"name": name, "file": str(file), "robots": list(counts)}
    job = named_workload(name, counts)
    if job is None:
        raise ValueError(f"{file}, which the reference names, does not exist")
    return job


def single_jobs(jobs):
    """The same with a job for each number of robots."""
    return [{**job, "robots": counts} for job in jobs for counts in ([[n] for n in job["robots"]] or [[]])]


def within_reference_times(jobs, reference):
    """A job for each row of the reference that it solved and that took it long enough, with its seconds as the
    budget."""
    seconds = {(result.file, result.robots): result.seconds
               for result in reversed(reference) if result.solved and result.seconds >= SHORTEST_REFERENCE_S}
    return [{**job, "budget": seconds[job["name"], *job["robots"]]} for job in single_jobs(jobs)
            if (job["name"], *job["robots"]) in seconds]
