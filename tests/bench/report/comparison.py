"""Runs beside the results of a reference on the same instances."""

import dataclasses

from results import Result
from summary import geometric_mean, mean

# Speed-ups count only where the reference took at least this long (seconds): below it, process start and the
# resolution of the clock matter too much.
SHORTEST_REFERENCE_S = 0.2


@dataclasses.dataclass(frozen=True)
class Pair:
    """Two results for the same file and number of robots."""
    ours: Result
    reference: Result

    @property
    def both_solved(self):
        return self.ours.solved and self.reference.solved

    @property
    def speedup(self):
        """The reference's seconds over ours; None unless both solved the instance."""
        return self.reference.seconds / self.ours.seconds if self.both_solved else None

    @property
    def flowtime_ratio(self):
        """Our flowtime over the reference's, so below 1 is better; None unless both solved the instance."""
        return self.ours.flowtime / self.reference.flowtime if self.both_solved else None


class Comparison:
    """The pairs in the order of our runs, without runs that the reference does not contain."""

    def __init__(self, ours, reference):
        found = {(result.file, result.robots): result for result in reversed(reference)}
        self.pairs = [Pair(run, found[run.file, run.robots]) for run in ours if (run.file, run.robots) in found]
        self.solved_by_us = sum(pair.ours.solved for pair in self.pairs)
        self.solved_by_reference = sum(pair.reference.solved for pair in self.pairs)
        self.solved_only_by_reference = sum(pair.reference.solved and not pair.ours.solved for pair in self.pairs)
        solved = [pair for pair in self.pairs if pair.both_solved]
        speedups = [pair.speedup for pair in solved if pair.reference.seconds >= SHORTEST_REFERENCE_S]
        self.counted = len(speedups)
        self.smallest_speedup = min(speedups, default=None)
        self.mean_speedup = geometric_mean(speedups)
        ratios = [pair.flowtime_ratio for pair in solved]
        self.mean_flowtime_ratio = mean(ratios)
        self.largest_flowtime_ratio = max(ratios, default=None)
