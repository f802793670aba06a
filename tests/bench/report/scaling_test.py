import unittest

from scaling import scaling_jobs, scaling_report
from support import run


class Scaling(unittest.TestCase):
    def test_jobs_are_halls_of_other_sizes_with_all_their_robots(self):
        jobs = scaling_jobs([1, 2])
        self.assertEqual(len(jobs), (6 + 5 + 4) * 2 * 2)
        self.assertEqual(jobs[0], {"name": "empty-64/1", "robots": [],
                                   "workload": {"hall": "empty", "side": 64, "seed": 1, "robots": 10}})
        self.assertEqual(jobs[-1], {"name": "rects-256/2", "robots": [],
                                    "workload": {"hall": "rects", "side": 256, "seed": 2, "robots": 960}})

    def test_every_run_is_in_the_row_of_its_job(self):
        jobs = scaling_jobs([1, 2])
        runs = [run(job["workload"]["robots"], float(index), 100.0, job["name"]) for index, job in enumerate(jobs)]
        rows = [line for line in scaling_report(runs, [1, 2]).splitlines() if " of 2 " in line]
        self.assertEqual(len(rows), 15)
        self.assertRegex(rows[0], r"^\| 10 +\| +2 of 2 \| +0\.500 \| +1\.000 \| +0 \| +2 of 2 \| +2\.50 \|")
        self.assertRegex(rows[-1], r"^\| 256 x 256 \| +960 \| +2 of 2 \| +56\.5 \|.*\| +58\.5 \|")


if __name__ == "__main__":
    unittest.main()
