import json
import re
import sys
import unittest

import bench
from support import ProgramTest

# Stands for fleetplan_bench: echoes its jobs as runs of half a second each, and "bad" ones as invalid.
PROGRAM = """#!%s
import json, sys
print("file,robots,solved,attempts,seconds,flowtime,makespan,cpu_seconds,peak_memory,planned,lower_bound,expansions,"
      "improvements,deterministic,valid", flush=True)
for line in sys.stdin:
    job = json.loads(line)
    for robots in job["robots"] or [job["workload"]["robots"] if "workload" in job else 7]:
        valid = int("bad" not in job["name"])
        print(f"{job['name']},{robots},1,1,0.5,120,30,0.5,1048576,{robots},100,9,0,1,{valid}", flush=True)
""" % sys.executable


class Bench(ProgramTest):
    PROGRAM = PROGRAM

    def run_bench(self, *words):
        return self.run_main(bench.main, "--output", str(self.folder / "out"), *words)

    def write_request(self, name):
        file = self.folder / name
        file.write_text(json.dumps({"map": {}, "robots": []}))
        return str(file)

    def test_the_papers_workloads_are_measured_and_reported(self):
        status, text = self.run_bench("--seeds", "1", "--robots", "15,30")
        self.assertEqual(status, 0)
        self.assertRegex(text, r"\| 15 +\| +100 % \| 100 % \| +0\.500 \|")
        self.assertIn("Plans: 4,", text)
        rows = (self.folder / "out/paper.csv").read_text().splitlines()
        self.assertEqual(len(rows), 1 + 2 * 2)

    def test_earlier_runs_are_reported_without_measuring(self):
        _, first = self.run_bench("--seeds", "1", "--robots", "15,30")
        self.program.unlink()
        self.assertEqual(self.run_bench("--read", str(self.folder / "out/paper.csv")), (0, first))

    def test_files_have_a_row_each(self):
        status, text = self.run_bench(self.write_request("a.json"))
        self.assertEqual(status, 0)
        self.assertRegex(text, r"a\.json \| +7 \| +7 \| 0\.500 \|")
        self.assertEqual(self.run_bench("--read", str(self.folder / "out/files.csv")), (status, text))

    def test_a_chart_of_files_is_rejected(self):
        self.run_bench(self.write_request("a.json"))
        status, text = self.run_bench("--read", str(self.folder / "out/files.csv"), "--chart")
        self.assertEqual(status, 1)
        self.assertIn("only the paper's workloads have a chart", text)

    def write_reference(self):
        self.write_request("a.json")
        reference = self.folder / "reference.csv"
        reference.write_text("file,robots,solved,attempts,seconds,flowtime,makespan\na.json,7,1,1,1.5,100,20\n")
        return str(reference)

    def test_budgets_can_be_those_of_the_reference(self):
        self.program.write_text(PROGRAM.replace("{job['name']},{robots},1,1,0.5",
                                                "{job['name']},{robots},1,1,{job['options']['time_budget_ms'] / 1000}"))
        status, text = self.run_bench("--reference", self.write_reference(), "--reference-budget")
        self.assertEqual(status, 0)
        self.assertRegex(text, r"\| a\.json \| +7 \| +1\.50 \| +1\.50 \|")

    def test_runs_are_compared_with_the_reference(self):
        status, text = self.run_bench("--reference", self.write_reference())
        self.assertEqual(status, 0)
        self.assertRegex(text, r"\| a\.json \| +7 \| +1\.50 \| 0\.500 \| +3\.00 x \| +100\.0 \| +120\.0 \| 1\.200 \| +1\.200 \|")

    def test_scaling_has_three_tables_of_halls_and_one_of_buildings(self):
        status, text = self.run_bench("--scaling", "--seeds", "1", "--sides", "500")
        self.assertEqual(status, 0)
        self.assertEqual(text.count("| empty solved |"), 3)
        self.assertEqual(text.count("| 500 x 500 |"), 3)

    def test_buildings_are_measured_beside_another_binary(self):
        status, text = self.run_bench("--buildings", "--seeds", "1", "--sides", "500", "--binary", self.other_program())
        self.assertEqual(status, 0)
        self.assertEqual(len(re.findall(r"\| +0\.500 \|.*\| +1 of 1 \| +4\.50 \| +1\.200 \|$", text, re.M)), 3)
        self.assertTrue((self.folder / "out/binary.csv").exists())

    def other_program(self):
        other = self.folder / "other"
        other.write_text(PROGRAM.replace("0.5,120", "4.5,100"))
        other.chmod(0o755)
        return str(other)

    def test_all_workloads_can_be_measured_beside_another_binary(self):
        status, text = self.run_bench("--seeds", "1-2", "--robots", "15,30", "--binary", self.other_program())
        self.assertEqual(status, 0)
        for name in [r"empty +\| +15", r"rects +\| +30"]:
            self.assertRegex(text, rf"\| {name} \| +2 of 2 \| +2 of 2 \| +0\.500 \| +4\.50 \| +9\.00 x "
                                   r"\| +1\.200 \| +1\.000 \| +1\.2000 \|")
        self.assertRegex(text, r"\| all +\| +\| +8 of 8 \|")
        self.assertEqual(len((self.folder / "out/binary.csv").read_text().splitlines()), 1 + 8)
        self.assertEqual(len((self.folder / "out/paper.csv").read_text().splitlines()), 1 + 8)

    def test_both_binaries_are_compared_with_the_reference(self):
        status, text = self.run_bench("--reference", self.write_reference(), "--binary", self.other_program())
        self.assertEqual(status, 0)
        self.assertIn("flowtime ratio: mean 1.200,", text)
        self.assertIn("The other program against the reference:", text)
        self.assertIn("flowtime ratio: mean 1.000,", text)
        self.assertRegex(text, r"\| a\.json +\| +7 \| 1 of 1 \|")

    def test_an_invalid_answer_makes_the_exit_status_1(self):
        status, text = self.run_bench(self.write_request("bad.json"))
        self.assertEqual(status, 1)
        self.assertIn("invalid: 1.", text)

    def test_a_failed_measurement_makes_the_exit_status_1(self):
        self.program.write_text("#!/bin/sh\nexit 1\n")
        status, text = self.run_bench("--seeds", "1", "--robots", "15")
        self.assertEqual(status, 1)
        self.assertIn("the measurement failed", text)

    def test_missing_files_make_the_exit_status_1(self):
        status, text = self.run_bench("none.json")
        self.assertEqual(status, 1)
        self.assertIn("none.json does not exist", text)


if __name__ == "__main__":
    unittest.main()
