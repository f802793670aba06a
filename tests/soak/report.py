"""Shared by the reports of these programs: percentiles and the final verdict."""

import math


def percentile(values, share):
    """The smallest value that at least this share (0 to 1) of the values does not exceed; `values` is not empty."""
    ordered = sorted(values)
    return ordered[max(0, math.ceil(share * len(ordered)) - 1)]


def spread(values):
    """Median, 99th percentile and maximum; `values` is not empty."""
    ordered = sorted(values)
    return percentile(ordered, 0.5), percentile(ordered, 0.99), ordered[-1]


def verdict(failures):
    """Prints the failures, if any; returns the exit status of the program."""
    for failure in failures:
        print(f"FAILED: {failure}")
    return 1 if failures else 0
