"""Generates buildings as robots map them: an office floor and a hospital wing, of any size and the same for a seed.

Storeys of rooms lie on both sides of parallel corridors, which wider crossings connect. Rooms have doors, furniture,
corners that no robot has seen; walls are ragged, and single cells are wrong. Lengths are metres unless they are called
cells. Random numbers come only from random.Random(seed).random(): its values are the same in all Python versions.
"""

import dataclasses
import math
import random

from floor import BLOCKED, FREE, UNKNOWN, Floor

RESOLUTION = 0.05
MARGIN = 0.5  # around the building, unknown
WALL = 0.15
CROSSINGS = 30.0  # from one to the next, about
CLOSED = 0.05  # share of rooms that were never entered
SECOND_DOOR = 0.3  # share of walls between neighbours that have a door
DOOR_CLEARANCE = 1.0  # before and behind a door, where nothing stands
FURNITURE_GAP = 0.75  # between two pieces
NOISE = 0.02  # share of cells that are drawn to be wrong ...
BLOCKED_NOISE, UNKNOWN_NOISE = 0.006, 0.004  # ... and shares of those, if free and not beside a wall


@dataclasses.dataclass(frozen=True)
class Style:
    room_depth: float
    corridor: float
    rooms: tuple  # narrowest and widest
    doors: tuple  # narrowest and widest
    pieces_per_m2: float
    pieces: tuple  # names of furniture, to draw from


OFFICE = Style(5.0, 2.4, (3.0, 8.0), (0.8, 1.2), 0.35,
               ("desk", "desk", "table", "cabinet", "chair", "chair", "slanted"))
HOSPITAL = Style(5.5, 3.0, (4.0, 7.0), (1.0, 1.2), 0.2, ("bed", "bed", "cabinet", "chair", "table"))
STYLES = {"office": OFFICE, "hospital": HOSPITAL}
SIZES = {"desk": (1.6, 0.8), "table": (1.8, 0.9), "cabinet": (1.2, 0.45), "chair": (0.45, 0.45), "bed": (2.0, 0.9),
         "slanted": (1.4, 0.7)}
AT_WALL = {"desk": 0.6, "table": 0.0, "cabinet": 1.0, "chair": 0.1, "bed": 1.0, "slanted": 0.0}  # shares


@dataclasses.dataclass(frozen=True)
class Box:
    """A rectangle of cells."""
    column: int
    row: int
    columns: int
    rows: int

    def grown(self, cells):
        return Box(self.column - cells, self.row - cells, self.columns + 2 * cells, self.rows + 2 * cells)

    def has(self, column, row):
        return self.overlaps(Box(column, row, 1, 1))

    def overlaps(self, other):
        return (self.column < other.column + other.columns and other.column < self.column + self.columns
                and self.row < other.row + other.rows and other.row < self.row + self.rows)


@dataclasses.dataclass
class Room:
    box: Box
    doors: list  # boxes before and behind them, where nothing stands

    def keeps_clear(self, box):
        return any(box.overlaps(door) for door in self.doors)


class Building:
    """The floor, and where its corridors, crossings and rooms are."""

    def __init__(self, style, columns, rows, seed):
        self.style, self.random = style, random.Random(seed)
        self.floor = Floor(columns, rows, RESOLUTION)
        self.corridors, self.crossings, self.rooms = [], [], []
        self.build()
        for room in self.rooms:
            self.furnish(room)
            self.leave_unseen(room)
        self.add_noise()

    # ------------------------------------------------------------ chance

    def between(self, low, high):
        return low + self.random.random() * (high - low)

    def below(self, limit):
        return int(self.random.random() * limit)

    def happens(self, share):
        return self.random.random() < share

    # ------------------------------------------------------------ walls and doors

    def build(self):
        """Carves corridors, crossings and rooms out of a block."""
        floor, cells = self.floor, self.floor.cells_of
        margin, wall, corridor = cells(MARGIN), cells(WALL), cells(self.style.corridor)
        inside = Box(margin, margin, floor.columns - 2 * margin, floor.rows - 2 * margin)
        floor.fill(inside.column, inside.row, inside.columns, inside.rows, BLOCKED)
        inside = inside.grown(-wall)
        spans = self.spans(inside, corridor)
        self.crossings = [Box(end, inside.row, corridor, inside.rows) for _, end in spans[:-1]]

        storey = 2.0 * self.style.room_depth + self.style.corridor + 3.0 * WALL
        storeys = max(1, round(inside.rows * RESOLUTION / storey))
        for index in range(storeys):
            bottom = inside.row + inside.rows * index // storeys
            top = inside.row + inside.rows * (index + 1) // storeys - (wall if index + 1 < storeys else 0)
            row = (bottom + top - corridor) // 2
            self.corridors.append(Box(inside.column, row, inside.columns, corridor))
            for span in spans:
                self.add_rooms(span, bottom, row - wall, door_row=row - wall)
                self.add_rooms(span, row + corridor + wall, top, door_row=row + corridor)
        for box in self.corridors + self.crossings:
            floor.fill(box.column, box.row, box.columns, box.rows, FREE)

    def spans(self, inside, corridor):
        """The columns between crossings, as (first, end); a crossing begins at each end but the last."""
        count = max(1, round(inside.columns * RESOLUTION / CROSSINGS))
        width = (inside.columns - count * corridor) // (count + 1)
        spans, first = [], inside.column
        for index in range(count + 1):
            end = first + width if index < count else inside.column + inside.columns
            spans.append((first, end))
            first = end + corridor
        return spans

    def add_rooms(self, span, bottom, top, door_row):
        """A row of rooms from wall to wall. Rooms at a crossing keep a wall to it."""
        wall = self.floor.cells_of(WALL)
        narrowest = self.floor.cells_of(self.style.rooms[0])
        at, end = span[0] + wall, span[1] - wall
        before = None
        while end - at >= narrowest:
            columns = min(self.floor.cells_of(self.between(*self.style.rooms)), end - at)
            if end - at - columns < narrowest + wall:
                columns = end - at
            box = Box(at, bottom, columns, top - bottom)
            at += columns + wall
            closed = self.happens(CLOSED)
            self.floor.fill(box.column, box.row, box.columns, box.rows, UNKNOWN if closed else FREE)
            if closed:
                before = None
                continue
            room = Room(box, [])
            self.rooms.append(room)
            self.add_door(room, door_row)
            if before and self.happens(SECOND_DOOR):
                self.add_side_door(before, room)
            before = room

    def door_width(self):
        return self.floor.cells_of(self.between(*self.style.doors))

    def add_door(self, room, row):
        """A door to the corridor."""
        width, wall, clear = self.door_width(), *map(self.floor.cells_of, (WALL, DOOR_CLEARANCE))
        column = room.box.column + 2 + self.below(room.box.columns - width - 4)
        self.floor.fill(column, row, width, wall, FREE)
        room.doors.append(Box(column, row - clear, width, wall + 2 * clear))

    def add_side_door(self, left, right):
        """A door between two rooms."""
        width, wall, clear = self.door_width(), *map(self.floor.cells_of, (WALL, DOOR_CLEARANCE))
        row = right.box.row + 2 + self.below(right.box.rows - width - 4)
        self.floor.fill(right.box.column - wall, row, wall, width, FREE)
        for room in (left, right):
            room.doors.append(Box(right.box.column - wall - clear, row, wall + 2 * clear, width))

    # ------------------------------------------------------------ furniture

    def furnish(self, room):
        gap = self.floor.cells_of(FURNITURE_GAP)
        occupied = list(room.doors)
        for _ in range(int(room.box.columns * room.box.rows * RESOLUTION**2 * self.style.pieces_per_m2)):
            piece = self.style.pieces[self.below(len(self.style.pieces))]
            box = self.place(piece, room.box)
            if box and not any(box.overlaps(other) for other in occupied):
                occupied.append(box.grown(gap))
                self.draw(piece, box)

    def place(self, piece, room):
        """A box for the piece, at a wall of the room's box or anywhere in it; none if it is too small."""
        columns, rows = map(self.floor.cells_of, SIZES[piece])
        if piece == "slanted":
            columns = rows = math.ceil(math.hypot(columns, rows))
        if self.happens(0.5):
            columns, rows = rows, columns
        if columns >= room.columns or rows >= room.rows:
            return None
        right, up = self.below(room.columns - columns + 1), self.below(room.rows - rows + 1)
        if self.happens(AT_WALL[piece]):
            right, up = [(0, up), (room.columns - columns, up), (right, 0), (right, room.rows - rows)][self.below(4)]
        return Box(room.column + right, room.row + up, columns, rows)

    def draw(self, piece, box):
        floor = self.floor
        if piece == "slanted":
            self.draw_slanted(box)
        elif piece in ("table", "chair"):  # a laser sees legs only
            leg = floor.cells_of(0.1 if piece == "table" else 0.05)
            for column in (box.column, box.column + box.columns - leg):
                for row in (box.row, box.row + box.rows - leg):
                    floor.fill(column, row, leg, leg, BLOCKED)
        else:
            floor.outline(box.column, box.row, box.columns, box.rows)

    def draw_slanted(self, box):
        angle = self.between(0.2, 1.3)
        cosine, sine = math.cos(angle), math.sin(angle)
        half_length, half_width = (0.5 * size / RESOLUTION for size in SIZES["slanted"])
        for row in range(box.rows):
            for column in range(box.columns):
                right, up = column + 0.5 - 0.5 * box.columns, row + 0.5 - 0.5 * box.rows
                along, across = abs(cosine * right + sine * up), abs(cosine * up - sine * right)
                if along <= half_length and across <= half_width:
                    inside = along < half_length - 1.5 and across < half_width - 1.5
                    self.floor.fill(box.column + column, box.row + row, 1, 1, UNKNOWN if inside else BLOCKED)

    # ------------------------------------------------------------ what the robot that made the map got wrong

    def leave_unseen(self, room):
        """A corner of half of the rooms is unknown: a triangle."""
        if not self.happens(0.5):
            return
        size = self.floor.cells_of(self.between(0.2, 0.6))
        at_right, at_top = self.happens(0.5), self.happens(0.5)
        for index in range(size):
            columns = size - index
            column = room.box.column + room.box.columns - columns if at_right else room.box.column
            row = room.box.row + room.box.rows - 1 - index if at_top else room.box.row + index
            if not room.keeps_clear(Box(column, row, columns, 1)):
                self.floor.fill(column, row, columns, 1, UNKNOWN)

    def add_noise(self):
        """Ragged walls, and single cells in the free space that are blocked or unknown."""
        floor = self.floor
        clear = Floor(floor.columns, floor.rows, RESOLUTION)
        for room in self.rooms:
            for box in room.doors:
                clear.fill(box.column, box.row, box.columns, box.rows, FREE)
        for _ in range(int(NOISE * floor.columns * floor.rows)):
            column, row = self.below(floor.columns), self.below(floor.rows)
            drawn = self.random.random()
            if not floor.is_free(column, row) or clear.is_free(column, row):
                continue
            if any(not floor.is_free(column + right, row + up) for right, up in ((1, 0), (-1, 0), (0, 1), (0, -1))):
                floor.cells[row][column] = BLOCKED
            elif drawn < BLOCKED_NOISE:
                floor.cells[row][column] = BLOCKED
            elif drawn < BLOCKED_NOISE + UNKNOWN_NOISE:
                floor.cells[row][column] = UNKNOWN
