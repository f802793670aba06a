#!/usr/bin/env python3
"""Writes a request of POST /v1/plan for a generated building, the same for the same arguments.

Usage: tests/support/make_buildings.py [--kind office] [--cells 2000x2000] [--robots 30] [--seed 1] [--map png] > FILE
"""

import argparse
import json
import math
import random
import re
import sys

from buildings import STYLES, Building
from floor import FORMS
from places import Places

RADIUS = 0.3
DEFAULTS = {"radius": RADIUS, "linear_speed": 1.0, "angular_speed": 2.0}


def pose(place, headings):
    x, y = place
    return {"x": x, "y": y, "theta": round((2.0 * headings.random() - 1.0) * math.pi, 4)}


def building_request(kind, columns, rows, robots, seed, form="png"):
    """A request with robots of radius 0.3 m at random; raises ValueError if the building is too small for them."""
    floor = Building(STYLES[kind], columns, rows, seed).floor
    places = Places(floor, RADIUS, seed)
    starts, goals = places.draw(robots), places.draw(robots)
    headings = random.Random(seed)
    return {"map": floor.map(form), "robot_defaults": DEFAULTS,
            "robots": [{"id": f"robot-{index + 1:02}", "start": pose(start, headings), "goal": pose(goal, headings)}
                       for index, (start, goal) in enumerate(zip(starts, goals))]}


def size(text):
    found = re.fullmatch(r"(\d+)(?:x(\d+))?", text)
    if not found:
        raise argparse.ArgumentTypeError(f"'{text}' is not a size such as 2000 or 1200x800")
    return int(found[1]), int(found[2] or found[1])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--kind", choices=sorted(STYLES), default="office")
    parser.add_argument("--cells", type=size, default="2000", help="columns x rows, of 5 cm")
    parser.add_argument("--robots", type=int, default=30)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--map", choices=FORMS, default="png", help="how the request has its map")
    words = parser.parse_args()
    json.dump(building_request(words.kind, *words.cells, words.robots, words.seed, words.map), sys.stdout)


if __name__ == "__main__":
    main()
