"""Shared by the tests of this folder."""

import contextlib
import io
import pathlib
import tempfile
import unittest
import zipfile
from xml.sax.saxutils import escape

from results import Result, Run


def result(file, robots, seconds, flowtime=None):
    return Result(file, robots, flowtime is not None, 1, seconds, flowtime, flowtime)


def run(robots, seconds, flowtime=None, file="empty/1", **more):
    """A run that solved its instance if it has a flowtime; the lower bound is 100. Makespans are
    a tenth."""
    costs = {"makespan": None} if flowtime is None else {"makespan": flowtime / 10, "lower_bound": 100.0,
                                                              "makespan_lower_bound": 10.0}
    return Run(**{"file": file, "robots": robots, "solved": flowtime is not None, "attempts": 1, "seconds": seconds,
                  "flowtime": flowtime, "cpu_seconds": seconds, **costs, **more})


def write_workbook(file, sheets):
    """An XLSX file of {name: rows of texts, numbers and None}, at most 26 columns, with what workbook.py reads."""
    texts = sorted({cell for rows in sheets.values() for row in rows for cell in row if isinstance(cell, str)})
    main = 'xmlns="http://schemas.openxmlformats.org/spreadsheetml/2006/main"'
    links = 'xmlns:r="http://schemas.openxmlformats.org/officeDocument/2006/relationships"'
    with zipfile.ZipFile(file, "w") as book:
        book.writestr("xl/sharedStrings.xml",
                      f"<sst {main}>{''.join(f'<si><t>{escape(text)}</t></si>' for text in texts)}</sst>")
        names = "".join(f'<sheet name="{name}" r:id="rId{number}"/>' for number, name in enumerate(sheets))
        book.writestr("xl/workbook.xml", f"<workbook {main} {links}><sheets>{names}</sheets></workbook>")
        book.writestr("xl/_rels/workbook.xml.rels", "<Relationships>" + "".join(
            f'<Relationship Id="rId{number}" Target="worksheets/{number}.xml"/>' for number in range(len(sheets))) +
            "</Relationships>")
        for number, rows in enumerate(sheets.values()):
            lines = "".join(f"<row>{sheet_cells(row, at, texts)}</row>" for at, row in enumerate(rows, 1))
            book.writestr(f"xl/worksheets/{number}.xml",
                          f"<worksheet {main}><sheetData>{lines}</sheetData></worksheet>")


def sheet_cells(row, at, texts):
    def cell(value, column):
        kind, stored = (' t="s"', texts.index(value)) if isinstance(value, str) else ("", value)
        return f'<c r="{chr(ord("A") + column)}{at}"{kind}><v>{stored}</v></c>'

    return "".join(cell(value, column) for column, value in enumerate(row) if value is not None)


class ProgramTest(unittest.TestCase):
    """With a temporary folder, and in it a program that stands for a benchmark."""

    PROGRAM = ""  # its source

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.program = self.folder / "program"
        self.program.write_text(self.PROGRAM)
        self.program.chmod(0o755)

    def run_main(self, main, *words):
        """The exit status of main(PROGRAM, WORDS) and the text printed."""
        with contextlib.redirect_stdout(io.StringIO()) as text, contextlib.redirect_stderr(text):
            status = main(str(self.program), list(words))
        return status, text.getvalue()
