"""A day in a warehouse, in short. Fleets of the loop of the client serve every goal in the end, whatever happens to
them. No robot is met, and every request is accepted. tests/bench/day has the whole day."""

import sys
import unittest

from support import PROJECT, service

sys.path.insert(0, str(PROJECT / "tests/bench/day"))

from day import STARVED, Day  # noqa: E402
from disturbances import Rates  # noqa: E402

from fleetplan import Client  # noqa: E402

OFTEN = Rates(holds=60.0, breakdowns=30.0, closures=40.0, repair=20.0, people=3)


class Days(unittest.TestCase):
    def test_every_goal_is_served_and_nobody_is_met_whatever_happens(self):
        with service() as url, Client(url) as client:
            # A budget that a busy machine does not spend.
            day = Day(client, robots=10, per_hour=400.0, seed=5, rates=OFTEN, options={"time_budget_ms": 20000})
            day.run(90.0)
            day.finish(600.0)
        figures = day.report()
        self.assertGreater(figures["offered"], 8)
        self.assertEqual(figures["done"], figures["offered"], figures)
        for wrong in ("overlaps", "goals lost", "failures", "overran", "starved"):
            self.assertFalse(figures[wrong], figures)
        self.assertLess(figures["longest wait"], STARVED)
        self.assertLess(figures["job over alone, median"], 1.6)
        happened = figures["disturbances"]
        self.assertGreater(happened["holds"] + happened["breakdowns"], 2)
        self.assertGreater(happened["closures"], 0)


if __name__ == "__main__":
    unittest.main()
