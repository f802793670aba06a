import pathlib
import tempfile
import unittest

import formations
import warehouses

MAP = "type octile\nheight 3\nwidth 5\nmap\n..@.G\n..@@.\n@@...\n"


class Warehouses(unittest.TestCase):
    def test_three_of_ten_robots_make_way_and_all_places_are_free_and_apart(self):
        for seed in range(1, 30):
            request = warehouses.make_warehouse(seed)
            rows, robots = request["map"]["rows"], request["robots"]
            idle = [robot for robot in robots if "goal" not in robot]
            self.assertEqual({robot.get("idle") for robot in idle}, {"yield"})
            self.assertEqual(len(idle), round(0.3 * len(robots)))
            self.assertGreaterEqual(len(robots), 8)
            places = [robot["start"] for robot in robots] + [robot["goal"] for robot in robots if "goal" in robot]
            self.assertEqual(len({(place["x"], place["y"]) for place in places}), len(places))
            for place in places:
                row = rows[len(rows) - 1 - int(place["y"] / warehouses.CELL)]
                self.assertEqual(row[int(place["x"] / warehouses.CELL)], ".")

    def test_the_same_seed_makes_the_same_warehouse(self):
        self.assertEqual(warehouses.make_warehouse(7), warehouses.make_warehouse(7))
        self.assertNotEqual(warehouses.make_warehouse(7), warehouses.make_warehouse(8))


class Formations(unittest.TestCase):
    def setUp(self):
        with tempfile.TemporaryDirectory() as folder:
            self.path = pathlib.Path(folder, "small.map")
            self.path.write_text(MAP, encoding="ascii")
            self.grid = formations.map_of(self.path)

    def test_a_map_has_the_cells_of_its_largest_part(self):
        self.assertEqual(self.grid.rows, ["..#..", "..##.", "##..."])
        self.assertEqual(self.grid.free, [(2, 2), (3, 0), (3, 2), (4, 0), (4, 1), (4, 2)])

    def test_the_request_and_the_instance_of_tswap_have_the_same_cells(self):
        problem = formations.formation(self.grid, 3, 1)
        self.assertEqual(len(set(problem.starts)), 3)
        self.assertEqual(len(set(problem.goals)), 3)
        robots = problem.request["robots"]
        self.assertEqual([(robot["start"]["x"], robot["start"]["y"]) for robot in robots],
                         [(column + 0.5, 2.5 - row) for column, row in problem.starts])
        self.assertEqual([(pose["x"], pose["y"]) for pose in robots[2]["goal"]["any_of"]],
                         [(column + 0.5, 2.5 - row) for column, row in problem.goals])
        lines = formations.tswap_instance(self.path, problem).splitlines()
        self.assertEqual(lines[0], "map_file=small.map")
        self.assertEqual(lines[-1], ",".join(map(str, (*problem.starts[2], *problem.goals[2]))))

    def test_a_result_has_a_flowtime_if_it_is_one(self):
        self.assertEqual(formations.read_result("solved=1\nsoc=42\nmakespan=9\n"), 42.0)
        with self.assertRaises(ValueError):
            formations.read_result("solved=0\nsoc=0\n")


if __name__ == "__main__":
    unittest.main()
