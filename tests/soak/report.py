"""What the reports of these programs have in common: percentiles, and the verdict at the end."""

import math


def percentile(values, share):
    """The least of the values, of which there is one at least, that so large a share of them does not exceed."""
    ordered = sorted(values)
    return ordered[max(0, math.ceil(share * len(ordered)) - 1)]


def spread(values):
    """Median, 99th percentile and maximum of one value at least."""
    ordered = sorted(values)
    return percentile(ordered, 0.5), percentile(ordered, 0.99), ordered[-1]


def verdict(failures):
    """Prints what failed, if anything did; the exit status of the program."""
    for failure in failures:
        print(f"FAILED: {failure}")
    return 1 if failures else 0
