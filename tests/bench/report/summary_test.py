import unittest

from summary import mean, percentile, summarise_by_robots, summarise_halls
from support import run


class Percentiles(unittest.TestCase):
    def test_without_values_there_is_none(self):
        self.assertIsNone(percentile([], 0.5))
        self.assertIsNone(mean([]))

    def test_they_are_linear_between_neighbours(self):
        values = [40.0, 10.0, 30.0, 20.0, 50.0]
        for share, expected in [(0.0, 10.0), (0.25, 20.0), (0.9, 46.0), (1.0, 50.0)]:
            self.assertAlmostEqual(percentile(values, share), expected)

    def test_the_median_is_the_middle_or_halfway_between_the_two_middle_values(self):
        self.assertEqual(percentile([5.0], 0.5), 5.0)
        self.assertEqual(percentile([9.0, 1.0, 5.0], 0.5), 5.0)
        self.assertEqual(percentile([9.0, 1.0, 5.0, 6.0], 0.5), 5.5)


class Summaries(unittest.TestCase):
    def test_times_are_of_all_runs_and_costs_of_the_solved_ones(self):
        summary, = summarise_by_robots([run(30, 60.0), run(30, 1.0, 110.0), run(30, 2.0, 150.0)])
        self.assertEqual((summary.robots, summary.runs, summary.solved), (30, 3, 2))
        self.assertAlmostEqual(summary.success_rate, 2 / 3)
        self.assertEqual(summary.median_seconds, 2.0)
        self.assertAlmostEqual(summary.percentile_90_seconds, 48.4)
        self.assertEqual(summary.longest_seconds, 60.0)
        self.assertAlmostEqual(summary.flowtime, 130.0)
        self.assertAlmostEqual(summary.makespan, 13.0)
        self.assertAlmostEqual(summary.flowtime_by_bound, 1.3)

    def test_there_is_one_for_every_number_of_robots_ascending(self):
        summaries = summarise_by_robots([run(60, 1.0, 120.0), run(15, 1.0, 120.0), run(60, 1.0)])
        self.assertEqual([summary.robots for summary in summaries], [15, 60])
        self.assertEqual(summaries[1].success_rate, 0.5)

    def test_without_solved_runs_there_are_no_costs(self):
        summary, = summarise_by_robots([run(300, 60.0)])
        self.assertEqual(summary.success_rate, 0.0)
        self.assertIsNone(summary.flowtime)
        self.assertIsNone(summary.flowtime_by_bound)

    def test_halls_are_the_first_part_of_the_names(self):
        halls = summarise_halls([run(15, 1.0, 1.0, "rects/1"), run(15, 1.0, 1.0, "empty/1"),
                                 run(15, 1.0, 1.0, "rects/2")])
        self.assertEqual(list(halls), ["empty", "rects"])
        self.assertEqual(halls["rects"][0].runs, 2)


if __name__ == "__main__":
    unittest.main()
