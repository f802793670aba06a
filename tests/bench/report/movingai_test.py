import pathlib
import unittest

import movingai
from support import ProgramTest

# Makes requests of as many robots as are wanted, and plans all but every third of them.
PROGRAM = """#!/usr/bin/env python3
import json, pathlib, sys
words = sys.argv[1:]
if words[0] == "map2request":
    if "bad" in words[1]:
        print("bad.map: no map", file=sys.stderr)
        sys.exit(64)
    file = words[words.index("-o") + 1]
    pathlib.Path(file).write_text(json.dumps({"robots": [0] * int(words[words.index("--count") + 1])}))
else:
    request = json.loads(pathlib.Path(words[1]).read_text())
    count = len(request["robots"])
    left = count // 3
    plans = [{"cost": 3.0, "lower_bound": 2.0}] * (count - left)
    print(json.dumps({"plans": plans, "unplanned": [{}] * left,
                      "timings_ms": {"total": request["options"]["time_budget_ms"] / 4}}))
    sys.exit(2 if left else 0)
"""


class MovingAi(ProgramTest):
    PROGRAM = PROGRAM

    def write(self, *names):
        for name in names:
            pathlib.Path(self.folder, name).write_text("")

    def test_plans_the_first_scenario_of_every_map(self):
        self.write("room.map", "room-even-2.scen", "room-even-1.scen", "hall.map", "hall-random-1.scen")
        self.assertEqual(movingai.scenario_of(self.folder / "room.map").name, "room-even-1.scen")
        status, text = self.run_main(movingai.main, str(self.folder), "--robots", "2,6", "--budget", "8")
        self.assertEqual(status, 0)
        rows = [[cell.strip() for cell in line.split("|")[1:-1]] for line in text.splitlines() if line[:1] == "|"]
        self.assertEqual(rows[2:], [["hall", "2", "2", "2.00", "1.500"], ["hall", "6", "4", "2.00", "1.500"],
                                    ["room", "2", "2", "2.00", "1.500"], ["room", "6", "4", "2.00", "1.500"]])
        self.assertIn("up to 2 robots: 2 of 2 fleets planned whole; of these, seconds: median 2.00, most 2.00", text)
        self.assertIn("up to 6 robots: 0 of 2 fleets planned whole\n", text)

    def test_tells_what_is_missing_or_wrong(self):
        status, text = self.run_main(movingai.main, str(self.folder))
        self.assertEqual((status, "has no .map file" in text), (1, True))
        self.write("bad.map")
        status, text = self.run_main(movingai.main, str(self.folder))
        self.assertEqual((status, "there is no scenario bad-*.scen" in text), (1, True))
        self.write("bad-even-1.scen")
        status, text = self.run_main(movingai.main, str(self.folder))
        self.assertEqual((status, "bad.map: no map" in text), (1, True))


if __name__ == "__main__":
    unittest.main()
