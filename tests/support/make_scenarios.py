#!/usr/bin/env python3
"""Writes the request files of tests/scenarios. Every run writes the same files.

Usage: tests/support/make_scenarios.py [FOLDER]   (default: tests/scenarios)

Each scenario is a function that returns a request of POST /v1/plan. Before it is written, a request is checked:
starts and goals clear of walls by the radius, no two starts and no two goals overlapping. Python standard library
only. Random numbers come only from random.Random(seed).random(): its values are the same in all Python versions.
"""

import base64
import json
import math
import pathlib
import random
import sys

from buildings import HOSPITAL, OFFICE, RESOLUTION, Building
from floor import Floor
from places import Places as BuildingPlaces

PI = 3.141592653589793


# ---------------------------------------------------------------- maps and poses

class Map:
    """A map under construction; rows from the top, as in a request."""

    def __init__(self, columns, rows, resolution):
        self.columns, self.count, self.resolution = columns, rows, resolution
        self.cells = [["."] * columns for _ in range(rows)]

    @classmethod
    def from_picture(cls, rows, resolution):
        made = cls(len(rows[0]), len(rows), resolution)
        made.cells = [list(row) for row in rows]
        return made

    @classmethod
    def from_json(cls, given):
        """The map of a request: its rows, or its image as floor.py writes it."""
        if "rows" in given:
            return cls.from_picture(given["rows"], given["resolution"])
        image = given["image"]
        floor = Floor.from_png(base64.b64decode(image["png"]), image["resolution"])
        return cls.from_picture(floor.map("rows")["rows"], image["resolution"])

    def block(self, column, row, columns=1, rows=1):
        """Blocks a rectangle of cells; (column, row) is its lower left cell, row 0 the bottom one."""
        for r in range(row, row + rows):
            for c in range(column, column + columns):
                self.cells[self.count - 1 - r][c] = "#"

    def blocked(self, column, row):
        inside = 0 <= column < self.columns and 0 <= row < self.count
        return not inside or self.cells[self.count - 1 - row][column] == "#"

    def center(self, column, row):
        return (column + 0.5) * self.resolution, (row + 0.5) * self.resolution

    def clearance(self, x, y):
        """Metres from a point to the nearest blocked cell or map edge, searched up to two metres."""
        size = self.resolution
        nearest = min(x, y, self.columns * size - x, self.count * size - y)
        reach = int(2.0 / size) + 1
        at_column, at_row = int(x / size), int(y / size)
        for r in range(max(0, at_row - reach), min(self.count, at_row + reach + 1)):
            for c in range(max(0, at_column - reach), min(self.columns, at_column + reach + 1)):
                if self.blocked(c, r):
                    dx = max(c * size - x, 0.0, x - (c + 1) * size)
                    dy = max(r * size - y, 0.0, y - (r + 1) * size)
                    nearest = min(nearest, math.hypot(dx, dy))
        return nearest

    def json(self):
        return {"resolution": self.resolution, "rows": ["".join(row) for row in self.cells]}


def pose(x, y, theta=None):
    made = {"x": round(x, 4), "y": round(y, 4)}
    if theta is not None:
        made["theta"] = theta
    return made


def robot(name, start, goal=None, **kind):
    made = {"id": name, **kind, "start": start}
    if goal is not None:
        made["goal"] = goal
    return made


class Places:
    """Chooses cell centres where disks overlap neither walls nor each other."""

    def __init__(self, grid, seed):
        self.grid, self.random, self.taken = grid, random.Random(seed), []

    def below(self, limit):
        return int(self.random.random() * limit)

    def heading(self):
        return round((self.random.random() * 2.0 - 1.0) * PI, 4)

    def fits(self, x, y, radius):
        apart = all(math.hypot(x - ox, y - oy) >= radius + other for ox, oy, other in self.taken)
        return apart and self.grid.clearance(x, y) >= radius

    def take(self, radius, cells=None):
        """A random cell centre, of `cells` if given, where a disk of `radius` fits."""
        for _ in range(100_000):
            if cells:
                cell = cells[self.below(len(cells))]
            else:
                cell = self.below(self.grid.columns), self.below(self.grid.count)
            x, y = self.grid.center(*cell)
            if self.fits(x, y, radius):
                self.taken.append((x, y, radius))
                return x, y
        raise SystemExit(f"no place left for a robot of radius {radius}")


# ---------------------------------------------------------------- the scenarios

def corridor_swap():
    grid = Map.from_picture([
        "########################",
        "###############..#######",
        "#......................#",
        "########################"], 0.5)
    return {
        "map": grid.json(),
        "robot_defaults": {"radius": 0.2, "linear_speed": 1.0, "angular_speed": PI},
        "robots": [
            robot("east-bound", pose(0.75, 0.75, 0.0), pose(11.25, 0.75, 0.0)),
            robot("west-bound", pose(11.25, 0.75, PI), pose(0.75, 0.75, PI)),
        ],
    }


def crossing():
    grid = Map(28, 28, 0.5)
    for column in (0, 18):
        for row in (0, 18):
            grid.block(column, row, 10, 10)
    heavy = {"radius": 0.7, "linear_speed": 0.5, "angular_speed": 0.8}
    cart = {"radius": 0.4, "linear_speed": 1.0, "angular_speed": 1.6}
    scout = {"radius": 0.2, "linear_speed": 1.8, "angular_speed": PI}
    up, down = PI / 2, -PI / 2
    return {
        "map": grid.json(),
        "robots": [
            robot("heavy-east", pose(1.25, 6.25, 0.0), pose(12.75, 6.25, 0.0), **heavy),
            robot("heavy-south", pose(6.25, 12.75, down), pose(6.25, 1.25, down), **heavy),
            robot("cart-west", pose(12.75, 7.75, PI), pose(1.25, 7.75, PI), **cart),
            robot("cart-north", pose(7.75, 1.25, up), pose(7.75, 12.75, up), **cart),
            robot("cart-turning", pose(3.25, 7.75, 0.0), pose(6.25, 3.25, down), **cart),
            robot("scout-east", pose(3.25, 5.75, 0.0), pose(10.75, 8.25, up), **scout),
            robot("scout-south", pose(8.25, 11.25, down), pose(8.25, 2.75, 0.0), **scout),
            robot("scout-north", pose(5.75, 2.75, up), pose(5.75, 11.25, PI), **scout),
        ],
        "options": {"mode": "anytime", "max_iterations": 100},
    }


def warehouse():
    grid = Map(70, 44, 0.5)
    shelf_rows = range(4, 40, 5)
    for row in shelf_rows:  # shelves of 2 x 16 cells, aisles of 3 cells between them
        for column in (12, 31, 50):
            grid.block(column, row, 16, 2)
    for row in range(3, 42, 4):  # pick stations along the west wall, with a place for one robot between two
        grid.block(0, row, 3, 1)
    tote = {"radius": 0.2, "linear_speed": 1.5, "angular_speed": PI}
    pallet = {"radius": 0.3, "linear_speed": 1.0, "angular_speed": 2.0}

    aisles = [(c, r + above) for r in shelf_rows for c in range(12, 66) for above in (-1, 2)
              if (c - 12) % 19 < 16]
    stations = [(1, row) for row in range(1, 43, 4)]
    starts, goals = Places(grid, 40), Places(grid, 41)
    robots = []
    for index in range(40):
        carries_pallet = index % 4 == 3
        kind = pallet if carries_pallet else tote
        x, y = starts.take(kind["radius"])
        if index < 2 * len(stations) and index % 2 == 0:
            goal_x, goal_y = goals.take(kind["radius"], stations)
            theta = PI
        elif carries_pallet:
            goal_x, goal_y = goals.take(kind["radius"], [(c, r) for c in range(5, 11) for r in range(2, 42)])
            theta = 0.0
        else:
            goal_x, goal_y = goals.take(kind["radius"], aisles)
            faces_up = grid.blocked(int(goal_x / 0.5), int(goal_y / 0.5) + 1)
            theta = PI / 2 if faces_up else -PI / 2
        name = f"{'pallet' if carries_pallet else 'tote'}-{index + 1:02}"
        robots.append(robot(name, pose(x, y, starts.below(4) * PI / 2 - PI / 2), pose(goal_x, goal_y, theta),
                            **kind))
    return {"map": grid.json(), "robots": robots, "options": {"time_budget_ms": 10000}}


def hall_100():
    grid = Map(64, 64, 1.0)
    kinds = [{"radius": 0.3, "linear_speed": 1.5, "angular_speed": PI},
             {"radius": 0.5, "linear_speed": 1.0, "angular_speed": PI},
             {"radius": 1.0, "linear_speed": 0.5, "angular_speed": PI}]
    starts, goals = Places(grid, 64), Places(grid, 65)
    robots = []
    for index in range(100):
        kind = kinds[index % 3]
        start = pose(*starts.take(kind["radius"]), starts.heading())
        goal = pose(*goals.take(kind["radius"]), goals.heading())
        robots.append(robot(f"r{index + 1:03}", start, goal, **kind))
    return {"map": grid.json(), "robots": robots, "options": {"time_budget_ms": 10000}}


def lab_polygon():
    grid = Map(108, 72, 0.05)
    grid.block(26, 40, 16, 10)
    grid.block(52, 14, 10, 18)
    grid.block(74, 46, 14, 8)
    places = [("rover-1", (0.412, 0.533, 0.3), (4.871, 3.118, 0.0)),
              ("rover-2", (4.937, 0.486, 3.0), (0.463, 3.071, PI)),
              ("rover-3", (0.388, 1.817, 0.0), (4.926, 1.764, 0.0)),
              ("rover-4", (5.013, 3.062, -2.6), (0.519, 0.447, PI)),
              ("rover-5", (2.683, 3.127, -1.571), (2.337, 0.418, -PI / 2)),
              ("rover-6", (3.621, 0.392, 1.4), (3.287, 3.183, PI / 2))]
    return {
        "map": grid.json(),
        "robot_defaults": {"radius": 0.15, "linear_speed": 0.1, "angular_speed": 0.418879},
        "robots": [robot(name, pose(*start), pose(*goal)) for name, start, goal in places],
        "options": {"inflation": 0.05, "wait_before_move": 1.0, "time_budget_ms": 10000},
    }


def partly_solvable():
    grid = Map.from_picture([
        "##############################",
        "#.......#..........###########",
        "#.......#..........###########",
        "#.......#....................#",
        "#..................###########",
        "#..................###########",
        "#.......#..........###########",
        "#.......#..........#.........#",
        "####.####..........#.........#",
        "#.......#..........#.........#",
        "#.......#....................#",
        "#..................#.........#",
        "#..................#.........#",
        "#.......#..........#.........#",
        "##############################"], 0.5)
    return {
        "map": grid.json(),
        "robot_defaults": {"radius": 0.2, "linear_speed": 1.2, "angular_speed": PI},
        "robots": [
            robot("courier-1", pose(1.25, 6.25, 0.0), pose(7.75, 0.75, 0.0)),
            robot("courier-2", pose(7.75, 6.25, PI), pose(1.25, 1.25, PI)),
            robot("courier-3", pose(1.25, 0.75, 0.0), pose(13.25, 1.25, 0.0)),
            # Wider than the door of the room in the lower right, which is 0.5 m.
            robot("wide-lift", pose(6.25, 4.75, 0.0), pose(12.25, 2.25, 0.0), radius=0.45, linear_speed=0.6),
            # Its goal is at the end of the dead end where `charging` stays.
            robot("late-comer", pose(5.25, 2.75, 0.0), pose(14.25, 5.75)),
            robot("charging", pose(12.25, 5.75, PI)),
        ],
    }


def hospital_ward():
    grid = Map(60, 26, 0.4)
    for column in range(0, 60, 10):  # rooms above and below a corridor of eight cells, doors of three cells
        for row in (0, 18):
            grid.block(column, row, 1, 8)
    for row in (8, 17):
        grid.block(0, row, 60, 1)
        for column in range(4, 60, 10):
            for door in range(4):
                grid.cells[grid.count - 1 - row][column + door] = "."
    grid.block(59, 0, 1, 26)
    grid.block(0, 0, 1, 26)
    cart = {"radius": 0.35, "linear_speed": 0.8, "angular_speed": 1.5}
    bed = {"radius": 0.55, "linear_speed": 0.6, "angular_speed": 0.8}
    return {
        "map": grid.json(),
        "robot_defaults": {"radius": 0.25, "linear_speed": 1.2, "angular_speed": 2.5},
        "robots": [
            robot("meals-1", pose(2.137, 1.324, 1.2), pose(22.061, 9.117, PI / 2)),
            robot("meals-2", pose(21.853, 1.458, PI / 2), pose(2.218, 9.034, PI / 2)),
            robot("linen-1", pose(1.274, 5.163, 0.0), pose(17.842, 1.276, -PI / 2), **cart),
            robot("linen-2", pose(22.416, 5.427, PI), pose(5.931, 1.337, -PI / 2), **cart),
            robot("lab-samples", pose(6.214, 9.153, -PI / 2), pose(13.763, 1.218), linear_speed=1.5),
            robot("pharmacy", pose(13.928, 1.174, PI / 2), pose(10.183, 9.226)),
            robot("bed-7", pose(10.087, 8.891, -PI / 2), pose(22.143, 5.094, 0.0), **bed),
            robot("parked-cart-a", pose(7.92, 4.11, 0.0), radius=0.35),
            robot("parked-cart-b", pose(15.36, 6.29, 0.0), radius=0.35),
            robot("parked-bed", pose(19.47, 4.24, 0.0), radius=0.45),
        ],
        "options": {"inflation": 0.03, "start_safe_interval": 5.0},
    }


def charging_docks():
    grid = Map(40, 24, 0.5)
    for column in range(3, 40, 4):  # docks of three cells between fins along the north wall
        grid.block(column, 20, 1, 4)
    grid.block(8, 8, 6, 4)
    grid.block(26, 8, 6, 4)
    north, south = PI / 2, -PI / 2
    robots = []
    for dock in range(0, 10, 2):  # a charged robot leaves, an empty one comes for its dock
        x = 2.0 * dock + 0.75
        robots.append(robot(f"charged-{dock + 1}", pose(x, 11.25, north), pose(19.0 - x, 0.75, south)))
        robots.append(robot(f"empty-{dock + 1}", pose(x, 2.25, 0.0), pose(x, 11.25, north)))
    robots.append(robot("out-of-order", pose(10.75, 11.25, north)))
    return {
        "map": grid.json(),
        "robot_defaults": {"radius": 0.35, "linear_speed": 1.0, "angular_speed": 1.8},
        "robots": robots,
        "options": {"mode": "anytime", "objective": "makespan", "max_iterations": 50},
    }


def parking():
    """A warehouse of one-lane aisles. Robots without work stand where the last order left them."""
    grid = Map(41, 17, 0.5)
    for row in (2, 5, 8, 11, 14):  # shelves of two cells between aisles of one, a cross aisle at each end
        for column in (3, 16, 29):
            grid.block(column, row, 10, 2)
    carriers = []
    for number, (column, row, to_column, to_row) in enumerate([
            (0, 1, 40, 13), (40, 4, 0, 10), (0, 7, 40, 7), (40, 10, 0, 4), (0, 13, 40, 1), (14, 0, 27, 16)]):
        carriers.append(robot(f"carrier-{number + 1}", pose(*grid.center(column, row), 0.0),
                              pose(*grid.center(to_column, to_row))))
    idle = []
    for number, (column, row) in enumerate([(7, 4), (21, 7), (34, 7), (9, 10), (33, 13), (40, 7), (20, 1), (0, 10)]):
        idle.append(robot(f"idle-{number + 1}", pose(*grid.center(column, row), PI / 2), idle="yield"))
    return {
        "map": grid.json(),
        "robot_defaults": {"radius": 0.24, "linear_speed": 1.0, "angular_speed": 2.0},
        "robots": carriers + idle,
    }


def formation():
    """Forty robots line up in two rings; it does not matter who stands where."""
    grid = Map(48, 48, 0.5)
    rings = [(9.0, 24), (5.5, 16)]  # radius in metres, places
    places = [{"x": round(12.0 + radius * math.cos(2.0 * PI * k / count), 3),
               "y": round(12.0 + radius * math.sin(2.0 * PI * k / count), 3)}
              for radius, count in rings for k in range(count)]
    robots = []
    for number in range(40):  # side by side in the south
        x, y = grid.center(4 + 4 * (number % 10), 1 + 2 * (number // 10))
        robots.append(robot(f"robot-{number + 1:02}", pose(x, y, PI / 2)) | {"goal": {"any_of": places}})
    return {
        "map": grid.json(),
        "robot_defaults": {"radius": 0.3, "linear_speed": 1.0, "angular_speed": 2.0},
        "robots": robots,
    }


def station_queue():
    """Two charging stations at the end of a hall, each as good as the other, and more robots than stations."""
    grid = Map(30, 14, 0.5)
    grid.block(24, 0, 6, 2)
    grid.block(24, 6, 6, 2)
    grid.block(24, 12, 6, 2)
    stations = {"any_of": [{"x": 14.25, "y": 2.0, "theta": 0.0}, {"x": 14.25, "y": 5.0, "theta": 0.0}], "service": 20.0}
    robots = []
    for number, (column, row) in enumerate([(4, 2), (4, 11), (8, 6), (12, 1), (12, 12), (16, 8)]):
        made = robot(f"robot-{number + 1}", pose(*grid.center(column, row), 0.0), idle="yield")
        robots.append(made | {"goals": [stations]})
    return {
        "map": grid.json(),
        "robot_defaults": {"radius": 0.35, "linear_speed": 1.0, "angular_speed": 2.0},
        "robots": robots,
    }


def fleet_in(building, kinds, seed, boxes=()):
    """Robots of the kinds in turn, at random places of a building that do not block it for the widest."""
    widest = max(kind["radius"] for _, _, kind in kinds)
    places = BuildingPlaces(building.floor, widest, seed, boxes)
    names = [(f"{name}-{number + 1}", kind) for number in range(max(count for _, count, _ in kinds))
             for name, count, kind in kinds if number < count]
    starts, goals = places.draw(len(names)), places.draw(len(names))
    return [robot(name, pose(*start, round(places.random.random() * 2.0 * PI - PI, 4)), pose(*goal), **kind)
            for (name, kind), start, goal in zip(names, starts, goals)]


def office_floor():
    building = Building(OFFICE, 1200, 800, 60)
    courier = {"radius": 0.25, "linear_speed": 1.2, "angular_speed": 2.5}
    cleaner = {"radius": 0.35, "linear_speed": 0.6, "angular_speed": 1.5}
    return {"map": building.floor.map("png"),
            "robots": fleet_in(building, [("courier", 12, courier), ("cleaner", 6, cleaner)], 60),
            "options": {"time_budget_ms": 10000}}


def hospital_wing():
    building = Building(HOSPITAL, 1200, 560, 28)
    meals = {"radius": 0.3, "linear_speed": 1.0, "angular_speed": 2.0}
    samples = {"radius": 0.2, "linear_speed": 1.5, "angular_speed": 3.0}
    bed = {"radius": 0.45, "linear_speed": 0.6, "angular_speed": 0.8}
    kinds = [("meals", 5, meals), ("samples", 4, samples), ("bed", 3, bed)]
    robots = fleet_in(building, kinds, 28, [room.box for room in building.rooms])
    return {"map": building.floor.map("png"), "robots": robots, "zones": wing_zones(building),
            "options": {"time_budget_ms": 10000}}


def wing_zones(building):
    """Between the crossings, one corridor leads east and the other west; the crossing in the east is slow."""
    lower, upper = building.corridors
    west, east = building.crossings

    def zone(name, kind, columns, rows, **rule):
        left, right, bottom, top = (round(cells * RESOLUTION, 2) for cells in (*columns, *rows))
        return {"id": name, "type": kind, **rule,
                "polygon": [{"x": x, "y": y} for x, y in ((left, bottom), (right, bottom), (right, top), (left, top))]}
    between = (west.column + west.columns, east.column)
    return [zone("eastbound", "one_way", between, (lower.row, lower.row + lower.rows), heading=0.0, half_angle=1.5708),
            zone("westbound", "one_way", between, (upper.row, upper.row + upper.rows), heading=3.1416,
                 half_angle=1.5708),
            zone("quiet", "speed", (east.column, east.column + east.columns), (lower.row + lower.rows, upper.row),
                 linear_speed=0.4, angular_speed=0.8)]


def warehouse_inertia():
    """The warehouse with three makes, none of which starts or stops at once."""
    request = warehouse()
    makes = [("tote", {"linear_acceleration": 1.0, "linear_deceleration": 1.5, "angular_acceleration": 6.0}),
             ("tugger", {"linear_speed": 1.2, "linear_acceleration": 0.4, "linear_deceleration": 0.8,
                         "angular_acceleration": 3.0}),
             ("pallet", {"linear_acceleration": 0.3, "linear_deceleration": 0.5, "angular_acceleration": 2.0})]
    for index, each in enumerate(request["robots"]):
        kind, limits = makes[2 if index % 4 == 3 else index % 4 == 1]
        each["id"] = f"{kind}-{index + 1:02}"
        each.update(limits)
    return request


def forklifts():
    """A depot where forklifts with slow brakes fetch pallets from racks, which make them larger and slower, and stack
    them."""
    grid = Map(64, 40, 0.5)
    for row in (8, 16, 24, 32):  # racks with aisles of 6 cells between them
        grid.block(16, row, 32, 2)
    lift = {"radius": 0.5, "linear_speed": 2.5, "angular_speed": 1.5, "linear_acceleration": 0.6,
            "linear_deceleration": 0.4, "angular_acceleration": 1.0}
    robots = []
    for index in range(10):
        left = index % 2 == 0
        lane = 3.0 + 3.4 * (index // 2)
        beside_rack = [5.75, 7.25, 9.75, 11.25, 13.75, 15.25, 17.75, 7.25, 11.25, 15.25][index]
        made = robot(f"lift-{index + 1:02}", pose(2.0 if left else 30.0, lane, 0.0 if left else PI), **lift)
        made["goals"] = [
            {"x": 9.5 + 1.45 * index, "y": beside_rack, "service": 6.0, "radius_after": 0.7,
             "linear_speed_after": 1.5, "linear_acceleration_after": 0.4, "linear_deceleration_after": 0.25},
            {"x": 30.0 if left else 2.0, "y": lane, "theta": 0.0 if left else PI, "service": 4.0,
             "radius_after": 0.5, "linear_speed_after": lift["linear_speed"],
             "linear_acceleration_after": lift["linear_acceleration"],
             "linear_deceleration_after": lift["linear_deceleration"]},
        ]
        robots.append(made)
    return {"map": grid.json(), "robots": robots, "options": {"time_budget_ms": 10000}}


SCENARIOS = [  # in display order
    ("corridor-swap", "Corridor swap", corridor_swap,
     "Two robots swap the ends of a corridor with a single passing bay."),
    ("crossing", "Crossing", crossing,
     "Eight robots of three sizes and speeds meet at a crossing, with goal headings; improved for 100 iterations."),
    ("charging-docks", "Charging docks", charging_docks,
     "Charged robots leave their docks while empty ones come for them; the makespan is improved."),
    ("parking", "Parking", parking,
     "Carriers cross a warehouse in which idle robots stand; those that are in the way yield, the others do not move."),
    ("formation", "Formation", formation,
     "Forty robots line up in two rings. Any of them may take any place; each gets one at the least sum of their times."),
    ("station-queue", "Queue at stations", station_queue,
     "Six robots come to two charging stations, either of which will do; they wait their turn and make way."),
    ("hospital-ward", "Hospital ward", hospital_ward,
     "Carts, couriers and a bed in a corridor with parked carts; no robot stands on the lattice."),
    ("lab-polygon", "Laboratory polygon", lab_polygon,
     "Six small robots on a polygon of 5 cm cells, with inflated radii and waits before moves for safe execution."),
    ("warehouse", "Warehouse", warehouse,
     "Forty tote and pallet robots between shelves, aisles and pick stations."),
    ("warehouse-inertia", "Warehouse with inertia", warehouse_inertia,
     "The same warehouse with robots of three makes, which need time to start and to stop."),
    ("forklifts", "Forklifts", forklifts,
     "Ten forklifts with slow brakes fetch pallets, which make them larger, and stack them on the other side."),
    ("hall-100", "Hall with 100 robots", hall_100,
     "A hundred robots of three types in an empty hall of 64 m by 64 m, starts and goals at random."),
    ("partly-solvable", "Partly solvable", partly_solvable,
     "One robot is too wide for a door and one has its goal behind a parked robot; the others are served."),
    ("office-floor", "Office floor", office_floor,
     "Couriers and cleaners on an office floor of 60 m by 40 m as a robot maps it: cells of 5 cm, doors, furniture, "
     "speckle, unknown cells."),
    ("hospital-wing", "Hospital wing", hospital_wing,
     "Carts, couriers and beds in a wing with two one-way corridors and a slow zone; the map is an image of 5 cm "
     "cells."),
]
MOVING = [  # written by make_moving_scenarios.py
    ("crossing-people", "Crossing people",
     "Six robots cross a hall, where five people walk on their own ways and one stays; robots make way."),
    ("rush-hour", "Rush hour",
     "Forty robots under way in a warehouse, with two goals each; what they do now is committed, and their plans are "
     "kept where possible."),
    ("late-pallet", "Late pallet",
     "A pallet robot stands still for 12 s; of the plans of the other robots, only those change that must."),
]


# ---------------------------------------------------------------- checking and writing

def faults(request):
    """The reasons why a request is invalid: poses in obstacles, overlapping starts or goals, equal ids."""
    grid = Map.from_json(request["map"])
    defaults = request.get("robot_defaults", {})
    found = []
    for made in request["robots"]:
        for goal in [made.get("goal", {}), *made.get("goals", [])]:
            radius = made.get("radius", defaults.get("radius"))
            found += [f"a pose of {made['id']} is in an obstacle" for one in goal.get("any_of", [])
                      if grid.clearance(one["x"], one["y"]) < radius - 1e-9]
    for member in ("start", "goal"):
        disks = [(r["id"], r[member]["x"], r[member]["y"], r.get("radius", defaults.get("radius")))
                 for r in request["robots"] if "x" in r.get(member, {})]
        for index, (name, x, y, radius) in enumerate(disks):
            if grid.clearance(x, y) < radius - 1e-9:
                found.append(f"{member} of {name}: {grid.clearance(x, y):.3f} m from an obstacle, radius {radius}")
            for other, ox, oy, other_radius in disks[:index]:
                if math.hypot(x - ox, y - oy) < radius + other_radius - 1e-9:
                    found.append(f"{member}s of {other} and {name} overlap")
    if len({r["id"] for r in request["robots"]}) != len(request["robots"]):
        found.append("duplicate ids")
    return found


def text(request):
    """The request as JSON with one line for each map row and each robot."""
    def lines(items):
        return ",\n".join("      " + json.dumps(item) for item in items)
    if "rows" in request["map"]:
        parts = ['  "map": {{\n    "resolution": {},\n    "rows": [\n{}\n    ]\n  }}'.format(
            json.dumps(request["map"]["resolution"]), lines(request["map"]["rows"]))]
    else:
        parts = ['  "map": ' + json.dumps(request["map"])]
    if "robot_defaults" in request:
        parts.append('  "robot_defaults": ' + json.dumps(request["robot_defaults"]))
    robots = ",\n".join("    " + json.dumps(made) for made in request["robots"])
    parts.append(f'  "robots": [\n{robots}\n  ]')
    if "obstacles" in request:
        obstacles = ",\n".join("    " + json.dumps(made) for made in request["obstacles"])
        parts.append(f'  "obstacles": [\n{obstacles}\n  ]')
    if "zones" in request:
        zones = ",\n".join("    " + json.dumps(made) for made in request["zones"])
        parts.append(f'  "zones": [\n{zones}\n  ]')
    if "options" in request:
        parts.append('  "options": ' + json.dumps(request["options"]))
    return "{\n" + ",\n".join(parts) + "\n}\n"


def main():
    default = pathlib.Path(__file__).resolve().parent.parent / "scenarios"
    folder = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else default
    for name, _, make, _ in SCENARIOS:
        request = make()
        found = faults(request)
        if found:
            raise SystemExit(f"{name}:\n  " + "\n  ".join(found))
        written = text(request)
        assert json.loads(written) == request
        (folder / f"{name}.json").write_text(written)
    index = [json.dumps({"name": name, "title": title, "description": description})
             for name, title, description in [(n, t, d) for n, t, _, d in SCENARIOS] + MOVING]
    (folder / "index.json").write_text("[\n  " + ",\n  ".join(index) + "\n]\n")


if __name__ == "__main__":
    main()
