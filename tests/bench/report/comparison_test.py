import math
import unittest

from comparison import SHORTEST_REFERENCE_S, Comparison
from support import result


class Comparisons(unittest.TestCase):
    def test_runs_are_paired_by_file_and_number_of_robots(self):
        comparison = Comparison([result("a", 60, 1.0, 90.0), result("a", 120, 2.0, 300.0), result("b", 60, 1.0, 1.0)],
                                [result("a", 120, 8.0, 200.0), result("a", 60, 2.0, 100.0)])
        self.assertEqual([pair.speedup for pair in comparison.pairs], [2.0, 4.0])
        self.assertEqual([pair.flowtime_ratio for pair in comparison.pairs], [0.9, 1.5])
        self.assertEqual(comparison.smallest_speedup, 2.0)
        self.assertAlmostEqual(comparison.mean_speedup, math.sqrt(8.0))
        self.assertAlmostEqual(comparison.mean_flowtime_ratio, 1.2)
        self.assertEqual(comparison.largest_flowtime_ratio, 1.5)

    def test_speed_ups_count_only_where_the_reference_took_long_enough(self):
        comparison = Comparison(
            [result("short", 9, 0.1, 10.0), result("long", 9, 0.1, 10.0)],
            [result("short", 9, 0.199, 10.0), result("long", 9, SHORTEST_REFERENCE_S, 10.0)])
        self.assertEqual(comparison.counted, 1)
        self.assertEqual(comparison.smallest_speedup, 2.0)
        self.assertIsNotNone(comparison.pairs[0].speedup)

    def test_ratios_need_both_solved_and_lost_instances_are_counted(self):
        comparison = Comparison([result("lost", 9, 60.0), result("won", 9, 1.0, 10.0), result("neither", 9, 60.0)],
                                [result("lost", 9, 1.0, 5.0), result("won", 9, 60.0), result("neither", 9, 60.0)])
        self.assertEqual(comparison.solved_by_us, 1)
        self.assertEqual(comparison.solved_by_reference, 1)
        self.assertEqual(comparison.solved_only_by_reference, 1)
        self.assertEqual(comparison.counted, 0)
        self.assertIsNone(comparison.mean_speedup)
        self.assertIsNone(comparison.mean_flowtime_ratio)
        self.assertEqual([pair.speedup for pair in comparison.pairs], [None] * 3)


if __name__ == "__main__":
    unittest.main()
