import unittest

import markdown


class Markdown(unittest.TestCase):
    def test_tables_are_aligned(self):
        self.assertEqual(markdown.table(["name", "s"], [["a", "1.25"], ["longer", "-"]]),
                         "| name   |    s |\n"
                         "|--------|-----:|\n"
                         "| a      | 1.25 |\n"
                         "| longer |    - |\n")

    def test_numbers_have_as_many_decimals_as_they_need(self):
        self.assertEqual(markdown.decimal(1.005, 2), "1.00")
        self.assertEqual(markdown.decimal(None, 2), "-")
        for value, text in [(0.00123, "0.0012"), (0.1234, "0.123"), (1.234, "1.23"), (12.34, "12.3"), (None, "-")]:
            self.assertEqual(markdown.seconds(value), text)
        for size, text in [(0, "0"), (1, "1"), (3 << 20, "3")]:
            self.assertEqual(markdown.mebibytes(size), text)
        self.assertEqual(markdown.percent(0.75), "75 %")
        for ratio, text in [(2.0, "2.00 x"), (12.34, "12.3 x"), (None, "-")]:
            self.assertEqual(markdown.times(ratio), text)


if __name__ == "__main__":
    unittest.main()
