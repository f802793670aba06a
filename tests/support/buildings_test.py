import base64
import json
import math
import unittest
import zlib

from buildings import HOSPITAL, OFFICE, Building
from floor import BLOCKED, FREE, UNKNOWN, Floor
from make_buildings import RADIUS, building_request
from places import FreeCells, Places, along, filled


def floor_of(picture):
    floor = Floor(len(picture[0]), len(picture), 0.1)
    for row, line in enumerate(reversed(picture)):
        for column, letter in enumerate(line):
            floor.cells[row][column] = {".": FREE, "#": BLOCKED, "?": UNKNOWN}[letter]
    return floor


def blocked_boxes(floor):
    return [(column * floor.resolution, row * floor.resolution) for row in range(floor.rows)
            for column in range(floor.columns) if not floor.is_free(column, row)]


def clearance(x, y, boxes, size):
    boxes = [(left, low) for left, low in boxes if abs(left - x) < 0.5 and abs(low - y) < 0.5]
    return min((math.hypot(max(left - x, 0.0, x - left - size), max(low - y, 0.0, y - low - size))
                for left, low in boxes), default=0.5)


class Buildings(unittest.TestCase):
    def test_they_are_the_same_for_a_seed_and_differ_between_seeds(self):
        first, again, other = (Building(OFFICE, 300, 240, seed).floor.cells for seed in (1, 1, 2))
        self.assertEqual(first, again)
        self.assertNotEqual(first, other)

    def test_they_have_free_blocked_and_unknown_cells(self):
        for style in (OFFICE, HOSPITAL):
            cells = b"".join(Building(style, 600, 400, 3).floor.cells)
            for value, share in ((FREE, 0.6), (BLOCKED, 0.03), (UNKNOWN, 0.03)):
                self.assertGreater(cells.count(value), share * len(cells), value)

    def test_doors_are_as_wide_as_the_style_says_and_free_of_furniture(self):
        building = Building(OFFICE, 600, 400, 4)
        for room in building.rooms:
            door = room.doors[0]
            self.assertTrue(16 <= door.columns <= 24, door)
            middle = building.floor.cells[door.row + door.rows // 2]
            self.assertEqual(set(middle[door.column:door.column + door.columns]), {FREE})

    def test_almost_every_free_place_is_in_one_part(self):
        floor = Building(OFFICE, 600, 400, 5).floor
        free = FreeCells(floor, RADIUS)
        connected = sum(row.bit_count() for row in free.rows)
        self.assertGreater(connected, 0.5 * sum(row.count(FREE) for row in floor.cells))


class FreeCellsOfFloors(unittest.TestCase):
    def test_a_disk_fits_anywhere_in_them(self):
        floor = Building(OFFICE, 200, 120, 1).floor
        boxes = blocked_boxes(floor)
        free = FreeCells(floor, RADIUS)
        corners = [(column * 0.05 + right, row * 0.05 + up) for row in range(0, 120, 9) for column in range(0, 200, 9)
                   if free.rows[row] >> column & 1 for right in (0.0, 0.05) for up in (0.0, 0.05)]
        self.assertGreater(len(corners), 50)
        for x, y in corners:
            self.assertGreaterEqual(clearance(x, y, boxes, 0.05), RADIUS - 1e-9)

    def test_a_disk_does_not_overlap_the_edge_of_the_floor(self):
        free = FreeCells(floor_of(["." * 9] * 7), 0.2)
        self.assertEqual([f"{row:09b}" for row in free.rows], ["000000000"] * 2 + ["001111100"] * 3 + ["000000000"] * 2)

    def test_runs_are_filled_from_any_of_their_cells(self):
        self.assertEqual(along(0b1110111011, 0b0100000010), 0b1110000011)
        self.assertEqual(along(0b1011, 0), 0)

    def test_parts_are_filled_around_corners(self):
        rows = [0b00111, 0b00100, 0b11101, 0b10000, 0b11110]
        self.assertEqual(filled(rows, [0, 0, 0b10000, 0, 0]), [0b00111, 0b00100, 0b11100, 0b10000, 0b11110])


class PlacesOnFloors(unittest.TestCase):
    def test_none_blocks_a_corridor(self):
        floor = floor_of(["#" * 60, *["#" + "." * 58 + "#"] * 6, "#" * 60])
        with self.assertRaises(ValueError):
            Places(floor, 0.2, 1).draw(3)  # two ends are the most
        self.assertEqual(len(Places(floor, 0.2, 1).draw(1)), 1)

    def test_robots_stand_apart_from_each_other_and_from_obstacles(self):
        request = building_request("hospital", 300, 260, 12, 7, "rows")
        floor = Building(HOSPITAL, 300, 260, 7).floor
        boxes = blocked_boxes(floor)
        for member in ("start", "goal"):
            places = [(robot[member]["x"], robot[member]["y"]) for robot in request["robots"]]
            self.assertEqual(len(places), 12)
            for index, place in enumerate(places):
                self.assertGreaterEqual(clearance(*place, boxes, 0.05), RADIUS - 1e-9)
                self.assertTrue(all(math.dist(place, other) >= 2.0 * RADIUS for other in places[:index]))


class Maps(unittest.TestCase):
    FLOOR = floor_of(["#?.",
                      "..#"])

    def test_rows_have_the_top_first_and_unknown_cells_blocked(self):
        self.assertEqual(self.FLOOR.map("rows"), {"resolution": 0.1, "rows": ["##.", "..#"]})

    def test_images_have_the_greys_of_map_server(self):
        self.assertEqual(self.FLOOR.pgm(), b"P5\n3 2\n255\n" + bytes([0, 205, 254, 254, 254, 0]))
        image = self.FLOOR.map("pgm")["image"]
        self.assertEqual(base64.b64decode(image["pgm"]), self.FLOOR.pgm())
        free, unknown = (1.0 - grey / 255 for grey in (254, 205))
        self.assertTrue(free < image["free_thresh"] <= unknown <= image["occupied_thresh"])

    def test_png_has_the_same_greys(self):
        content = self.FLOOR.png()
        self.assertEqual(content[:8], b"\x89PNG\r\n\x1a\n")
        begin = content.index(b"IDAT") + 4
        length = int.from_bytes(content[begin - 8:begin - 4], "big")
        lines = zlib.decompress(content[begin:begin + length])
        self.assertEqual(lines, bytes([0, 0, 205, 254, 0, 254, 254, 0]))


class Requests(unittest.TestCase):
    def test_they_are_the_same_for_the_same_arguments(self):
        first, again, other = (json.dumps(building_request("office", 300, 260, 4, seed)) for seed in (1, 1, 2))
        self.assertEqual(first, again)
        self.assertNotEqual(first, other)


if __name__ == "__main__":
    unittest.main()
