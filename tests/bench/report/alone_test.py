import unittest

from alone import alone_report
from support import run


class Alone(unittest.TestCase):
    def test_without_robots_planned_alone_there_is_no_report(self):
        self.assertEqual(alone_report([run(15, 1.0, 110.0)]), "")

    def test_ratios_of_planning_times_are_geometric_means(self):
        def made(plan):
            return run(15, 9.0, 110.0, plan_seconds=plan, alone_seconds=0.5, floor_share=0.05)

        self.assertRegex(alone_report([made(1.0), made(4.0)]),
                         r"\| empty +\| +15 \| +5 % \| 2 of 2 \| +2\.50 \| +0\.500 \| 4\.00 x \| +8\.00 x \|")


if __name__ == "__main__":
    unittest.main()
