"""The client against a server of this build, and against a server with answers that no real server gives."""

import json
import time
import unittest
import urllib.request

from support import PROJECT, Answers, service

from fleetplan import Client, ConnectionFailed, ProblemError, RequestRefused, ServiceUnavailable

JSON = {"Content-Type": "application/json"}
EVENTS = {"Content-Type": "text/event-stream", "Content-Length": None, "Connection": "close"}


def answer(value, status=200, **fields):
    return status, {**JSON, **fields}, json.dumps(value).encode()


def busy(seconds):
    return answer({"status": 503, "code": "overloaded", "detail": "The queue is full."}, 503,
                  **{"Retry-After": str(seconds)})


class WithTheService(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.url = cls.enterClassContext(service())
        cls.client = cls.enterClassContext(Client(cls.url))
        cls.request = json.loads((PROJECT / "tests/scenarios/corridor-swap.json").read_text())
        cls.request["options"] = {"dependencies": True, "interval_margin": 0.5, "inflation": 0.01}
        cls.answer = cls.client.plan(cls.request)

    def test_a_plan_is_solved_and_valid(self):
        self.assertEqual(self.answer["status"], "solved")
        self.assertTrue(self.client.validate(self.request, self.answer)["valid"])

    def test_a_plan_of_another_planner_is_checked(self):
        plans = [{"robot": robot["id"], "actions": []} for robot in self.request["robots"]]
        verdict = self.client.validate(self.request, {"plans": plans}, tolerance=1e-3)
        self.assertEqual({violation["kind"] for violation in verdict["violations"]}, {"wrong_goal"})

    def test_events_arrive_one_after_the_other(self):
        request = {**self.client.example("warehouse"), "options": {"mode": "anytime", "time_budget_ms": 1200}}
        events = list(self.client.plan_events(request))
        self.assertEqual(events[-1]["event"], "plan")
        self.assertEqual(events[-1]["data"]["status"], "solved")
        self.assertLessEqual({event["event"] for event in events[:-1]}, {"progress", "incumbent"})
        self.assertGreater(len(events), 3)

    def test_closing_the_events_cancels_the_plan(self):
        request = {**self.client.example("warehouse"), "options": {"mode": "anytime", "time_budget_ms": 60000}}
        events = self.client.plan_events(request)
        self.assertEqual(next(events)["event"], "progress")
        events.close()
        cancelled = 'fleetplan_requests_total{route="/v1/plan",status="499"} 1\n'
        give_up = time.monotonic() + 30.0  # before the budget ends
        while cancelled not in (metrics := self.metrics()):
            self.assertLess(time.monotonic(), give_up, metrics)
            time.sleep(0.02)

    def metrics(self):
        with urllib.request.urlopen(self.url + "/metrics") as response:
            return response.read().decode()

    def test_the_dependencies_are_those_of_the_plan(self):
        made = self.client.dependencies(self.request, self.answer)
        self.assertEqual(made["dependencies"], self.answer["dependencies"])

    def test_a_simulation_reports_its_progress_and_the_same_figures(self):
        disturbance = {"speed": {"min": 0.8, "max": 1.0}}
        figures = self.client.simulate(self.request, self.answer, "dependencies", disturbance=disturbance, runs=50)
        self.assertEqual((figures["runs"], figures["collision_share"]), (50, 0.0))
        *_, last = self.client.simulate_events(self.request, self.answer, "dependencies", disturbance=disturbance, runs=50)
        self.assertEqual(last["data"]["flowtime"], figures["flowtime"])

    def test_margins_are_found_with_the_plan_that_has_them(self):
        disturbance = {"speed": {"min": 0.8, "max": 1.0}}
        found = self.client.margins(self.request, "dependencies", disturbance, aim={"collisions": 0.1},
                                    try_={"interval_margin": [0.0, 0.5]})
        self.assertTrue(found["met"])
        self.assertEqual(found["plan"]["status"], "solved")
        *progress, last = self.client.margins_events(self.request, "dependencies", disturbance, aim={"collisions": 0.1},
                                                     try_={"interval_margin": [0.0, 0.5]})
        self.assertEqual({one["event"] for one in progress}, {"progress"})
        self.assertEqual(last["data"]["tried"], found["tried"])

    def test_the_next_moment_is_planned(self):
        following = self.client.advance(self.request, self.answer, 2.0, commit=1.0,
                                        holds=[{"robot": "east-bound", "until": 3.0}])
        self.assertEqual(following["robots"][0]["committed"][0]["t_end"], 3.0)
        self.assertEqual(self.client.plan(following)["status"], "solved")

    def test_late_robots_get_new_times(self):
        times = self.client.retime(self.request, self.answer, 1.0, [
            {"robot": "east-bound", "action": 0, "progress": 0.0, "held_s": 5.0}])
        self.assertIn("east-bound", {late["robot"] for late in times["late"]})

    def test_a_matrix_has_the_times_of_a_robot(self):
        robot = {"radius": 0.2, "linear_speed": 1.0, "angular_speed": 3.0}
        poses = [{key: value for key, value in one["start"].items()} for one in self.request["robots"]]
        times = self.client.matrix(self.request, robot, poses, poses)
        self.assertEqual((times["seconds"][0][0], times["metres"][1][1]), (0.0, 0.0))
        self.assertGreater(times["seconds"][0][1], 1.0)

    def test_robots_get_tasks(self):
        goals = [one.get("goals") or [one["goal"]] for one in self.request["robots"]]
        without = {**self.request, "robots": [{key: value for key, value in one.items() if key not in ("goal", "goals")}
                                              for one in self.request["robots"]]}
        assigned = self.client.assign(without, [{"id": "first", "goals": goals[0]}, {"id": "second", "goals": goals[1]}])
        self.assertEqual([one["task"] for one in assigned["assigned"]], ["first", "second"])
        self.assertEqual(len({one["robot"] for one in assigned["assigned"]}), 2)
        self.assertNotEqual(self.client.plan(assigned)["status"], "none")

    def test_plans_become_orders(self):
        exported = self.client.export_vda5050(self.request, self.answer, version="2.1.0", manufacturer="acme")
        self.assertEqual([entry["robot"] for entry in exported["orders"]], ["east-bound", "west-bound"])

    def test_the_server_tells_what_it_accepts(self):
        self.assertGreaterEqual(self.client.limits()["workers"], 1)
        self.assertEqual(self.client.health()["status"], "ok")
        self.assertIn("corridor-swap", self.client.examples())

    def test_a_refused_request_tells_where_it_is_wrong_and_what_to_do(self):
        request = {**self.request, "robots": [{"id": "a", "start": {"x": "far", "y": 1.0}}]}
        with self.assertRaises(RequestRefused) as raised:
            self.client.plan(request)
        self.assertEqual((raised.exception.status, raised.exception.code), (422, "invalid_request"))
        self.assertEqual(raised.exception.faults[0].pointer, "/robots/0/start/x")
        self.assertIn("/robots/0/start/x", str(raised.exception))
        self.assertNotEqual(raised.exception.request_id, "")
        duplicate = {**self.request, "robots": [self.request["robots"][0]] * 2}
        with self.assertRaises(RequestRefused) as raised:
            self.client.plan(duplicate)
        (fault,) = [fault for fault in raised.exception.faults if fault.code == "duplicate"]
        self.assertEqual(fault.detail, f"{fault.message}; {fault.remedy}.")

    def test_an_example_that_does_not_exist_is_not_found(self):
        with self.assertRaises(RequestRefused) as raised:
            self.client.example("../none")
        self.assertEqual(raised.exception.status, 404)


class WithAnyServer(unittest.TestCase):
    def test_a_busy_server_is_asked_again_when_it_says_so(self):
        with Answers(busy(0.2), busy(0), answer({"workers": 2})) as server, Client(server.url) as client:
            began = time.monotonic()
            self.assertEqual(client.limits(), {"workers": 2})
            self.assertGreaterEqual(time.monotonic() - began, 0.2)
            self.assertEqual(len(server.requests), 3)

    def test_a_server_that_stays_busy_is_not_asked_for_ever(self):
        with Answers(busy(0), busy(60)) as server, Client(server.url, patience=5.0) as client:
            began = time.monotonic()
            with self.assertRaises(ServiceUnavailable) as raised:
                client.limits()
            self.assertLess(time.monotonic() - began, 5.0)
            self.assertEqual(raised.exception.code, "overloaded")
            self.assertEqual(len(server.requests), 2)

    def test_connections_are_kept(self):
        with Answers(*[answer({})] * 3) as server, Client(server.url) as client:
            for _ in range(3):
                client.limits()
            self.assertEqual(len({port for *_, port in server.requests}), 1)

    def test_a_connection_that_the_server_has_closed_is_replaced(self):
        with Answers(answer({}), None, answer({"workers": 3})) as server, Client(server.url) as client:
            client.limits()
            self.assertEqual(client.limits(), {"workers": 3})
            self.assertEqual(len({port for *_, port in server.requests}), 2)

    def test_a_connection_that_fails_at_once_is_reported(self):
        with Answers(None) as server, Client(server.url) as client, self.assertRaises(ConnectionFailed):
            client.limits()
        with self.assertRaises(ConnectionFailed):
            Client(server.url).limits()  # nobody listens any more

    def test_a_silent_server_is_given_up(self):
        with Answers(answer({})) as server, Client(server.url, timeout=0.2) as client:
            answers, server.answers = server.answers, _Slow()
            with self.assertRaisesRegex(ConnectionFailed, "silent for 0.2 s"):
                client.limits()
            self.assertEqual(len(answers), 1)

    def test_the_time_budget_may_pass_in_silence(self):
        with Answers(answer({"status": "solved"})) as server, Client(server.url, timeout=0.2) as client:
            server.answers = _Slow(0.5)
            self.assertEqual(client.plan({"options": {"time_budget_ms": 2000}}), {"status": "solved"})

    def test_events_may_have_several_lines_and_comments(self):
        text = (b": hello\r\nevent: progress\r\ndata: {\"attempt\":\r\ndata: 1}\r\nid: 7\r\n\r\n\r\n"
                b"event: plan\ndata: {\"status\": \"solved\"}\n\n")
        with Answers((200, EVENTS, text)) as server, Client(server.url) as client:
            self.assertEqual(list(client.plan_events({})), [
                {"event": "progress", "data": {"attempt": 1}}, {"event": "plan", "data": {"status": "solved"}}])
            self.assertEqual(server.requests[0][2]["Accept"], "text/event-stream")

    def test_events_that_end_early_are_reported(self):
        with Answers((200, EVENTS, b"event: progress\ndata: {}\n\n")) as server, Client(server.url) as client:
            events = client.plan_events({})
            next(events)
            with self.assertRaisesRegex(ConnectionFailed, "end without plan"):
                next(events)

    def test_a_problem_among_the_events_is_raised(self):
        text = b'event: problem\ndata: {"status": 500, "code": "internal_error", "detail": "A bug."}\n\n'
        with Answers((200, EVENTS, text)) as server, Client(server.url) as client:
            with self.assertRaises(ProblemError) as raised:
                next(client.plan_events({}))
            self.assertEqual((raised.exception.status, raised.exception.code), (500, "internal_error"))

    def test_errors_that_are_not_of_the_service_are_reported_with_their_status(self):
        with Answers((502, {"Content-Type": "text/html"}, b"<h1>Bad Gateway</h1>")) as server, Client(server.url) as client:
            with self.assertRaises(ProblemError) as raised:
                client.limits()
            self.assertEqual((raised.exception.status, raised.exception.code), (502, ""))

    def test_an_answer_that_is_not_json_is_reported(self):
        with Answers((200, {}, b"<html>")) as server, Client(server.url) as client:
            with self.assertRaisesRegex(ConnectionFailed, "not JSON"):
                client.limits()

    def test_the_token_and_the_path_of_the_url_are_sent(self):
        with Answers(answer({})) as server, Client(server.url + "/planner/", token="secret") as client:
            client.limits()
        (_, path, fields, _, _), = server.requests
        self.assertEqual((path, fields["Authorization"]), ("/planner/v1/limits", "Bearer secret"))

    def test_a_url_without_a_host_is_refused(self):
        for url in ("localhost:8080", "ftp://localhost", "http://"):
            with self.assertRaises(ValueError):
                Client(url)

    def test_numbers_that_json_does_not_have_are_not_sent(self):
        with Answers() as server, Client(server.url) as client, self.assertRaises(ValueError):
            client.plan({"robots": [{"radius": float("nan")}]})


class _Slow:
    """Answers that take longer than the client waits."""

    def __init__(self, seconds=1.0):
        self.seconds = seconds

    def pop(self, _):
        time.sleep(self.seconds)
        return answer({"status": "solved"})


if __name__ == "__main__":
    unittest.main()
