import json
import pathlib
import tempfile
import unittest
from unittest import mock

import building_scaling
from building_scaling import building_jobs, building_report
from support import result, run


def steps(parse, plan, verify, write):
    return {"parse_seconds": parse, "plan_seconds": plan, "verify_seconds": verify, "write_seconds": write}


class Jobs(unittest.TestCase):
    def test_they_are_files_that_are_written_once(self):
        with tempfile.TemporaryDirectory() as folder, mock.patch.object(building_scaling, "ROBOTS", [2, 3]):
            jobs = building_jobs([1], folder, "rows", [260])
            self.assertEqual(jobs, [{"name": "office-260/1", "file": str(pathlib.Path(folder, "office-260-1.rows.json")),
                                     "robots": [2, 3]}])
            file = pathlib.Path(jobs[0]["file"])
            request = json.loads(file.read_text())
            self.assertEqual((len(request["map"]["rows"]), len(request["robots"])), (260, 3))
            file.write_text("kept")
            building_jobs([1], folder, "rows", [260])
            self.assertEqual(file.read_text(), "kept")


class Report(unittest.TestCase):
    RUNS = [run(10, 1.0, 110.0, "office-500/1", **steps(0.1, 0.7, 0.15, 0.05)),
            run(10, 3.0, 120.0, "office-500/2", **steps(0.2, 2.5, 0.2, 0.1)),
            run(60, 9.0, None, "office-2000/1"),
            run(60, 9.0, 100.0, "empty-64/1")]

    def test_every_size_and_number_of_robots_has_a_row_with_its_steps(self):
        lines = building_report(self.RUNS, []).splitlines()
        self.assertEqual(len(lines), 2 + 2 + 2)
        self.assertRegex(lines[4], r"^\| 500 x 500 +\| +10 \| 2 of 2 \| +2\.00 \| +0\.150 \| +1\.60 \| +0\.175 \| +0\.0750 "
                                   r"\| +0 \| +115\.0 \| +1\.150 \|$")
        self.assertRegex(lines[5], r"^\| 2000 x 2000 \| +60 \| 0 of 1 \| +9\.00 \| +- \| +- \| +- \| +- \| +0 \| +- \| +- \|$")

    def test_another_planner_is_beside(self):
        reference = [result("office-500/1", 10, 8.0, 100.0), result("office-500/2", 10, 10.0, 125.0),
                     result("office-2000/1", 60, 60.0)]
        lines = building_report(self.RUNS, reference).splitlines()
        self.assertRegex(lines[4], r"\| +2 of 2 \| +9\.00 \| +1\.030 \|$")
        self.assertRegex(lines[5], r"\| +0 of 1 \| +60\.0 \| +- \|$")


if __name__ == "__main__":
    unittest.main()
