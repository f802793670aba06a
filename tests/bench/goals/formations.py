"""Robots on a 4-connected grid whose goals are interchangeable, as a request and for the program of TSWAP (Okumura and
Defago 2023). In its model, robots of one cell move a cell per step or wait."""

import random
import re
from dataclasses import dataclass

RADIUS = 0.35  # cells: robots that follow each other around a corner, as there, do not touch
AT_ONCE = 1e6  # rad/s: robots there do not turn


@dataclass(frozen=True)
class Grid:
    rows: list  # as in the file, from the top
    free: list  # cells (column, row) of its largest connected part


@dataclass(frozen=True)
class Problem:
    request: dict
    starts: list  # cells (column, row)
    goals: list


def map_of(path):
    """The map in a file of MovingAI."""
    rows = path.read_text(encoding="ascii").split("map\n", 1)[1].split()
    cells = {(column, row) for row, line in enumerate(rows) for column, kind in enumerate(line) if kind in ".G"}
    largest = []
    while cells:
        part = [cells.pop()]
        for column, row in part:
            for cell in ((column + 1, row), (column - 1, row), (column, row + 1), (column, row - 1)):
                if cell in cells:
                    cells.remove(cell)
                    part.append(cell)
        largest = max(largest, part, key=len)
    return Grid(["".join("." if kind in ".G" else "#" for kind in line) for line in rows], sorted(largest))


def formation(grid, count, seed):
    rng = random.Random(seed)
    starts, goals = rng.sample(grid.free, count), rng.sample(grid.free, count)
    height = len(grid.rows)

    def middle(cell):
        return {"x": cell[0] + 0.5, "y": height - cell[1] - 0.5}

    anywhere = {"any_of": [middle(cell) for cell in goals]}
    robots = [{"id": f"robot-{k + 1}", "start": middle(cell), "goal": anywhere} for k, cell in enumerate(starts)]
    defaults = {"radius": RADIUS, "linear_speed": 1.0, "angular_speed": AT_ONCE}
    return Problem({"map": {"rows": grid.rows}, "robot_defaults": defaults, "robots": robots}, starts, goals)


def tswap_instance(path, problem):
    """The file that its program reads; it looks for the map in its own folder."""
    pairs = "".join(f"{start[0]},{start[1]},{goal[0]},{goal[1]}\n"
                    for start, goal in zip(problem.starts, problem.goals))
    return (f"map_file={path.name}\nagents={len(problem.starts)}\nseed=0\nrandom_problem=0\nmax_timestep=5000\n"
            f"max_comp_time=60000\n{pairs}")


def read_result(text):
    """The flowtime in a file that it wrote."""
    if not re.search(r"^solved=1$", text, re.MULTILINE):
        raise ValueError("TSWAP has not solved it")
    return float(re.search(r"^soc=(\d+)$", text, re.MULTILINE).group(1))
