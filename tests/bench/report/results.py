"""Results of planning runs as CSV, one row for each run.

Results of any planner have the columns file, robots, solved, attempts, seconds, flowtime and makespan. So a file that
fleetplan_bench wrote can be the reference of a later run. Values contain no commas.
"""

import csv
import dataclasses


@dataclasses.dataclass(frozen=True)
class Result:
    """What any planner reached on an instance. Times and costs are in seconds; costs only if solved."""
    file: str
    robots: int
    solved: bool
    attempts: int
    seconds: float
    flowtime: float | None
    makespan: float | None


@dataclasses.dataclass(frozen=True)
class Run(Result):
    """What Fleetplan reached."""
    cpu_seconds: float = 0.0
    peak_memory: int = 0  # bytes
    planned: int = 0  # robots with a plan
    lower_bound: float | None = None  # of the flowtime
    expansions: int = 0
    improvements: int = 0
    deterministic: bool = False
    valid: bool = True
    # The steps of a response; None if the file does not have them.
    parse_seconds: float | None = None
    plan_seconds: float | None = None
    verify_seconds: float | None = None
    write_seconds: float | None = None
    makespan_lower_bound: float | None = None
    # None unless every robot was also planned alone.
    alone_seconds: float | None = None
    floor_share: float | None = None  # of the disks

    @property
    def flowtime_by_bound(self):
        """Flowtime over its lower bound; None without either."""
        return ratio(self.flowtime, self.lower_bound)

    @property
    def makespan_by_bound(self):
        """Makespan over its lower bound; None without either."""
        return ratio(self.makespan, self.makespan_lower_bound)


def ratio(value, of):
    return None if value is None or not of else value / of


def parse_bool(text):
    return int(text) != 0


def parse_optional(text):
    return float(text) if text else None


PARSERS = {str: str, int: int, float: float, bool: parse_bool, float | None: parse_optional}


def read_results(lines, kind=Result):
    """The results of CSV lines, with columns in any order and others ignored.

    Raises ValueError with the line's number for a missing column or a value of another type.
    """
    reader = csv.DictReader(lines, restkey="more")
    results = []
    for row in reader:
        if "more" in row or None in row.values():
            raise ValueError(f"line {reader.line_num}: not as many values as columns")
        results.append(kind(**{field.name: parse_value(row, field, reader.line_num)
                               for field in dataclasses.fields(kind)}))
    return results


def parse_value(row, field, line):
    if field.name not in row:
        if field.default is None:
            return None
        raise ValueError(f"line {line}: there is no column {field.name}")
    try:
        return PARSERS[field.type](row[field.name])
    except ValueError:
        raise ValueError(f"line {line}: '{row[field.name]}' is not a value of column {field.name}") from None


def read_file(file, kind=Result):
    with open(file, encoding="utf-8") as lines:
        try:
            return read_results(lines, kind)
        except ValueError as error:
            raise ValueError(f"{file}, {error}") from None
