"""Shared by the tests of this folder."""

from results import Result, Run


def result(file, robots, seconds, flowtime=None):
    return Result(file, robots, flowtime is not None, 1, seconds, flowtime, flowtime)


def run(robots, seconds, flowtime=None, file="empty/1", **more):
    """A run that solved its instance if it has a flowtime; the makespan is a tenth of it, its lower bound 100."""
    costs = {"makespan": None} if flowtime is None else {"makespan": flowtime / 10, "lower_bound": 100.0}
    return Run(**{"file": file, "robots": robots, "solved": flowtime is not None, "attempts": 1, "seconds": seconds,
                  "flowtime": flowtime, "cpu_seconds": seconds, **costs, **more})
