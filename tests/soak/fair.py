"""Who gets an answer when a server has more to do than it can: cases of overload.py.

Each case prints a line and returns its failures. A client sends its next request after an answer.
"""

import json
import multiprocessing
import random
import re
import socket
import threading
import time

import workload
from client import Connection, Lost, request
from report import percentile

REFUSED_MS = 50.0
SLACK_MS = 100.0  # for sending, waking up and reading, which only the client's time includes
PAUSE_S = 0.1     # of a client after a refusal, if it does not wait as long as it is told
PROCESSES = 4     # for the clients of a case
COMPLETE = re.compile(rb'"(status":\s*"solved"|valid":\s*true)')


class Client:
    """Sends one request again and again, and keeps what it was answered."""

    def __init__(self, server, instance, path="/v1/plan", source=None, polite=True):
        self.connection = Connection(server.host, server.port, source=source)
        self.data = request("POST", path, json.dumps(instance).encode())
        self.budget_s = instance["options"]["time_budget_ms"] / 1000
        self.polite = polite
        self.answers = []  # seconds, status, and whether it is a plan for every robot or a valid one
        self.lost = 0

    def ask(self):
        """Returns the answer, or None."""
        begin = time.monotonic()
        try:
            self.connection.send(self.data)
            answer = self.connection.receive()
        except (Lost, OSError):
            self.lost += 1
            self.connection.close()
            return None
        self.answers.append((time.monotonic() - begin, answer.status, COMPLETE.search(answer.body) is not None))
        if answer.status == 503:
            time.sleep(int(answer.fields["retry-after"]) if self.polite else PAUSE_S)
        return answer

    def ask_until(self, end):
        while time.monotonic() < end:
            self.ask()

    def accepted(self):
        return [answer for answer in self.answers if answer[1] == 200]

    def refused(self):
        return [seconds for seconds, status, _ in self.answers if status == 503]


def in_threads(acts):
    threads = [threading.Thread(target=act) for act in acts]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()


def run_part(part, clients, end, results):
    in_threads([lambda client=client: client.ask_until(end) for client in clients])
    results.put((part, [(client.answers, client.lost) for client in clients]))


def run_all(clients, seconds):
    """In processes, so that the clients do not wait for each other."""
    results, end = multiprocessing.Queue(), time.monotonic() + seconds
    children = [multiprocessing.Process(target=run_part, args=(part, clients[part::PROCESSES], end, results))
                for part in range(PROCESSES)]
    for child in children:
        child.start()
    for _ in children:
        part, outcomes = results.get(timeout=seconds + 90)
        for client, (answers, lost) in zip(clients[part::PROCESSES], outcomes):
            client.answers, client.lost = answers, lost
    for child in children:
        child.join()


def judge(name, clients, least_share):
    """Prints the case; its failures."""
    accepted = [answer for client in clients for answer in client.accepted()]
    complete = sum(1 for _, _, is_complete in accepted if is_complete)
    refused = [seconds for client in clients for seconds in client.refused()]
    late = sum(1 for client in clients for seconds, _, _ in client.accepted()
               if seconds > client.budget_s + SLACK_MS / 1000)
    slowest_ms = 1000 * percentile(refused, 0.99) if refused else 0.0
    print(f"{name}: {len(accepted)} accepted, {complete} of them complete, {late} late; "
          f"{len(refused)} refused, p99 {slowest_ms:.1f} ms")
    failures = []
    if not accepted or complete < least_share * len(accepted):
        failures.append(f"{name}: {complete} of {len(accepted)} accepted requests are complete")
    if late:
        failures.append(f"{name}: {late} answers were late")
    if slowest_ms >= REFUSED_MS:
        failures.append(f"{name}: refusals were slow")
    if lost := sum(client.lost for client in clients):
        failures.append(f"{name}: {lost} answers were lost")
    return failures


def hall(robots, side, budget_ms, mode):
    """Robots that cross a hall, each from a random cell to another."""
    random_ = random.Random(1)
    cells = [(c, r) for c in range(0, side, 2) for r in range(0, side, 2)]
    starts, goals = random_.sample(cells, robots), random_.sample(cells, robots)
    pose = lambda cell: {"x": cell[0] + 0.5, "y": cell[1] + 0.5}
    return {"map": {"rows": ["." * side] * side},
            "robots": [{"id": f"r{i}", "start": pose(s), "goal": pose(g)} for i, (s, g) in enumerate(zip(starts, goals))],
            "robot_defaults": {"radius": 0.4, "linear_speed": 1.0, "angular_speed": 2.0},
            "options": {"mode": mode, "time_budget_ms": budget_ms}}


def many_anytime(server, seconds):
    """Far more plans than workers, each of which would use its whole budget to improve."""
    clients = [Client(server, hall(120, 64, 1000, "anytime"), polite=False) for _ in range(64)]
    run_all(clients, seconds)
    return judge("64 clients, anytime, 120 robots, 1 s", clients, 0.99)


def beside_long_plans(server):
    """Small plans, and checks of them, beside two plans of 30 s, whose clients leave at the end."""
    long_plans = [Client(server, workload.endless(30_000)) for _ in range(2)]
    plans = Client(server, hall(5, 16, 1000, "first"))
    checks = Client(server, dict(hall(5, 16, 1000, "first"), plans=plans.ask().json()["plans"]), "/v1/validate")
    threads = [threading.Thread(target=client.ask) for client in long_plans]
    for thread in threads:
        thread.start()
    time.sleep(1.0)
    for _ in range(100):
        plans.ask()
        checks.ask()
    for client in long_plans:
        client.connection.socket.shutdown(socket.SHUT_RDWR)
    for thread in threads:
        thread.join()
    return (judge("5 robots, 1 s, beside two anytime plans of 30 s", [plans], 1.0) +
            judge("checks, 1 s, beside two anytime plans of 30 s", [checks], 1.0))


def greedy_and_polite(server, seconds):
    """60 connections of one client that does not wait, and four clients that do."""
    greedy = [Client(server, hall(120, 64, 1000, "first"), source="127.0.0.2", polite=False) for _ in range(60)]
    polite = [Client(server, hall(60, 64, 1000, "first"), source=f"127.0.0.{10 + k}") for k in range(4)]
    run_all(polite + greedy, seconds)
    failures = judge("four polite clients beside 60 greedy connections", polite, 0.99)
    asked = sum(len(client.answers) for client in polite)
    answered = sum(len(client.accepted()) for client in polite)
    print(f"  of the polite requests {answered} of {asked} were answered, of the greedy ones "
          f"{sum(len(client.accepted()) for client in greedy)} of {sum(len(client.answers) for client in greedy)}")
    if answered < 0.9 * asked:
        failures.append(f"polite clients got {answered} of {asked} answers")
    return failures


def cases(server, seconds):
    return many_anytime(server, seconds) + beside_long_plans(server) + greedy_and_polite(server, seconds)
