import unittest

from comparison import Comparison
from paper import claimed_success
from summary import summarise_halls
from support import result, run
from tables import closing_lines, comparison_report, hall_report, run_report


class Tables(unittest.TestCase):
    def test_the_paper_states_success_only_for_the_empty_hall(self):
        self.assertEqual(claimed_success("empty", 210), "100 %")
        self.assertEqual(claimed_success("empty", 225), "-")
        self.assertEqual(claimed_success("empty", 285), "< 10 %")
        self.assertEqual(claimed_success("rects", 15), "-")

    def test_halls_show_the_success_rate_beside_the_papers(self):
        runs = [run(15, 1.0, 110.0)] * 3 + [run(15, 60.0)] + [run(300, 60.0)] * 4
        report = hall_report(summarise_halls(runs))
        self.assertIn("| 15            |   75 % |  100 % |", report)
        self.assertIn("| 300           |    0 % | < 10 % |", report)
        self.assertIn("The paper's claims", report)

    def test_the_makespan_is_also_over_its_bound(self):
        report = hall_report(summarise_halls([run(15, 1.0, 110.0), run(15, 1.0, 130.0)]))
        self.assertRegex(report, r"\| +1\.200 \| +12\.0 \| +1\.200 \| +0 \|")

    def test_other_halls_are_without_the_papers_claims(self):
        self.assertNotIn("The paper's claims", hall_report(summarise_halls([run(256, 1.0, 110.0, "crowd/1")])))

    def test_runs_have_a_row_each(self):
        report = run_report([run(15, 1.0, 125.0, "a.json", planned=15), run(15, 60.0, file="b.json", planned=14)])
        self.assertRegex(report, r"\| a\.json +\| +15 \| +15 \| 1\.00 \|.*\| +125\.0 \| +1\.250 \| +12\.5 \| +1\.250 \|")
        self.assertRegex(report, r"\| b\.json +\| +15 \| +14 \| 60\.0 \|.*\| +- \| +- \| +- \| +- \|")

    def test_comparisons_show_failures_and_totals(self):
        report = comparison_report(Comparison([run(9, 1.0, 90.0, "a"), run(9, 60.0, None, "b")],
                                              [result("a", 9, 4.0, 100.0), result("b", 9, 1.0, 10.0)]))
        self.assertIn("60.0 failed", report)
        self.assertIn("solved: 1 of 2, the reference 2, only the reference 1", report)
        self.assertIn("0.2 s or more (1 rows): geometric mean 4.00 x, smallest 4.00 x", report)
        self.assertIn("flowtime ratio: mean 0.900, largest 0.900", report)
        self.assertIn("flowtime / bound: mean 0.900, largest 0.900", report)

    def test_the_last_lines_count_faults_and_report_a_busy_machine(self):
        idle = run(15, 1.0, 100.0, cpu_seconds=0.99, peak_memory=5 << 20)
        busy = run(15, 1.0, 100.0, cpu_seconds=0.5, valid=False)
        self.assertIn("Plans: 1, all checked in continuous time; invalid: 0.", closing_lines([idle]))
        self.assertNotIn("busy", closing_lines([idle]))
        self.assertIn("Plans: 2, all checked in continuous time; invalid: 1.", closing_lines([idle, busy]))
        self.assertIn("5 MiB. Wall time 2.00 s, CPU time 1.49 s: the machine was busy", closing_lines([idle, busy]))


if __name__ == "__main__":
    unittest.main()
