"""A floor of cells as SLAM maps have it, and its forms in a request: rows, PGM and PNG."""

import base64
import struct
import zlib

FREE, BLOCKED, UNKNOWN = 0, 1, 2
GREY = bytes([254, 0, 205])  # of the three in a map_server image
LETTERS = b".##"  # rows have no letter for unknown cells, which are blocked by default
FORMS = ("rows", "pgm", "png")


class Floor:
    """Cells that begin unknown. Positions and sizes are in cells; row 0 is the bottom one."""

    def __init__(self, columns, rows, resolution):
        self.columns, self.rows, self.resolution = columns, rows, resolution
        self.cells = [bytearray([UNKNOWN]) * columns for _ in range(rows)]

    def cells_of(self, metres):
        return round(metres / self.resolution)

    def fill(self, column, row, columns, rows, value):
        """Sets a rectangle, whose lower left cell is (column, row); what is outside the floor is cut off."""
        left, right = max(0, column), min(self.columns, column + columns)
        if left >= right:
            return
        line = bytes([value]) * (right - left)
        for r in range(max(0, row), min(self.rows, row + rows)):
            self.cells[r][left:right] = line

    def outline(self, column, row, columns, rows):
        """A box as a laser sees it: its border is blocked, what is inside stays unknown."""
        self.fill(column, row, columns, rows, BLOCKED)
        self.fill(column + 1, row + 1, columns - 2, rows - 2, UNKNOWN)

    @classmethod
    def from_png(cls, content, resolution):
        """Of an image as png() writes it."""
        columns, rows = struct.unpack(">II", content[16:24])
        begin = content.index(b"IDAT") + 4
        lines = zlib.decompress(content[begin:])
        made = cls(columns, rows, resolution)
        values = {grey: value for value, grey in enumerate(GREY)}
        table = bytes(values.get(grey, UNKNOWN) for grey in range(256))
        for row in range(rows):
            first = (rows - 1 - row) * (columns + 1) + 1
            made.cells[row] = bytearray(lines[first:first + columns].translate(table))
        return made

    def is_free(self, column, row):
        return 0 <= column < self.columns and 0 <= row < self.rows and self.cells[row][column] == FREE

    def bits(self, value):
        """Of each row an integer, whose bit c is set where column c has the value."""
        digits = bytes(0x31 if each == value else 0x30 for each in range(256))
        return [int(row[::-1].translate(digits), 2) for row in self.cells]

    # ------------------------------------------------------------ as a member `map` of a request

    def map(self, form):
        if form == "rows":
            table = LETTERS + bytes(253)
            return {"resolution": self.resolution,
                    "rows": [row.translate(table).decode() for row in reversed(self.cells)]}
        content = self.png() if form == "png" else self.pgm()
        return {"image": {form: base64.b64encode(content).decode(), "resolution": self.resolution,
                          "origin": [0.0, 0.0, 0.0], "negate": 0, "occupied_thresh": 0.65, "free_thresh": 0.196,
                          "mode": "trinary"}}

    def pgm(self):
        return b"P5\n%d %d\n255\n" % (self.columns, self.rows) + b"".join(self.grey_lines())

    def png(self):
        header = struct.pack(">IIBBBBB", self.columns, self.rows, 8, 0, 0, 0, 0)  # 8 bits of grey
        lines = b"".join(b"\0" + line for line in self.grey_lines())  # 0: the line is not filtered
        return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(lines, 9))
                + chunk(b"IEND", b""))

    def grey_lines(self):
        table = GREY + bytes(253)
        return (row.translate(table) for row in reversed(self.cells))


def chunk(name, content):
    return struct.pack(">I", len(content)) + name + content + struct.pack(">I", zlib.crc32(name + content))
