"""Whatever one peer sends costs that peer's message only: only FleetplanError is raised, loops go on, others go on."""

import json
import logging
import random
import time
import unittest

import fleet_loop_test
import vda5050_test
from damage import VALUES, damaged, damaged_text, raw_server
from support import PROJECT, Answers, service

from fleetplan import Client, FleetLoop, FleetplanError, Report, RequestRefused
from fleetplan.course import goals_of
from fleetplan.errors import InvalidAnswer, InvalidValue, MessageRejected
from fleetplan.vda5050 import VdaLoop
from fleetplan.vehicle_states import state_on

SEED = 20261128
HEAD = b"HTTP/1.1 200 OK\r\nContent-Type: application/json\r\n"
STREAM = b"HTTP/1.1 200 OK\r\nContent-Type: text/event-stream\r\n\r\n"
BUDGET = {"options": {"time_budget_ms": 100}}


def setUpModule():
    logging.disable()


def tearDownModule():
    logging.disable(logging.NOTSET)


def again_and_again(data, pause):
    def answer(connection, ended):
        while not ended.wait(pause):
            connection.sendall(data)
    return answer


def after(head, then):
    def answer(connection, ended):
        connection.sendall(head)
        then(connection, ended)
    return answer


class Servers(unittest.TestCase):
    def test_an_exchange_has_a_deadline_and_a_size_whatever_comes(self):
        junk = b" " * (1 << 16)
        plan = lambda client: client.plan(BUDGET)  # noqa: E731
        events = lambda client: list(client.plan_events(BUDGET))  # noqa: E731
        progress = b'event: progress\ndata: {"planned":0,"robots":1}\n\n'
        cases = {
            "a body that drips": (after(HEAD + b"Content-Length: 1000000\r\n\r\n", again_and_again(b" ", 0.05)), plan),
            "a head that drips": (after(HEAD, again_and_again(b"X-A: b\r\n", 0.05)), plan),
            "a status that drips": (again_and_again(b"H", 0.05), plan),
            "interim answers without end": (again_and_again(b"HTTP/1.1 100 Continue\r\n\r\n", 0.05), plan),
            "chunks that drip": (after(HEAD + b"Transfer-Encoding: chunked\r\n\r\n", again_and_again(b"1\r\n \r\n", 0.05)), plan),
            "events that never end": (after(STREAM, again_and_again(progress, 0.05)), events),
            "a body without end": (after(HEAD + b"\r\n", again_and_again(junk, 0.0)), plan),
            "a chunk of a negative length": (after(HEAD + b"Transfer-Encoding: chunked\r\n\r\n-1\r\n", again_and_again(junk, 0.0)),
                                             plan),
            "a line without end": (after(STREAM + b"data: ", again_and_again(junk, 0.0)), events),
        }
        for name, (answer, ask) in cases.items():
            with self.subTest(name), raw_server(answer) as (url, asked), Client(url, timeout=0.5, max_answer=1 << 22) as client:
                with self.assertRaises(FleetplanError):
                    ask(client)
                self.assertEqual(len(asked), 1)

    def test_an_answer_that_is_no_success_is_an_error(self):
        for status in ("201 x", "204 x", "206 x", "301 x", "302 x", "304 x", "307 x", "400 x", "500 x", "599 x", "999 x"):
            def answer(connection, _, status=status):
                connection.sendall(f"HTTP/1.1 {status}\r\nLocation: /\r\nContent-Length: 2\r\n\r\n{{}}".encode())
            with self.subTest(status), raw_server(answer) as (url, asked), Client(url, timeout=5.0) as client:
                with self.assertRaises(FleetplanError):
                    client.plan(BUDGET)
                self.assertEqual(len(asked), 1)

    def test_a_busy_server_is_spared_whatever_it_says(self):
        for value, most in (("0", 5), ("-1", 5), ("-inf", 5), ("nan", 2), ("soon", 2), ("1e999", 1), ("9" * 400, 1),
                            ("Thu, 01 Jan 1970 00:00:00 GMT", 5), ("Fri, 31 Dec 9999 23:59:59 GMT", 1), ("", 2)):
            def answer(connection, _, value=value):
                connection.sendall(f"HTTP/1.1 503 x\r\nRetry-After: {value}\r\nContent-Length: 2\r\n\r\n{{}}".encode())
            with self.subTest(value), raw_server(answer) as (url, asked), Client(url, timeout=5.0, patience=1.0) as client:
                with self.assertRaises(FleetplanError):
                    client.plan(BUDGET)
                self.assertLessEqual(len(asked), most)

    def test_bytes_that_were_not_asked_for_are_no_answer(self):
        def answer(connection, _):
            connection.sendall(HEAD + b'Content-Length: 12\r\n\r\n{"workers":2}'[:-1] + b"}" + HEAD +
                               b'Content-Length: 14\r\n\r\n{"workers":66}')
        with raw_server(answer) as (url, asked), Client(url, timeout=5.0) as client:
            for _ in range(2):
                with self.assertRaises(FleetplanError):
                    client.plan(BUDGET)

    def test_whatever_a_server_answers_only_fleetplan_errors_are_raised(self):
        dice = random.Random(SEED)
        answer = {"status": "solved", "plans": [{"robot": "a", "cost": 1.0, "actions": []}], "unplanned": [], "examples": [
            {"name": "a"}, {"name": "b"}], "detail": "x", "errors": [{"pointer": "/robots/0", "code": "x", "detail": "y"}]}
        with Answers() as server, Client(server.url, timeout=10.0, patience=0.0) as client:
            for number in range(300):
                text = damaged_text(answer, dice)
                status = dice.choice([200, 200, 200, 422, 500, 503])
                if dice.random() < 0.3:
                    text = b"event: " + dice.choice([b"plan", b"problem", b"\xff"]) + b"\ndata: " + text + b"\n\n"
                server.answers[:] = [(status, {}, text)] * 2
                call = dice.choice([lambda: client.plan(BUDGET), client.examples, client.health,
                                    lambda: list(client.plan_events(BUDGET))])
                with self.subTest(number=number, text=text[:200]):
                    try:
                        self.assertIsInstance(call(), dict | list)
                    except FleetplanError as error:
                        self.assertIsInstance(str(error), str)

    def test_what_callers_cannot_send_is_a_fleetplan_error_and_a_value_error(self):
        deep = []
        for _ in range(100000):
            deep = [deep]
        with Client("http://localhost:1", timeout=1.0) as client:
            for value in (float("nan"), float("inf"), object(), deep, b"x"):
                with self.assertRaises(InvalidValue):
                    client.plan({"robots": value})
        for wrong in (lambda: Client("http://[::1"), lambda: Client("http://localhost:99999999"),
                      lambda: Client(token="a\nb"), lambda: Client(timeout=float("nan"))):
            with self.assertRaises(InvalidValue):
                wrong()
            self.assertTrue(issubclass(InvalidValue, ValueError) and issubclass(InvalidValue, FleetplanError))


class Changes:
    """A client whose answers are changed before they are returned."""

    def __init__(self, client):
        self.client = client

    def __getattr__(self, name):
        method = getattr(self.client, name)
        return lambda *arguments, **members: self.changed(name, method(*arguments, **members))


class Damages(Changes):
    """A share of the answers is damaged."""

    def __init__(self, client, dice, share):
        super().__init__(client)
        self.dice, self.share, self.count = dice, share, 0

    def changed(self, _, answer):
        if self.dice.random() >= self.share:
            return answer
        self.count += 1
        return damaged(answer, self.dice) if self.dice.random() < 0.9 else {}


class Loops(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.client = cls.enterClassContext(Client(cls.enterClassContext(service())))

    def test_a_fleet_goes_on_after_answers_that_are_none(self):
        for seed in range(2):
            with self.subTest(seed=seed):
                faults = []
                client = Damages(self.client, random.Random(f"{SEED} {seed}"), 0.4)
                day = fleet_loop_test.Day(client, 6, on_fault=faults.append)
                for _ in range(200):
                    try:
                        day.run(day.fleet.now + 0.1)
                    except RequestRefused:  # goals, after a damaged request
                        pass
                self.assertGreater(client.count, 5)
                self.assertGreater(len(faults), 3)
                self.assertTrue(all(isinstance(fault, FleetplanError) for fault in faults), faults)
                client.share = 0.0
                arrived, before = len(day.arrived), day.loop.answer
                day.run(day.fleet.now + 30.0)
                self.assertIsNone(day.loop.failure)
                self.assertIsNot(day.loop.answer, before)
                self.assertGreater(len(day.arrived), arrived)

    def test_a_report_that_is_none_costs_its_robot_this_report(self):
        dice, faults = random.Random(SEED), []
        day = fleet_loop_test.Day(self.client, 6, on_fault=faults.append)
        name = day.request["robots"][0]["id"]
        good = {"pose": {"x": 1.0, "y": 1.0, "theta": 0.0}, "action": 0, "progress": 0.5, "plan": 1, "speed": 0.5,
                "service_left": 1.0}
        for _ in range(200):
            robot = dice.choice([name, name, "nobody", None, 7])
            report = Report(robot, **{key: value for key, value in damaged(good, dice).items() if key in good})
            day.fleet.obey(day.loop.step([dice.choice([report, report, None, "x", {}])]))
            day.run(day.fleet.now + 0.1)
        self.assertGreater(sum(isinstance(fault, MessageRejected) for fault in faults), 50)
        self.assertGreaterEqual(len(day.arrived), 4)
        self.assertIsNone(day.loop.failure)

    def test_a_plan_that_the_service_refuses_to_advance_is_left(self):
        for damage in (lambda actions: actions[0].update(t_end=actions[0]["t_start"] + 1e-3),
                       lambda actions: actions[0]["to"].update(x=actions[0]["to"]["x"] + 0.5)):
            client = Spoils(self.client, 3, damage)
            day = fleet_loop_test.Day(client, 4).run(20.0)
            self.assertIsNone(day.loop.failure)
            self.assertGreaterEqual(client.count, 12)

    def test_goals_that_cannot_be_written_are_refused_at_once(self):
        day = fleet_loop_test.Day(self.client, 2).run(2.0)
        with self.assertRaises(InvalidValue):
            day.loop.give(day.request["robots"][0]["id"], [{"x": float("nan"), "y": 1.0}])
        with self.assertRaises(InvalidValue):
            day.loop.hold(day.request["robots"][0]["id"], float("inf"))
        day.run(4.0)
        self.assertIsNone(day.loop.failure)

    def test_goals_of_one_robot_that_are_refused_cost_no_other_robot_its_goals(self):
        day = fleet_loop_test.Day(self.client, 4).run(2.0)
        bad, good = (robot["id"] for robot in day.request["robots"][:2])
        trip = [{**day.request["robots"][1]["start"], "service": 1.0}]
        day.loop.give(bad, [{"x": -5.0, "y": 0.0}])
        day.loop.give(good, trip)
        with self.assertRaises(RequestRefused) as raised:
            day.run(6.0)
        self.assertEqual(raised.exception.robots, {bad})
        day.run(8.0)
        (planned,) = (robot for robot in day.loop.request["robots"] if robot["id"] == good)
        self.assertEqual([goal["x"] for goal in goals_of(planned)], [goal["x"] for goal in trip])

    def test_an_error_of_the_function_that_changes_requests_costs_a_round(self):
        calls = []

        def change(_):
            calls.append(1)
            if len(calls) in (1, 3):
                raise KeyError("x")
        day = fleet_loop_test.Day(self.client, 2, change=change).run(6.0)
        self.assertEqual(len(day.failures) > 0, True)
        self.assertIsNone(day.loop.failure)


class Spoils(Changes):
    """One plan is wrong in a way that only the service sees."""

    def __init__(self, client, number, damage):
        super().__init__(client)
        self.number, self.damage, self.count = number, damage, 0

    def changed(self, name, answer):
        self.count += name == "plan"
        if name == "plan" and self.count == self.number:
            for plan in answer["plans"]:
                if len(plan["actions"]) == 1:
                    self.damage(plan["actions"])
        return answer


class Loses(Changes):
    """All answers of one kind are damaged while it is on."""

    def __init__(self, client, name, damage):
        super().__init__(client)
        self.name, self.damage, self.is_on = name, damage, False

    def changed(self, name, answer):
        if self.is_on and name == self.name:
            self.damage(answer)
        return answer


class Vehicles(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.client = cls.enterClassContext(Client(cls.enterClassContext(service())))

    def test_who_sends_a_message_is_what_its_topic_says(self):
        topic = "uagv/v2/acme/0815/state"
        self.assertEqual(state_on(topic, b'{"serialNumber":"0815"}').sender, {"manufacturer": "acme", "serialNumber": "0815"})
        self.assertEqual(state_on("a/b/" + topic, b"{}").sender["serialNumber"], "0815")
        for text in (b'{"serialNumber":"0816"}', b'{"manufacturer":"bolt","serialNumber":"0815"}', b'{"serialNumber":815}',
                     b'{"serialNumber":["0815"]}', b"[]", b"[" * 100000, b"\xff", b"", b'{"x":NaN}', b" " * (1 << 21)):
            with self.subTest(text[:40]), self.assertRaises(InvalidValue):
                state_on(topic, text)
        with self.assertRaises(InvalidValue):
            state_on("state", b"{}")

    def test_a_sender_without_a_name_in_the_message_speaks_for_itself_only(self):
        request = json.loads((PROJECT / "tests/scenarios/corridor-swap.json").read_text())
        faults = []
        loop = VdaLoop(self.client, request, manufacturer="acme", on_fault=faults.append, background=False, wait=0.0,
                       serial_numbers={"east-bound": "1", "west-bound": "2"})
        loop.take(state_on("uagv/v2/bolt/1/state", b'{"orderId":"","orderUpdateId":0}'))
        self.assertEqual([type(fault) for fault in faults], [MessageRejected])
        loop.take(state_on("uagv/v2/acme/1/state", b'{"orderId":"","orderUpdateId":0}'))
        self.assertEqual(len(faults), 1)

    def test_messages_that_nobody_can_read_cost_nobody_else_anything(self):
        dice, faults = random.Random(SEED), []
        day = vda5050_test.Day(self.client, 6, on_fault=faults.append)
        bad = next(iter(day.vehicles.values()))
        good_state = bad.state

        def state():
            for _ in range(3):
                message = damaged(good_state(), dice)
                if isinstance(message.get("lastNodeSequenceId"), int):  # it does not lie about where it is
                    message["lastNodeSequenceId"] = bad.last
                for name in ("orderUpdateId", "orderId", "agvPosition", "actionStates", "errors", "serialNumber"):
                    if name in message and not isinstance(message[name], type(good_state()[name])):
                        day.loop.take(message)
            day.loop.take(dice.choice(VALUES))
            return good_state()
        bad.state = state
        day.run(30.0)
        self.assertGreater(len(faults), 50)
        self.assertEqual(day.refused, [])
        self.assertEqual(day.failures, [])
        self.assertGreater(len(day.arrived), 5)
        self.assertEqual(day.met, ([], []))

    def test_a_fleet_of_vehicles_goes_on_after_answers_that_are_none(self):
        client = Damages(self.client, random.Random(SEED), 0.05)
        day = vda5050_test.Day(client, 6)
        day.run(20.0)
        client.share = 0.0
        arrived = len(day.arrived)
        day.run(30.0)
        self.assertGreater(client.count, 5)
        self.assertIsNone(day.loop.failure)
        self.assertGreater(len(day.arrived), arrived)

    def test_answers_that_lose_what_others_rely_on_are_none(self):
        cases = {"plan": [lambda answer: answer.update(tight=None)],
                 "advance": [lambda answer: answer.update(options={}),
                             lambda answer: answer["options"].update(time_budget_ms=7)],
                 "import_vda5050": [lambda answer: answer["progress"][0].update(order_id=None),
                                    lambda answer: answer["progress"][0].update(order_id="x"),
                                    lambda answer: answer["progress"].pop(0)]}
        for name, damages in cases.items():
            for damage in damages:
                client = Loses(self.client, name, damage)
                day = vda5050_test.Day(client, 6)
                day.run(6.0)
                client.is_on = True
                rounds, orders = day.loop.rounds, {vehicle.order_id for vehicle in day.vehicles.values()}
                day.run(12.0)
                with self.subTest(name):
                    self.assertIsInstance(day.loop.failure, InvalidAnswer)
                    self.assertEqual(day.loop.rounds, rounds)
                    self.assertEqual({vehicle.order_id for vehicle in day.vehicles.values()}, orders)
                    client.is_on = False
                    day.run(24.0)
                    self.assertIsNone(day.loop.failure)
                    self.assertEqual((day.refused, day.met), ([], ([], [])))

    def test_a_vehicle_that_never_reports_stops_nobody_for_long(self):
        day = vda5050_test.Day(self.client, 6, wait=3.0)
        silent = next(iter(day.vehicles.values()))
        silent.state = lambda: None
        day.run(30.0)
        self.assertIn(silent.name, day.loop.unavailable)
        self.assertGreater(len(day.arrived), 3)
        self.assertNotIn(silent.name, day.arrived)
        del silent.state
        day.run(40.0)
        self.assertEqual(day.loop.unavailable, {})
        self.assertIn(silent.name, day.arrived)
        self.assertEqual(day.met, ([], []))


class Told(unittest.TestCase):
    def test_a_function_that_is_told_and_raises_ends_nothing(self):
        def raises(_):
            raise KeyError("x")
        loop = VdaLoop(Client("http://localhost:1"), {"robots": [{"id": "a", "start": {"x": 0.0, "y": 0.0}}]},
                       manufacturer="acme", on_fault=raises)
        with loop:
            loop.take({"serialNumber": "b"})
            loop.take(None)


if __name__ == "__main__":
    unittest.main()
