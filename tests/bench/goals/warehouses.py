"""Random warehouses, in which three of ten robots have nothing to do and make way."""

import random

CELL = 0.5  # metres
BESIDE = 0.75  # metres: of places from walls and shelves
APART = 1.5  # metres: between places
AISLES = 2.0, 2.5, 3.0  # metres: in the narrowest aisle, large robots do not pass a robot that stands

MAKES = [
    {"radius": 0.3, "linear_speed": 1.5, "angular_speed": 2.0},
    {"radius": 0.4, "linear_speed": 1.2, "angular_speed": 1.5},
    {"radius": 0.5, "linear_speed": 1.0, "angular_speed": 1.0},
]


def make_warehouse(seed):
    """A request: rows of shelves between aisles, a hall below. Robots start at random places and have random goals.
    Idle robots have none, and stand in aisles and in the hall."""
    rng = random.Random(seed)
    aisles, blocks, length = rng.randint(3, 6), rng.randint(1, 3), rng.choice([9.0, 12.0, 15.0])
    hall, shelf, aisle = rng.choice([6.0, 8.0]), rng.choice([1.0, 1.5]), rng.choice(AISLES)
    width, height = aisle + blocks * (length + aisle), hall + aisles * (shelf + aisle)
    cells = [["."] * round(width / CELL) for _ in range(round(height / CELL))]  # from the bottom
    places = []
    for row in range(aisles):
        low = hall + row * (shelf + aisle)
        for block in range(blocks):
            left = aisle + block * (length + aisle)
            for line in cells[round(low / CELL):round((low + shelf) / CELL)]:
                line[round(left / CELL):round((left + length) / CELL)] = "#" * round(length / CELL)
            places += [(left + APART * k + BESIDE, low + shelf + BESIDE) for k in range(int(length / APART))]
    places += [(BESIDE + APART * k, y) for k in range(int((width - BESIDE) / APART)) for y in (BESIDE, hall / 2.0)]
    count = min(rng.randint(20, 50), len(places) // 4)
    idle = round(0.3 * count)
    spots = rng.sample(places, 2 * count - idle)
    robots = []
    for k in range(count):
        robot = {"id": f"robot-{k + 1:02}", **MAKES[k % len(MAKES)], "start": pose(spots[k], rng)}
        if k < count - idle:
            robot["goal"] = {"x": spots[count + k][0], "y": spots[count + k][1]}
        else:
            robot["idle"] = "yield"
        robots.append(robot)
    rng.shuffle(robots)
    return {"map": {"rows": ["".join(line) for line in reversed(cells)], "resolution": CELL}, "robots": robots}


def pose(place, rng):
    return {"x": place[0], "y": place[1], "theta": rng.uniform(-3.1, 3.1)}
