"""The clients of a soak test. Each sends requests one after another on its own connection and checks every answer."""

import collections
import gzip
import json
import random
import threading
import time
import uuid

import workload
from client import Connection, Lost, request

# Relative frequency of each kind of request. Huge requests are rare because each occupies the server for seconds.
KINDS = {"scenario": 20, "random": 40, "gzip": 10, "stream": 6, "bad body": 10, "bad framing": 8, "small": 10,
         "cancelled": 6, "slow": 2, "pipelined": 4, "orders": 2, "huge": 0.3}
COSTLY = {"costly": 1}  # in addition, if they are asked for: see costly.py
LARGE = {"bad body", "huge", "costly", "validate"}  # with bodies of up to USUAL_BODY
USUAL_BODY = 32 << 20  # bytes: the default of --max-body


class Wrong(Exception):
    """A wrong answer."""


class Busy(Exception):
    """A 503."""


def detail_of(answer):
    """The detail of a problem, or the start of a body that is not one."""
    try:
        return answer.json()["detail"]
    except (ValueError, KeyError):
        return answer.body[:500]


class Record:
    """The results of one process, sent to its parent."""

    def __init__(self):
        self.sent = collections.Counter()       # by kind
        self.statuses = collections.Counter()
        self.latencies = collections.defaultdict(list)  # seconds, by kind; without 503 answers
        self.wrong, self.lost = [], []
        self.validated = 0


class Client(threading.Thread):
    def __init__(self, host, port, seed, limits, until, record, lock, costly):
        super().__init__(daemon=True)
        self.connection = Connection(host, port)
        self.address = (host, port)
        self.random = random.Random(seed)
        self.limits, self.until = limits, until
        self.record, self.lock = record, lock
        self.scenarios = list(workload.scenarios().items())
        self.costly = costly
        self.bad_bodies, self.malformed = workload.bad_bodies(limits), workload.malformed_requests(limits)

    def run(self):
        frequencies = {**KINDS, **(COSTLY if self.costly else {})}
        kinds, weights = list(frequencies), list(frequencies.values())
        actions = {kind: getattr(self, "do_" + kind.replace(" ", "_")) for kind in kinds}
        while time.monotonic() < self.until:
            kind = self.random.choices(kinds, weights)[0]
            with self.lock:
                self.record.sent[kind] += 1
            try:
                actions[kind](kind)
            except Lost as lost:
                self._note(self.record.lost, f"{kind}: {lost}")
            except Exception as wrong:  # includes a KeyError for a missing member; the client goes on
                self._note(self.record.wrong, f"{kind}: {type(wrong).__name__}: {wrong}"[:2000])
        self.connection.close()

    def _note(self, where, what):
        self.connection.close()
        with self.lock:
            where.append(what)

    # ---------------------------------------------------------------- requests

    def ask(self, kind, method, path, expected, body=None, fields=(), send=None):
        """Sends a request and returns its answer, whose status must be one of `expected` or 503. `send` replaces
        the function that sends the bytes."""
        id_ = uuid.UUID(int=self.random.getrandbits(128)).hex
        data = request(method, path, body, [("X-Request-Id", id_), *fields])
        begin = time.monotonic()
        (send or self.connection.send)(data)
        answer = self.connection.receive(head_only=method == "HEAD")
        self.check(kind, answer, expected, time.monotonic() - begin, id_)
        return answer

    def check(self, kind, answer, expected, seconds, id_=None):
        with self.lock:
            self.record.statuses[answer.status] += 1
            if answer.status != 503:
                self.record.latencies[kind].append(seconds)
        returned_id = answer.fields.get("x-request-id")
        if not returned_id or (id_ and returned_id != id_):
            raise Wrong(f"X-Request-Id {returned_id} instead of {id_}")
        if answer.status == 503:
            if int(answer.fields.get("retry-after", 0)) < 1:
                raise Wrong("503 without Retry-After")
            time.sleep(self.random.uniform(0.0, 0.05))
        elif answer.status not in expected and not (answer.status == 413 and self.may_be_too_large(kind)):
            raise Wrong(f"status {answer.status} instead of {expected}: {detail_of(answer)}")
        if answer.status >= 400 and answer.body:
            problem = answer.json()
            if problem["status"] != answer.status or problem["request_id"] != returned_id or not problem["code"]:
                raise Wrong(f"an inconsistent problem: {answer.body[:500]}")

    def may_be_too_large(self, kind):
        """Whether requests of this kind have bodies that a server with a smaller --max-body than usual refuses."""
        return kind in LARGE and self.limits["max_body"] < USUAL_BODY

    def plan(self, kind, instance, fields=(), body=None, send=None):
        """Requests a plan for an instance, checks that the answer belongs to it, and validates the plan."""
        answer = self.ask(kind, "POST", "/v1/plan", {200}, body or json.dumps(instance).encode(), fields, send)
        if answer.status == 200:
            self.validate(instance, answer.json(), answer.fields["x-request-id"])

    def validate(self, instance, content, id_):
        expected = [robot["id"] for robot in instance["robots"]]
        returned = [entry["robot"] for member in ("plans", "unplanned") for entry in content[member]]
        if content["request_id"] != id_ or sorted(expected) != sorted(returned):
            raise Wrong(f"the answer to another request: {returned} instead of {expected}")
        starts = {robot["id"]: robot["start"] for robot in instance["robots"]}
        for plan in content["plans"]:
            if plan["actions"] and abs(plan["actions"][0]["from"]["x"] - starts[plan["robot"]]["x"]) > 1e-6:
                raise Wrong(f"a plan that does not begin at the start: {plan['robot']}")
        verdict = self.ask("validate", "POST", "/v1/validate", {200}, json.dumps({**instance, **content}).encode())
        if verdict.status != 200:
            return
        with self.lock:
            self.record.validated += 1
        if not verdict.json()["valid"]:
            raise Wrong(f"not valid: {verdict.body[:1000]} for {json.dumps(instance)}")

    # ---------------------------------------------------------------- kinds of requests

    def do_scenario(self, kind):
        self.plan(kind, self.random.choice(self.scenarios)[1])

    def do_random(self, kind):
        # Robots may overlap each other or a wall, which is a 422.
        instance = workload.random_fleet(self.random)
        answer = self.ask(kind, "POST", "/v1/plan", {200, 422}, json.dumps(instance).encode())
        if answer.status == 200:
            self.validate(instance, answer.json(), answer.fields["x-request-id"])

    def do_gzip(self, kind):
        instance = self.random.choice(self.scenarios)[1]
        fields = [("Content-Encoding", "gzip"), ("Accept-Encoding", "gzip")]
        self.plan(kind, instance, fields, gzip.compress(json.dumps(instance).encode(), 1))

    def do_stream(self, kind):
        instance = self.random.choice(self.scenarios)[1]
        answer = self.ask(kind, "POST", "/v1/plan", {200}, json.dumps(instance).encode(),
                          [("Accept", "text/event-stream")])
        if answer.status != 200:
            return
        events = [event for event in answer.body.decode().split("\n\n") if event.startswith("event:")]
        name, data = events[-1].split("\n", 1)
        content = json.loads(data.removeprefix("data:"))
        if name == "event: problem" and content["status"] == 503:
            return  # the queue became too long after the stream had begun
        if name != "event: plan":
            raise Wrong(f"the stream ended with {name}: {content}")
        self.validate(instance, content, answer.fields["x-request-id"])

    def do_bad_body(self, kind):
        body, status = self.random.choice(self.bad_bodies)
        self.ask(kind, "POST", self.random.choice(["/v1/plan", "/v1/validate"]), {status}, body)

    def do_bad_framing(self, kind):
        text, status = self.random.choice(self.malformed)
        connection = Connection(*self.address)
        begin = time.monotonic()
        connection.send(text)
        try:
            answer = connection.receive()
        finally:
            connection.close()
        self.check(kind, answer, {status}, time.monotonic() - begin)

    def do_small(self, kind):
        path = self.random.choice(["/healthz", "/readyz", "/", "/v1/limits", "/v1/examples", "/v1/examples/crossing"])
        method = self.random.choice(["GET", "GET", "HEAD"])
        fields = [("Range", "bytes=0-3")] if self.random.random() < 0.2 else []
        answer = self.ask(kind, method, path, {200}, fields=fields)
        if method == "GET" and path.startswith("/v1"):
            answer.json()

    def do_cancelled(self, _kind):
        connection = Connection(*self.address)
        data = request("POST", "/v1/plan", json.dumps(workload.endless(10_000)).encode())
        connection.send(data[:self.random.choice([len(data), len(data), self.random.randrange(1, len(data))])])
        time.sleep(self.random.uniform(0.0, 0.2))
        connection.close()

    def do_slow(self, kind):
        def in_pieces(data):
            self.connection.send(b"")
            for at in range(0, len(data), 1 + len(data) // 8):
                self.connection.send_more(data[at:at + 1 + len(data) // 8])
                time.sleep(0.2)
        self.plan(kind, self.random.choice(self.scenarios)[1], send=in_pieces)

    def do_pipelined(self, kind):
        connection = Connection(*self.address)
        ids = [uuid.UUID(int=self.random.getrandbits(128)).hex for _ in range(8)]
        begin = time.monotonic()
        connection.send(b"".join(request("GET", "/v1/limits", None, [("X-Request-Id", id_)]) for id_ in ids))
        try:
            for id_ in ids:
                self.check(kind, connection.receive(), {200}, time.monotonic() - begin, id_)
        finally:
            connection.close()

    def do_orders(self, kind):
        try:
            self.continue_orders(kind)
        except Busy:
            pass  # such vehicles go on with the orders that they have

    def continue_orders(self, kind):
        """Vehicles get the orders of a plan, and report; the next plan goes on with what is released of them."""
        instance = workload.vehicles(self.random)
        plan = self.posted(kind, "/v1/plan", instance)
        header = {"version": self.random.choice(["2.1.0", "3.0.0"]), "manufacturer": "acme", "release_ahead": 3.0,
                  "timestamp": "2026-01-31T12:00:00.000Z"}
        sent = self.posted(kind, "/v1/export/vda5050", workload.of_orders(header, instance, plan))
        orders = {entry["robot"]: entry["order"] for entry in sent["orders"]}
        progress = [workload.progress_of(entry) for entry in sent["orders"]]
        messages = [workload.state_of(robot, order) for robot, order in orders.items()]
        reported = self.posted(kind, "/v1/import/vda5050",
                               {**workload.of_orders(header, instance, plan), "progress": progress, "messages": messages})
        if not all(vehicle["accepted"] for vehicle in reported["vehicles"] if vehicle["robot"] in orders):
            raise Wrong(f"an order is not accepted: {reported}")
        later = self.posted(kind, "/v1/advance", {
            "request": instance, "plans": plan["plans"], "at": 0.5, "commit": 1.0, "states": reported["states"]})
        base = [{"robot": robot, "order": order, "state": state} for (robot, order), state in zip(orders.items(), messages)]
        plan = self.posted(kind, "/v1/plan", later)
        updates = self.posted(kind, "/v1/export/vda5050", {**workload.of_orders(header, later, plan), "base": base})
        if updates["cancel_orders"]:
            raise Wrong(f"an order is cancelled: {updates['cancel_orders']}")
        for entry in updates["orders"]:
            known = [node for node in orders[entry["robot"]]["nodes"] if node["released"]]
            if entry["order"]["nodes"][0] != known[-1]:
                raise Wrong(f"an update that does not begin where the base ends: {entry['order']['nodes'][0]}, {known[-1]}")

    def posted(self, kind, path, body):
        """The content of the answer."""
        answer = self.ask(kind, "POST", path, {200}, json.dumps(body).encode())
        if answer.status == 503:
            raise Busy
        return answer.json()

    def do_costly(self, kind):
        """Every third client leaves before the answer."""
        connection = Connection(*self.address)
        begin = time.monotonic()
        connection.send(self.random.choice(self.costly).data)
        try:
            if self.random.random() < 1 / 3:
                time.sleep(self.random.uniform(0.0, 0.5))
            else:
                self.check(kind, connection.receive(), {200, 422}, time.monotonic() - begin)
        finally:
            connection.close()

    def do_huge(self, kind):
        self.plan(kind, workload.huge(self.limits))


def run_process(host, port, seed, connections, limits, seconds, costly, result):
    """Runs the clients of one process for this time and puts their record into `result`. `costly`: requests that cost
    the server much, to mix in."""
    record, lock, until = Record(), threading.Lock(), time.monotonic() + seconds
    clients = [Client(host, port, seed * 1000 + index, limits, until, record, lock, costly)
               for index in range(connections)]
    for client in clients:
        client.start()
    for client in clients:
        client.join()
    result.put(record)
