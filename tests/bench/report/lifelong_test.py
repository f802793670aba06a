import contextlib
import io
import json
import sys
import unittest

import lifelong
from support import ProgramTest

# Stands for fleetplan_lifelong: reports half of the bound, and an invalid answer if there are 99 robots.
PROGRAM = """#!%s
import json, sys
print("name,robots,seconds,tasks,of_bound,tasks_per_hour,waiting,replans,changed,unplanned,late,median_s,p99_s,"
      "longest_s,budget_s,valid")
job = json.loads(sys.stdin.readline())
print(f'"{job["name"]}",{job["robots"]},{job["seconds"]},70,0.5,35.25,0.125,60,0.04,0,2,0.01,0.02,0.3,'
      f'{job["budget_ms"] / 1000},{int(job["robots"] != 99)}')
""" % sys.executable


class Lifelong(ProgramTest):
    PROGRAM = PROGRAM

    def run_lifelong(self, *words):
        return self.run_main(lifelong.main, "--output", str(self.folder), *words)

    def test_every_strategy_has_a_row_for_every_number_of_robots(self):
        status, text = self.run_lifelong("--robots", "20,150", "--seconds", "300")
        self.assertEqual(status, 0)
        rows = [line for line in text.splitlines() if line.startswith("|")]
        self.assertEqual(len(rows), 2 + 2 * len(lifelong.STRATEGIES))
        self.assertRegex(text, r"\| committed +\| +150 \| +0\.500 \| +35\.\d \| +12\.5 % \| +60 \| +4\.0 % \| +10 \|")

    def test_earlier_runs_are_reported_without_measuring(self):
        first = self.run_lifelong("--robots", "20")
        self.program.unlink()
        self.assertEqual(self.run_lifelong("--read", str(self.folder / "lifelong.csv")), first)

    def test_an_invalid_answer_is_the_exit_status(self):
        self.assertEqual(self.run_lifelong("--robots", "99", "--strategies", "committed")[0], 1)

    def test_many_robots_have_the_large_warehouse_and_more_time(self):
        arguments = lifelong.parse(["--options", '{"seed": 5}'])
        few, many = (lifelong.make_job("committed", robots, arguments) for robots in (40, 150))
        self.assertEqual((few["shelves"], few["budget_ms"], few["commit"]), ([3, 8], 100, 0.1))
        self.assertEqual((many["shelves"], many["budget_ms"], many["commit"]), ([10, 20], 300, 0.3))
        self.assertEqual(many["options"], {"replan": "where_needed", "seed": 5})
        self.assertEqual(json.loads(json.dumps(many)), many)

    def test_strategies_are_chosen_by_the_begin_of_their_name(self):
        self.assertEqual(lifelong.strategies("stop; committed"), 
                         ["stop the world", "committed", "committed, horizon", "committed, improved"])
        self.assertEqual(len(lifelong.strategies("snap")), 3)
        with contextlib.redirect_stderr(io.StringIO()), self.assertRaises(SystemExit):
            lifelong.parse(["--strategies", "luck"])


if __name__ == "__main__":
    unittest.main()
