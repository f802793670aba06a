"""Random starts and goals on a floor of fine cells, for any number of rows and columns.

A row of cells is an integer with a bit for each column, so that operations on whole rows are fast.
"""

import math
import random

from floor import FREE


class FreeCells:
    """The cells in which the centre of a disk may be anywhere without overlapping an obstacle; connected ones only."""

    def __init__(self, floor, radius):
        self.floor, self.radius = floor, radius
        every = (1 << floor.columns) - 1
        self.rows = [every & ~bits for bits in self.grown([every & ~bits for bits in floor.bits(FREE)])]
        self.rows = largest_part(self.rows)

    def grown(self, obstacles):
        """The cells that have an obstacle, or the edge of the floor, nearer than the radius."""
        reach = math.ceil(self.radius / self.floor.resolution)  # cells, of which the own one counts none
        every = (1 << self.floor.columns) - 1
        half = [self.half_width(up) for up in range(reach + 1)]
        walled = [1 | bits << 1 | 1 << (self.floor.columns + 1) for bits in obstacles]  # by the sides of the floor
        wide = {columns: [widened(bits, columns) >> 1 & every for bits in walled] for columns in set(half)}
        count = len(obstacles)
        made = []
        for row in range(count):
            bits = wide[half[0]][row]
            for up in range(1, reach + 1):
                for other in (row - up, row + up):
                    bits |= wide[half[up]][other] if 0 <= other < count else every
            made.append(bits)
        return made

    def half_width(self, rows):
        """How many columns away an obstacle so many rows away is too near. The distance of cells is the distance of
        their sides.
        """
        apart = max(0, rows - 1) * self.floor.resolution
        across = math.sqrt(max(0.0, self.radius**2 - apart**2))
        return math.ceil(across / self.floor.resolution - 1e-9)

    def without(self, disks):
        """The rows without the cells whose centres are in the disks of (x, y, radius)."""
        rows, size = list(self.rows), self.floor.resolution
        for x, y, radius in disks:
            first, last = int((y - radius) / size), int((y + radius) / size)
            for row in range(max(0, first), min(len(rows), last + 1)):
                half = math.sqrt(max(0.0, radius**2 - ((row + 0.5) * size - y)**2))
                left, right = max(0, round((x - half) / size)), round((x + half) / size)
                rows[row] &= ~(((1 << max(0, right - left)) - 1) << left)
        return rows

    def has(self, x, y, rows=None):
        column, row = int(x / self.floor.resolution), int(y / self.floor.resolution)
        return 0 <= row < self.floor.rows and (rows or self.rows)[row] >> column & 1 == 1


def widened(bits, columns):
    """The bits and those up to so many columns beside them."""
    done = 0
    while done < columns:
        step = min(columns - done, done + 1)
        bits |= bits << step | bits >> step
        done += step
    return bits


def filled(rows, seeds):
    """The 4-connected parts of `rows` that contain a seed."""
    made = [along(row, row & seed) for row, seed in zip(rows, seeds)]
    order = list(range(len(rows)))
    changed = True
    while changed:
        changed = False
        for sweep in (order, order[::-1]):
            before = 0
            for row in sweep:
                new = before & rows[row] & ~made[row]
                if new:
                    made[row], changed = made[row] | along(rows[row], new), True
                before = made[row]
    return made


def along(row, bits):
    """The runs of a row's bits that contain one of `bits`, which are bits of the row."""
    made = bits | row & ~(row + bits)  # an addition carries from each bit to the upper end of its run
    step = 1
    while row:  # and down by twice as many columns each time
        made |= row & made >> step
        row &= row >> step
        step *= 2
    return made


def largest_part(rows):
    """The largest 4-connected part; of a building, the one with its corridors."""
    left, largest, most = list(rows), [0] * len(rows), 0
    while (rest := sum(row.bit_count() for row in left)) > most:
        row = max(range(len(left)), key=lambda each: left[each].bit_count())
        seeds = [0] * len(left)
        seeds[row] = left[row] & -left[row]
        part = filled(left, seeds)
        count = sum(row.bit_count() for row in part)
        if count > most:
            largest, most = part, count
        left = [row & ~taken for row, taken in zip(left, part)]
    return largest


# ---------------------------------------------------------------- places for robots

APART = 0.1  # metres between two robots, at least
DIRECTIONS = [(math.cos(0.125 * math.pi * step), math.sin(0.125 * math.pi * step)) for step in range(16)]
ROUNDS = 100  # of drawing again the places that are in the way


class Places:
    """Draws places for a fleet so that no place is in the way. A robot can drive from each place to each other one
    while robots stand at all the rest. If boxes are given (of cells, see buildings.py), the places are in one of them.
    """

    def __init__(self, floor, radius, seed, boxes=()):
        self.free, self.radius, self.random = FreeCells(floor, radius), radius, random.Random(seed)
        self.boxes = boxes

    def draw(self, count):
        """So many places, apart from each other and none in the way; raises ValueError if there is no room left."""
        places = []
        for _ in range(ROUNDS):
            while len(places) < count:
                places.append(self.next_place(places))
            places = self.passable(places)
            if len(places) == count:
                return places
        raise ValueError(f"no room for {count} places on the floor")

    def next_place(self, places):
        size = self.free.floor.resolution
        for _ in range(1_000_000):
            x, y = (round(self.random.random() * cells * size, 4)
                    for cells in (self.free.floor.columns, self.free.floor.rows))
            if self.is_allowed(x, y) and self.free.has(x, y) and self.stands_apart(x, y, places, APART):
                return x, y
        raise ValueError("no room left on the floor")

    def is_allowed(self, x, y):
        size = self.free.floor.resolution
        return not self.boxes or any(box.has(int(x / size), int(y / size)) for box in self.boxes)

    def stands_apart(self, x, y, places, gap):
        return all(math.hypot(x - other[0], y - other[1]) >= 2.0 * self.radius + gap for other in places)

    def passable(self, places):
        """The places that a robot can leave while there is one at each of the others."""
        passed = 2.0 * self.radius + self.free.floor.resolution
        open_cells = largest_part(self.free.without([(x, y, passed) for x, y in places]))
        return [place for place in places if self.can_leave(place, places, passed, open_cells)]

    def can_leave(self, place, places, passed, open_cells):
        others = [other for other in places if other != place and math.dist(place, other) < 3.0 * passed]
        return any(self.leads_out(place, direction, others, passed, open_cells) for direction in DIRECTIONS)

    def leads_out(self, place, direction, others, passed, open_cells):
        """Whether a robot can drive straight to open cells."""
        step = 0.5 * self.free.floor.resolution
        for index in range(math.ceil(1.5 * passed / step)):
            x, y = (at + index * step * along for at, along in zip(place, direction))
            if not self.free.has(x, y) or not self.stands_apart(x, y, others, 0.0):
                return False
            if self.free.has(x, y, open_cells):
                return True
        return False
