import math
import unittest

import lab


def drive(t_start, t_end, x_from, x_to):
    return {"type": "translate", "t_start": t_start, "t_end": t_end, "from": {"x": x_from, "y": 1.0, "theta": 0.0},
            "to": {"x": x_to, "y": 1.0, "theta": 0.0}}


class StubService:
    """Plans straight drives; with a delay, every robot is late by half of it."""

    def __init__(self, solved=True):
        self.solved = solved
        self.requests = []

    def post(self, path, body):
        self.requests.append((path, body))
        if path == "/v1/plan":
            plans = [{"robot": robot["id"], "actions": [drive(0.0, 30.0, 0.0, 3.0)]} for robot in body["robots"]]
            return {"status": "solved" if self.solved else "partial", "plans": plans, "dependencies": [],
                    "lower_bound": {"flowtime": 30.0}}
        late = body["disturbance"]["start_delay"]["max"] / 2
        moved = [{**drive(late, 30.0 + late, 0.0, 3.0)}]
        wait = [{**drive(0.0, late, 0.0, 0.0), "type": "wait"}]
        return {"collision_share": 0.25, "deadlock_share": 0.0, "flowtime": {"mean": 45.0}, "trace": {"plans": [{"actions": wait + moved}]}}


class LabTest(unittest.TestCase):
    def test_the_polygon_is_the_papers(self):
        rows = lab.polygon()["rows"]
        self.assertEqual((len(rows), {len(row) for row in rows}), (72, {108}))
        self.assertEqual(sum(row.count("#") for row in rows), 16 * 10 + 10 * 18 + 14 * 8)
        self.assertEqual(lab.distance_from_walls(26.5 * 0.05, 40.5 * 0.05), 0.0)
        self.assertAlmostEqual(lab.distance_from_walls(0.3, 0.5), 0.3)

    def test_instances_have_room_and_long_ways(self):
        for seed in range(1, 6):
            robots = lab.instance(seed)
            self.assertEqual(len(robots), 6)
            for kind in ("start", "goal"):
                places = [(robot[kind]["x"], robot[kind]["y"]) for robot in robots]
                for index, place in enumerate(places):
                    self.assertGreater(lab.distance_from_walls(*place), 0.35)
                    for other in places[:index]:
                        self.assertGreater(math.dist(place, other), 0.7)
            for robot in robots:
                way = math.dist((robot["start"]["x"], robot["start"]["y"]), (robot["goal"]["x"], robot["goal"]["y"]))
                self.assertGreaterEqual(way, lab.SHORTEST_WAY)
        self.assertEqual(lab.instance(3), lab.instance(3))

    def test_errors_are_of_positions_at_the_same_time(self):
        errors = lab.squared_errors([drive(0.0, 10.0, 0.0, 1.0)], [drive(0.0, 20.0, 0.0, 1.0)])
        self.assertAlmostEqual(max(errors), 0.25)
        self.assertAlmostEqual(errors[50], 0.25 * 0.25)

    def test_the_delay_is_fitted_to_the_papers_error(self):
        delay, rmse = lab.fitted_delay(StubService(), 1.0)
        self.assertAlmostEqual(rmse, lab.PAPER_RMSE, delta=0.005)
        self.assertAlmostEqual(delay / 2 * lab.SPEED, lab.PAPER_RMSE, delta=0.03)

    def test_a_cell_has_the_safe_share_and_the_cost(self):
        arguments = lab.make_parser().parse_args(["--instances", "3", "--runs", "7"])
        service = StubService()
        cell = lab.measure_cell(service, arguments, 1.0, 0.25, 5.0)
        self.assertEqual(cell, {"solved": 3, "safe": 0.75, "cost": 1.5})
        simulated = [body for path, body in service.requests if path == "/v1/simulate"]
        self.assertEqual({body["policy"] for body in simulated}, {"absorb_waits"})
        self.assertEqual({body["runs"] for body in simulated}, {7})
        self.assertEqual({body["robot_defaults"]["radius"] for body in simulated}, {0.25})
        self.assertEqual({body["robot_defaults"]["body_radius"] for body in simulated}, {0.148})
        self.assertEqual(lab.measure_cell(StubService(solved=False), arguments, 1.0, 0.25, 5.0),
                         {"solved": 0, "safe": None, "cost": None})

    def test_plans_with_a_margin_are_executed_with_their_dependencies(self):
        arguments = lab.make_parser().parse_args(["--instances", "1"])
        service = StubService()
        self.assertEqual(lab.measure_cell(service, arguments, 1.0, 0.15, 0.0, 0.05)["solved"], 1)
        planned, simulated = ([body for path, body in service.requests if path == name][-1]
                              for name in ("/v1/plan", "/v1/simulate"))
        self.assertEqual((planned["options"]["inflation"], planned["options"]["execution_margin"]), (0.05, 0.05))
        self.assertTrue(planned["options"]["dependencies"])
        self.assertEqual((simulated["policy"], simulated["dependencies"]), ("dependencies", []))

    def test_the_report_has_a_row_for_each_cell(self):
        cells = {(0.15, 0.0): {"solved": 10, "safe": 0.02, "cost": 1.15},
                 (0.35, 5.0): {"solved": 0, "safe": None, "cost": None}}
        text = lab.report(cells, {0.05: {"solved": 9, "safe": 1.0, "cost": 1.2}}, 1.47, 0.3069)
        self.assertIn("up to 1.47 s late", text)
        self.assertRegex(text, r"\| 15 +\| +0 \| +10 \| +2 % \|")
        self.assertRegex(text, r"\| 15 \+ 5, dependencies +\| +0 \| +9 \| +100 % \| +- \| +1\.20 \|")
        self.assertIn("about 2", text)


if __name__ == "__main__":
    unittest.main()
