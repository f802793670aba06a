import pathlib
import tempfile
import unittest

import workbook
from support import write_workbook


class Workbook(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.file = pathlib.Path(folder.name, "book.xlsx")

    def test_sheets_have_their_rows_by_column(self):
        write_workbook(self.file, {"first": [["name", None, 1.5], [2]], "second": [[None, "other"]]})
        self.assertEqual(workbook.read_sheets(self.file), {"first": [{0: "name", 2: "1.5"}, {0: "2"}],
                                                           "second": [{1: "other"}]})

    def test_columns_are_numbered(self):
        self.assertEqual([workbook.column_of(cell) for cell in ("A1", "Z9", "AA10", "CL3")], [0, 25, 26, 89])


if __name__ == "__main__":
    unittest.main()
