import json
import re
import sys
import unittest
import zipfile

import aaccbs
from support import ProgramTest, write_workbook

# Stands for fleetplan_bench. It solves everything with 20 of flowtime for each robot, or 19 with `anytime`. It takes as
# many seconds as there are robots, divided by 4.
PROGRAM = """#!%s
import json, sys
print("file,robots,solved,attempts,seconds,flowtime,makespan,cpu_seconds,peak_memory,planned,lower_bound,expansions,"
      "improvements,deterministic,valid", flush=True)
for line in sys.stdin:
    job = json.loads(line)
    for robots in job["robots"]:
        each = 19 if job["options"]["mode"] == "anytime" else 20
        valid = int(job["options"]["time_budget_ms"] != 7000)
        print(f"{job['name']},{robots},1,1,{robots / 4},{each * robots},30,{robots / 4},1048576,{robots},100,9,0,1,"
              f"{valid}", flush=True)
""" % sys.executable

MAP = """<?xml version="1.0" ?>
<root><map><width>3</width><height>2</height><grid><row>0 1 0</row>
<row>0 0 0</row></grid></map></root>"""
AGENT = '<agent id="{}" start_i="0" start_j="2" goal_i="1" goal_j="0"/>'
NAMES = ["ScenID", "Number of agents", "Runtime", "Solution Cost", "Expansions"]


class AaCcbs(ProgramTest):
    PROGRAM = PROGRAM

    def setUp(self):
        super().setUp()
        # Of scenario 1, the optimal variants solve 2 and 3 robots, the other one up to 4.
        nothing = [None] * 4
        self.write_results([["A(1.0)", *nothing, "A+DS(1.0)", *nothing, "A(1.1)"], NAMES * 3,
                            [1, 2, 0.5, 40, 9, 1, 2, 0.5, 38, 9, 1, 2, 0.1, 50, 9],
                            [1, 3, 0.5, 57, 9, None, *nothing, 1, 4, 0.1, 80, 9]])
        self.write_archive("hall.zip", 5)

    def write_results(self, rows):
        (self.folder / "ExpResults").mkdir(exist_ok=True)
        write_workbook(self.folder / aaccbs.WORKBOOK, {"hall": rows})

    def write_archive(self, name, agents):
        (self.folder / "Instances").mkdir(exist_ok=True)
        with zipfile.ZipFile(self.folder / "Instances" / name, "w") as archive:
            archive.writestr("hall/map.xml", MAP)
            archive.writestr("hall/hall-random-1.scen", "version 1\n")
            archive.writestr("hall/hall-random-1.xml", f"<root>{''.join(map(AGENT.format, range(agents)))}</root>")

    def run_aaccbs(self, *words):
        return self.run_main(aaccbs.main, str(self.folder), "--output", str(self.folder / "out"), *words)

    def test_the_least_cost_of_each_kind_of_variant_counts(self):
        found = aaccbs.published(self.folder)["hall"]
        self.assertEqual(aaccbs.best(found, True), {(1, 2): 38.0, (1, 3): 57.0})
        self.assertEqual(aaccbs.best(found, False), {(1, 2): 50.0, (1, 4): 80.0})

    def test_requests_have_robots_in_the_middle_of_cells(self):
        requests = aaccbs.read_requests(self.folder / "Instances/hall.zip")
        self.assertEqual(list(requests), [1])
        self.assertEqual(requests[1]["map"], {"rows": [".#.", "..."], "resolution": 1.0})
        self.assertEqual(requests[1]["robots"][0],
                         {"id": "r0", "start": {"x": 2.5, "y": 1.5}, "goal": {"x": 0.5, "y": 0.5}})
        self.assertEqual(len(requests[1]["robots"]), 5)

    def test_disks_may_touch(self):
        self.assertLess(aaccbs.ROBOT["radius"], 2 ** 0.5 / 4)
        self.assertAlmostEqual(aaccbs.ROBOT["radius"], 2 ** 0.5 / 4, places=7)

    def test_solved_instances_and_costs_are_beside_the_published_ones(self):
        status, text = self.run_aaccbs()
        self.assertEqual(status, 0)
        self.assertRegex(text, r"\| hall \| +3 \| +2 \| +2 \| 3 of 3 \| +0 of 1 \| +1\.25 \|")
        self.assertIn("3 of 3 that a variant of AA-CCBS solved within 300 s, and 0 of 1 with one robot more", text)
        # 40 / 38 and 60 / 57; 40 / 50 and 80 / 80. With `anytime` only the largest: 57 / 57 and 76 / 80.
        self.assertRegex(text, r"\| hall +\| +2 \| 1\.0526 \| 1\.0526 \| +2 \| 0\.9000 \| 1\.0000 \|")
        self.assertRegex(text, r"\| hall +\| +1 \| 1\.0000 \| 1\.0000 \| +1 \| 0\.9500 \| 0\.9500 \|")
        self.assertRegex(text, r"\| all +\| +1 \| 1\.0000 \| 1\.0000 \|")

    def test_every_number_of_robots_can_be_improved(self):
        _, text = self.run_aaccbs("--every")
        self.assertEqual(len((self.folder / "out/aaccbs-anytime.csv").read_text().splitlines()), 1 + 3)
        self.assertRegex(text, r"\| hall +\| +2 \| 1\.0000 \| 1\.0000 \| +2 \| 0\.8550 \| 0\.9500 \|")

    def test_only_chosen_maps_are_planned(self):
        self.assertEqual(self.run_aaccbs("--maps", "hall")[0], 0)
        status, text = self.run_aaccbs("--maps", "hall,maze")
        self.assertEqual(status, 1)
        self.assertIn("there are no results on maze", text)

    def test_all_robots_of_a_scenario_have_no_next_one(self):
        self.write_archive("hall.zip", 4)
        self.assertRegex(self.run_aaccbs()[1], r"\| 3 of 3 \| +0 of 0 \|")

    def test_archives_of_the_other_branch_are_found(self):
        (self.folder / "Instances/hall.zip").rename(self.folder / "Instances/hall-random.zip")
        self.assertEqual(self.run_aaccbs()[0], 0)
        (self.folder / "Instances/hall-random.zip").unlink()
        status, text = self.run_aaccbs()
        self.assertEqual(status, 1)
        self.assertIn("has no archive of hall", text)

    def test_earlier_runs_are_reported_without_measuring(self):
        first = self.run_aaccbs()
        self.program.unlink()
        self.assertEqual(self.run_aaccbs("--read"), first)

    def test_an_invalid_answer_makes_the_exit_status_1(self):
        status, text = self.run_aaccbs("--budget", "7")
        self.assertEqual(status, 1)
        self.assertTrue(re.search("invalid: [1-9]", text))

    def test_jobs_are_those_of_fleetplan_bench(self):
        self.run_aaccbs()
        body = json.loads((self.folder / "out/aaccbs/hall-1.json").read_text())
        self.assertEqual(set(body), {"map", "robot_defaults", "robots"})


if __name__ == "__main__":
    unittest.main()
