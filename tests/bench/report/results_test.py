import unittest

from results import Result, Run, read_results

HEAD = "file,robots,solved,attempts,seconds,flowtime,makespan"
MORE = "cpu_seconds,peak_memory,planned,lower_bound,expansions,improvements,deterministic,valid"


class Results(unittest.TestCase):
    def test_rows_of_the_benchmark_are_read(self):
        solved, failed = read_results(
            [f"{HEAD},{MORE}\n",
             "empty/1,60,1,2,0.125,2500.5,130.25,0.12,1048576,60,2000.4,99,0,1,1\n",
             "rects/1,300,0,9,60,,,59.5,1048576,299,,999,0,0,0\n"], Run)
        self.assertEqual(solved, Run("empty/1", 60, True, 2, 0.125, 2500.5, 130.25, 0.12, 1048576, 60, 2000.4, 99, 0,
                                     True, True))
        self.assertAlmostEqual(solved.flowtime_by_bound, 1.25)
        self.assertFalse(failed.solved)
        self.assertIsNone(failed.flowtime)
        self.assertIsNone(failed.flowtime_by_bound)
        self.assertFalse(failed.valid)
        self.assertIsNone(failed.plan_seconds, "older files do not have it")

    def test_columns_may_be_in_any_order_with_others_between(self):
        results = read_results(["robots,note,makespan,flowtime,seconds,attempts,solved,file\r\n",
                                "15,x,2.5,3.5,0.5,1,1,a.json\r\n"])
        self.assertEqual(results, [Result("a.json", 15, True, 1, 0.5, 3.5, 2.5)])

    def test_faults_are_reported_with_their_line(self):
        for lines, message in [
                ([HEAD, "a,1,1,1,1,1,1", "a,one,1,1,1,1,1"], "line 3: 'one' is not a value of column robots"),
                ([HEAD, "a,1"], "line 2: not as many values"),
                ([HEAD, "a,1,1,1,1,1,1,1"], "line 2: not as many values"),
                (["file,robots", "a,1"], "there is no column solved")]:
            with self.assertRaisesRegex(ValueError, message):
                read_results(lines)


if __name__ == "__main__":
    unittest.main()
