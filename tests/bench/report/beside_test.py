import unittest

from beside import beside_report
from support import run


class Beside(unittest.TestCase):
    def test_ratios_are_geometric_means_over_what_both_solved(self):
        runs = [run(15, 1.0, 110.0, "empty/1"), run(15, 1.0, 120.0, "empty/2"), run(15, 60.0, None, "empty/3")]
        others = [run(15, 2.0, 110.0, "empty/1"), run(15, 8.0, 480.0, "empty/2"), run(15, 3.0, 110.0, "empty/3")]
        report = beside_report(runs, others)
        for name in [r"empty +\| +15", r"all +\| +"]:
            self.assertRegex(report, rf"\| {name} \| 2 of 3 \| 3 of 3 \| +1\.00 \| +3\.00 \| +4\.00 x "
                                     r"\| +1\.150 \| +2\.950 \| +0\.5000 \|")

    def test_files_have_rows_of_their_own_and_invalid_plans_are_counted(self):
        runs = [run(15, 1.0, 110.0, "in/a.json"), run(15, 1.0, 110.0, "in/b.json")]
        others = [run(15, 1.0, 110.0, "in/a.json", valid=False), run(15, 1.0, 110.0, "in/b.json")]
        report = beside_report(runs, others)
        self.assertRegex(report, r"\| in/b\.json \|")
        self.assertIn("Invalid plans of the other program: 1.", report)


if __name__ == "__main__":
    unittest.main()
