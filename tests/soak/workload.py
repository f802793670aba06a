"""The requests of the clients: valid ones, and invalid ones with the expected status."""

import gzip
import json
import pathlib
import random

SCENARIOS = pathlib.Path(__file__).resolve().parent.parent / "scenarios"


def scenarios():
    """The requests of tests/scenarios by name, with a budget of 2 s."""
    found = {}
    for path in sorted(SCENARIOS.glob("*.json")):
        if path.name == "index.json":
            continue
        found[path.stem] = json.loads(path.read_text())
        found[path.stem].setdefault("options", {})["time_budget_ms"] = 2000
    return found


def random_fleet(random_: random.Random):
    """A small hall with walls and a few robots, each on its own cell."""
    columns, rows = random_.randint(5, 24), random_.randint(4, 16)
    free = [(c, r) for c in range(columns) for r in range(rows) if random_.random() > 0.15]
    grid = [["#"] * columns for _ in range(rows)]
    for c, r in free:
        grid[rows - 1 - r][c] = "."
    count = min(random_.randint(1, 12), len(free))
    starts, goals = random_.sample(free, count), random_.sample(free, count)
    pose = lambda cell: {"x": cell[0] + 0.5, "y": cell[1] + 0.5, "theta": random_.uniform(-10, 10)}
    robots = []
    for index, (start, goal) in enumerate(zip(starts, goals)):
        robot = {"id": f"r{index}-{random_.getrandbits(32):x}", "start": pose(start),
                 "radius": random_.choice([0.2, 0.3, 0.45])}
        if random_.random() < 0.9:
            robot["goal"] = pose(goal)
        robots.append(robot)
    options = {"seed": random_.getrandbits(31), "time_budget_ms": random_.choice([50, 200, 1000]),
               "mode": random_.choice(["first", "first", "anytime"]), "max_iterations": random_.randint(0, 20),
               "priority": random_.choice(["shortest_first", "longest_first", "as_listed", "random"]),
               "reordering": random_.choice(["raise_failed", "random", "none"]),
               "connectivity": random_.choice([4, 8, 16, 32]), "any_angle": random_.random() < 0.8}
    return {"map": {"rows": ["".join(row) for row in grid]}, "robots": robots, "options": options,
            "robot_defaults": {"radius": 0.3, "linear_speed": 1.0, "angular_speed": 2.0}}


def vehicles(random_: random.Random):
    """Robots that cross each other's ways in a hall."""
    rows = random_.sample(range(2, 18), 3)
    columns = random_.sample(range(4, 16), 3)
    ways = [((1, row), (18, row)) for row in rows] + [((column, 1), (column, 18)) for column in columns]
    pose = lambda cell: {"x": cell[0] + 0.5, "y": cell[1] + 0.5}
    robots = [{"id": f"v{k}", "start": pose(start), "goals": [{**pose(goal), "service": random_.uniform(0.0, 3.0)}]}
              for k, (start, goal) in enumerate(way[::random_.choice([1, -1])] for way in ways)]
    return {"map": {"rows": ["." * 20] * 20}, "robots": robots,
            "robot_defaults": {"radius": 0.3, "linear_speed": random_.uniform(0.5, 2.0), "angular_speed": 2.0},
            "options": {"dependencies": True, "interval_margin": 0.5, "time_budget_ms": 2000}}


def of_orders(header, instance, plan):
    """A body of `/v1/export/vda5050`."""
    members = {name: instance[name] for name in ("robots", "robot_defaults", "options")}
    return {**header, **members, "plans": plan["plans"], "dependencies": plan["dependencies"]}


def progress_of(sent):
    """Of a robot that has been sent this order, and has not moved."""
    return {"robot": sent["robot"], "order_id": sent["order"]["orderId"], "action": 0, "progress": 0.0,
            "order_update_id": sent["order"]["orderUpdateId"],
            "last_released_sequence_id": sent["last_released_sequence_id"]}


def state_of(robot, order):
    """Of a vehicle that stands at the first node of its order."""
    first, *rest = order["nodes"]
    position = {**first["nodePosition"], "positionInitialized": True}
    position.setdefault("theta", 0.0)
    return {"serialNumber": robot, "orderId": order["orderId"], "orderUpdateId": order["orderUpdateId"],
            "lastNodeId": first["nodeId"], "lastNodeSequenceId": first["sequenceId"], "agvPosition": position, "actionStates": [], "errors": [],
            "nodeStates": [{"sequenceId": node["sequenceId"], "released": node["released"]} for node in rest]}


def endless(budget_ms):
    """A request that uses its whole budget: 100 robots in a hall, whose plan is improved until the time is over."""
    places = [(c + 0.5, r + 0.5) for r in range(0, 20, 4) for c in range(20)]
    robots = [{"id": f"e{i}", "start": {"x": x, "y": y}, "goal": {"x": 20 - x, "y": 20 - y}}
              for i, (x, y) in enumerate(places)]
    return {"map": {"rows": ["." * 20] * 20}, "robots": robots,
            "robot_defaults": {"radius": 0.4, "linear_speed": 1.0, "angular_speed": 2.0},
            "options": {"mode": "anytime", "time_budget_ms": budget_ms}}


def huge(limits):
    """As many cells and robots as the service accepts; 20 of the robots have a goal. The budget is 1 s."""
    side = int(min(limits["max_cells"], 4_000_000) ** 0.5)
    count = min(limits["max_robots"], 2000)
    robots = []
    for index in range(count):
        x, y = 1.5 + 10 * (index % (side // 10)), 1.5 + 10 * (index // (side // 10))
        robot = {"id": f"h{index}", "start": {"x": x, "y": y}}
        if index < 20:
            robot["goal"] = {"x": side - 1.5 - x, "y": side - 1.5 - y}
        robots.append(robot)
    return {"map": {"rows": ["." * side] * side}, "robots": robots,
            "robot_defaults": {"radius": 0.4, "linear_speed": 1.0, "angular_speed": 2.0},
            "options": {"time_budget_ms": 1000}}


def bad_bodies(limits):
    """Pairs of an invalid body and the expected status."""
    good = random_fleet(random.Random(1))
    changed = lambda **changes: json.dumps({**good, **changes}).encode()
    robot = good["robots"][0]
    return [
        (b"", 400), (b"{", 400), (b"[" * 100_000, 400), (b"\xff\xfe", 400), (b'{"map":NaN}', 400),
        (b'{"a":1} x', 400), (b'{"a":"\x00"}', 400), (b"[]", 422), (b"{}", 422), (b'{"map":1,"map":2}', 422),
        (changed(robots=[]), 422), (changed(robots=[robot, robot]), 422), (changed(unknown=1), 422),
        (changed(robots=[{**robot, "radius": -1}]), 422), (changed(robots=[{**robot, "start": None}]), 422),
        (changed(options={"seed": -1}), 422), (changed(map={"rows": ["..", "."]}), 422),
        (changed(map={"rows": ["#"]}), 422), (b'{"map":{"rows":["."],"resolution":1e999}}', 422),
        (changed(robots=[{**robot, "id": "x" * 100_000, "radius": 0}]), 422),
        (b'{"robots":' + b"[{}," * 10_000 + b"{}" + b"]" * 10_001, 400),
        (json.dumps({"map": {"rows": ["." * 5000] * (limits["max_cells"] // 5000 + 1)}, "robots": []}).encode(), 422),
    ]


def malformed_requests(limits):
    """Pairs of the bytes of a bad request and the expected status."""
    host = b"Host: localhost\r\n"
    post = b"POST /v1/plan HTTP/1.1\r\n" + host
    json_post = post + b"Content-Type: application/json\r\n"
    chunked = json_post + b"Transfer-Encoding: chunked\r\n\r\n"
    cut_off = gzip.compress(b"{}")[:-8]  # without checksum and length
    return [
        (b"GET / HTTP/1.1\n\n", 400), (b"PRI * HTTP/2.0\r\n\r\n", 400), (b"GET /a b HTTP/1.1\r\n" + host + b"\r\n", 400),
        (b"GET / HTTP/1.1\r\n\r\n", 400), (b"GET / HTTP/1.1\r\n" + host + host + b"\r\n", 400),
        (b"GET / HTTP/1.1\r\nHost: rebound.example\r\n\r\n", 421),
        (json_post + b"Origin: http://other.example\r\nContent-Length: 2\r\n\r\n{}", 403),
        (post + b"Content-Length: -1\r\n\r\n", 400), (post + b"Content-Length: 1x\r\n\r\n", 400),
        (post + b"Content-Length: 1\r\nContent-Length: 2\r\n\r\nab", 400),
        (post + b"Content-Length: 1\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n", 400),
        (post + b"Transfer-Encoding: gzip\r\n\r\n", 400), (json_post + b"Transfer-Encoding: chunked\r\n\r\nxyz\r\n", 400),
        (json_post + b"Transfer-Encoding: chunked\r\n\r\nFFFFFFFFFFFFFFFF\r\n", 413),
        (json_post + f"Content-Length: {limits['max_body'] + 1}\r\n\r\n".encode(), 413),
        (b"GET /" + b"a" * 70_000 + b" HTTP/1.1\r\n" + host + b"\r\n", 414),
        (b"GET / HTTP/1.1\r\n" + b"A: b\r\n" * 200 + b"\r\n", 431),
        (b"GET /nowhere HTTP/1.1\r\n" + host + b"\r\n", 404), (b"DELETE /v1/plan HTTP/1.1\r\n" + host + b"\r\n", 405),
        (chunked + b"2;\r\n{}\r\n0\r\n\r\n", 400), (chunked + b"2\n{}\r\n0\r\n\r\n", 400),
        (chunked + b"2\r\n{}\r\n0\r\nA: b\n\r\n", 400), (b"GET /#a HTTP/1.1\r\n" + host + b"\r\n", 400),
        (json_post + b"Content-Encoding: gzip\r\nContent-Length: %d\r\n\r\n" % len(cut_off) + cut_off, 400),
        (post + b"Content-Length: 2\r\n\r\n{}", 415),
        (post + b"Content-Type: text/plain\r\nContent-Length: 2\r\n\r\n{}", 415),
        (json_post + b"Content-Encoding: br\r\nContent-Length: 2\r\n\r\n{}", 415),
        (json_post + b"Content-Encoding: gzip\r\nContent-Length: 2\r\n\r\n{}", 400),
        (json_post + b"Accept: text/html\r\nContent-Length: 2\r\n\r\n{}", 406),
    ]
