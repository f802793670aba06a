"""The clients of a soak: each sends one request after the other on its own connection and checks every answer."""

import collections
import gzip
import json
import random
import threading
import time
import uuid

import workload
from client import Connection, Lost, request

# How often each kind comes, of all. The huge ones are rare, as each takes seconds of everybody's time.
KINDS = {"scenario": 20, "random": 40, "gzip": 10, "stream": 6, "bad body": 10, "bad framing": 8, "small": 10,
         "cancelled": 6, "slow": 2, "pipelined": 4, "huge": 0.3}


class Wrong(Exception):
    """A wrong answer."""


def detail_of(answer):
    """The reason, without the parts that differ each time."""
    try:
        return answer.json()["detail"]
    except (ValueError, KeyError):
        return answer.body[:500]


class Record:
    """The counts of one process, which are sent to the parent."""

    def __init__(self):
        self.sent = collections.Counter()       # by kind
        self.statuses = collections.Counter()
        self.latencies = collections.defaultdict(list)  # seconds by kind, of answers other than 503
        self.wrong, self.lost = [], []
        self.validated = 0


class Client(threading.Thread):
    def __init__(self, host, port, seed, limits, until, record, lock):
        super().__init__(daemon=True)
        self.connection = Connection(host, port)
        self.address = (host, port)
        self.random = random.Random(seed)
        self.limits, self.until = limits, until
        self.record, self.lock = record, lock
        self.scenarios = list(workload.scenarios().items())
        self.bad_bodies, self.bad_texts = workload.bad_bodies(limits), workload.bad_texts(limits)

    def run(self):
        kinds, weights = list(KINDS), list(KINDS.values())
        acts = {kind: getattr(self, "do_" + kind.replace(" ", "_")) for kind in kinds}
        while time.monotonic() < self.until:
            kind = self.random.choices(kinds, weights)[0]
            with self.lock:
                self.record.sent[kind] += 1
            try:
                acts[kind](kind)
            except Lost as lost:
                self._note(self.record.lost, f"{kind}: {lost}")
            except Exception as wrong:  # also a KeyError in an answer: nothing may end the client
                self._note(self.record.wrong, f"{kind}: {type(wrong).__name__}: {wrong}"[:2000])
        self.connection.close()

    def _note(self, where, what):
        self.connection.close()
        with self.lock:
            where.append(what)

    # ---------------------------------------------------------------- asking

    def ask(self, kind, method, path, expected, body=None, fields=(), send=None):
        """Sends a request and returns its answer, which must have one of the expected statuses, or 503. `send`
        replaces sending at once."""
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
        told = answer.fields.get("x-request-id")
        if not told or (id_ and told != id_):
            raise Wrong(f"asked as {id_}, answered as {told}")
        if answer.status == 503:
            if int(answer.fields.get("retry-after", 0)) < 1:
                raise Wrong("503 without Retry-After")
            time.sleep(self.random.uniform(0.0, 0.05))
        elif answer.status not in expected:
            raise Wrong(f"status {answer.status} instead of {expected}: {detail_of(answer)}")
        if answer.status >= 400 and answer.body:
            problem = answer.json()
            if problem["status"] != answer.status or problem["request_id"] != told or not problem["code"]:
                raise Wrong(f"a strange problem: {answer.body[:500]}")

    def plan(self, kind, wanted, fields=(), body=None, send=None):
        """Posts a request to plan, checks that the answer belongs to it, and validates the plan."""
        answer = self.ask(kind, "POST", "/v1/plan", {200}, body or json.dumps(wanted).encode(), fields, send)
        if answer.status == 200:
            self.validate(wanted, answer.json(), answer.fields["x-request-id"])

    def validate(self, wanted, got, id_):
        asked = [robot["id"] for robot in wanted["robots"]]
        told = [entry["robot"] for member in ("plans", "unplanned") for entry in got[member]]
        if got["request_id"] != id_ or sorted(asked) != sorted(told):
            raise Wrong(f"the answer to another request: {told} instead of {asked}")
        starts = {robot["id"]: robot["start"] for robot in wanted["robots"]}
        for plan in got["plans"]:
            if plan["actions"] and abs(plan["actions"][0]["from"]["x"] - starts[plan["robot"]]["x"]) > 1e-6:
                raise Wrong(f"a plan that begins elsewhere: {plan['robot']}")
        verdict = self.ask("validate", "POST", "/v1/validate", {200}, json.dumps({**wanted, **got}).encode())
        if verdict.status != 200:
            return
        with self.lock:
            self.record.validated += 1
        if not verdict.json()["valid"]:
            raise Wrong(f"not valid: {verdict.body[:1000]} for {json.dumps(wanted)}")

    # ---------------------------------------------------------------- the kinds

    def do_scenario(self, kind):
        self.plan(kind, self.random.choice(self.scenarios)[1])

    def do_random(self, kind):
        # A start may overlap another or a wall by the robots' sizes: that is a 422, and a good test as well.
        wanted = workload.random_fleet(self.random)
        answer = self.ask(kind, "POST", "/v1/plan", {200, 422}, json.dumps(wanted).encode())
        if answer.status == 200:
            self.validate(wanted, answer.json(), answer.fields["x-request-id"])

    def do_gzip(self, kind):
        wanted = self.random.choice(self.scenarios)[1]
        fields = [("Content-Encoding", "gzip"), ("Accept-Encoding", "gzip")]
        self.plan(kind, wanted, fields, gzip.compress(json.dumps(wanted).encode(), 1))

    def do_stream(self, kind):
        wanted = self.random.choice(self.scenarios)[1]
        answer = self.ask(kind, "POST", "/v1/plan", {200}, json.dumps(wanted).encode(),
                          [("Accept", "text/event-stream")])
        if answer.status != 200:
            return
        events = [event for event in answer.body.decode().split("\n\n") if event.startswith("event:")]
        name, data = events[-1].split("\n", 1)
        if name != "event: plan":
            raise Wrong(f"a stream that ends with {name}")
        self.validate(wanted, json.loads(data.removeprefix("data:")), answer.fields["x-request-id"])

    def do_bad_body(self, kind):
        body, status = self.random.choice(self.bad_bodies)
        self.ask(kind, "POST", self.random.choice(["/v1/plan", "/v1/validate"]), {status}, body)

    def do_bad_framing(self, kind):
        text, status = self.random.choice(self.bad_texts)
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

    def do_huge(self, kind):
        wanted = workload.huge(self.limits)
        self.plan(kind, wanted)


def run_process(host, port, seed, connections, limits, seconds, result):
    """Runs the clients of one process until the time is over; sends their record."""
    record, lock, until = Record(), threading.Lock(), time.monotonic() + seconds
    clients = [Client(host, port, seed * 1000 + index, limits, until, record, lock)
               for index in range(connections)]
    for client in clients:
        client.start()
    for client in clients:
        client.join()
    result.put(record)
