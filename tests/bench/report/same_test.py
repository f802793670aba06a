import unittest

from same import compare, first_difference, following, repeatable


def plan(cost, **members):
    return {"status": "solved", "deterministic": True, "plans": [{"robot": "a", "cost": cost}], "request_id": str(cost), **members}


class Compare(unittest.TestCase):
    request = {"path": "/v1/plan", "body": {"robots": []}}

    def compared(self, answer, other):
        return compare([self.request], [answer], [other])

    def test_names_and_times_of_requests_do_not_count(self):
        other = plan(1.0, request_id="x", timings_ms={"plan": 3.0})
        self.assertEqual(self.compared(plan(1.0), other), ([], []))

    def test_the_last_digit_counts(self):
        self.assertEqual(self.compared(plan(0.1 + 0.2), plan(0.3)), ([0], []))
        self.assertEqual(first_difference(plan(0.1 + 0.2), plan(0.3), "")[:15], "/plans/0/cost: ")

    def test_plans_that_a_clock_has_ended_are_not_compared(self):
        self.assertEqual(self.compared(plan(1.0, deterministic=False), plan(2.0)), ([], [0]))

    def test_refusals_are_compared(self):
        self.assertEqual(self.compared({"code": "a", "detail": "x"}, {"code": "a", "detail": "y"}), ([0], []))


class Requests(unittest.TestCase):
    def test_plans_are_improved_by_steps_and_others_are_as_they_were(self):
        body = {"robots": [], "options": {"mode": "anytime", "time_budget_ms": 100}}
        options = repeatable(1, {"path": "/v1/plan", "body": body})["body"]["options"]
        self.assertEqual((options["max_iterations"], options["dependencies"]), (20, True))
        self.assertEqual(body["options"]["time_budget_ms"], 100)
        advance = {"path": "/v1/advance", "body": {}}
        self.assertIs(repeatable(0, advance), advance)

    def test_nothing_follows_from_an_answer_without_dependencies(self):
        self.assertEqual(list(following({"robots": []}, plan(1.0))), [])


if __name__ == "__main__":
    unittest.main()
