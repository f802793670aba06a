"""A warehouse of shelves, stations and waiting places, and a fleet of three makes.

Aisles are three metres wide and have places on one side only, so a robot that stands at one lets others pass.
"""

import random
from dataclasses import dataclass

CELL = 0.5  # metres
AISLE, SHELF, HALL = 3.0, 1.5, 8.0  # metres: widths of aisles and shelves, and of the hall with the stations
AISLES = 7
BLOCKS = ((4.0, 28.0), (32.0, 56.0))  # metres: from and to, of the shelves in each row
WIDTH, HEIGHT = 60.0, HALL + AISLES * (SHELF + AISLE)
BESIDE = 0.75  # metres: of places from walls and shelves
APART = 1.5  # metres: of places from each other

MAKES = {
    "tote": {"radius": 0.3, "linear_speed": 1.5, "angular_speed": 2.0},
    "cart": {"radius": 0.4, "linear_speed": 1.2, "angular_speed": 1.5},
    "pallet": {"radius": 0.5, "linear_speed": 1.0, "angular_speed": 1.0},
}


@dataclass(frozen=True)
class Warehouse:
    map: dict
    shelves: list  # places (x, y) at which goods are put down or picked up
    stations: list
    waiting: list  # where robots wait that have nothing to do


def steps(begin, end):
    return [begin + APART * k for k in range(int((end - begin) / APART + 1e-9) + 1)]


def aisle_of(row):
    """The lower side of an aisle."""
    return HALL + row * (SHELF + AISLE) + SHELF


def make_warehouse():
    columns, rows = round(WIDTH / CELL), round(HEIGHT / CELL)
    cells = [["."] * columns for _ in range(rows)]  # from the bottom
    for row in range(AISLES):
        low = round((aisle_of(row) - SHELF) / CELL)
        for begin, end in BLOCKS:
            for line in cells[low:low + round(SHELF / CELL)]:
                line[round(begin / CELL):round(end / CELL)] = "#" * round((end - begin) / CELL)
    shelves = [(x, aisle_of(row) + BESIDE) for row in range(AISLES) for begin, end in BLOCKS
               for x in steps(begin + BESIDE, end - BESIDE)]
    waiting = [(x, y) for x in (BESIDE, WIDTH - BESIDE) for y in steps(HALL + BESIDE, HEIGHT - BESIDE)]
    waiting += [(x, HALL / 2.0) for k, x in enumerate(steps(4.5, WIDTH - 4.5)) if k % 4 != 3]  # with gaps
    return Warehouse({"rows": ["".join(line) for line in reversed(cells)], "resolution": CELL}, shelves,
                     [(x, BESIDE) for x in steps(3.0, WIDTH - 3.0)[::2]], waiting)


def make_request(warehouse, count, seed):
    """Robots of all makes in waiting places."""
    rng = random.Random(seed)
    places = rng.sample(warehouse.waiting, count)
    robots = []
    for k in range(count):
        make = list(MAKES)[k % len(MAKES)]
        (x, y), theta = places[k], rng.uniform(-3.1, 3.1)
        robots.append({"id": f"{make}-{k:02}", **MAKES[make], "start": {"x": x, "y": y, "theta": theta}, "idle": "yield"})
    return {"map": warehouse.map, "robots": robots}
