"""Valid and invalid requests that cost a server much more than they cost the client. Each gets the right answer within
its time and its memory. `measure` sends each of them to a separate server."""

import base64
import dataclasses
import gzip
import json
import math
import os
import random
import struct
import threading
import time
import zlib
from typing import Callable

from client import Connection, Lost, request
from server import Server
from workload import endless

MIB = 1 << 20
LISTED = 20  # entries of a list in an answer
ROBOT = {"radius": 0.3, "linear_speed": 1.0, "angular_speed": math.pi}


@dataclasses.dataclass
class Costly:
    """`seconds`: until the answer, on an idle machine, without the delay that is allowed. `mib`: resident memory of the
    server at most. `fault`: what is wrong with an answer, or None. `copies`: sent at the same time."""
    name: str
    data: bytes
    seconds: float
    mib: int
    fault: Callable
    copies: int = 1
    before: Callable | None = None  # a request that is sent a second earlier, as often as there are workers


# ---------------------------------------------------------------- answers

def refused(*codes):
    """With one of these codes, and only the first of many faults."""
    def fault(answer):
        code = answer.json().get("code")
        if answer.status not in (422, 503) or code not in codes:
            return f"{answer.status} {code}"
        return "a long list of faults" if len(answer.json()["errors"]) > LISTED else None
    return fault


def bad_image(answer):
    """Whatever the robots, the image cannot be decoded."""
    faults = [(fault["pointer"], fault["code"]) for fault in answer.json().get("errors", [])]
    return None if answer.status == 422 and faults == [("/map/image/png", "bad_image")] else f"{answer.status} {faults}"


def planned(statuses, reasons=None, blocked_by=None):
    """A plan of one of these statuses; robots without a plan have one of these reasons, and short lists."""
    def fault(answer):
        content = answer.json()
        if answer.status != 200 or content["status"] not in statuses:
            return f"{answer.status} {content.get('code', content['status'])}"
        for robot in content["unplanned"]:
            if reasons is not None and robot["reason"] not in reasons:
                return f"{robot['robot']}: {robot['reason']}"
            if len(robot["blocked_by"]) > LISTED:
                return f"blocked_by has {len(robot['blocked_by'])} ids"
            if blocked_by is not None and robot["blocked_by"] != blocked_by:
                return f"blocked_by is {robot['blocked_by']}"
        return None
    return fault


def planned_or_refused(*codes):
    """A plan, or a refusal with one of these codes."""
    def fault(answer):
        return (planned(["solved", "partial", "none"]) if answer.status == 200 else refused(*codes))(answer)
    return fault


def valid(answer):
    return None if answer.status == 200 and answer.json()["valid"] else f"{answer.status} {answer.body[:200]}"


def valid_or_unfinished(answer):
    return None if answer.status == 422 and answer.json()["code"] == "check_unfinished" else valid(answer)


def answered_or_refused(member, *codes):
    """An answer with this member, or a refusal with one of these codes; and no long answer to a short request."""
    def fault(answer):
        content = answer.json()
        if answer.status == 422 and content["code"] in codes:
            return None
        if answer.status != 200 or member not in content:
            return f"{answer.status} {answer.body[:200]}"
        return f"an answer of {len(answer.body)} bytes" if len(answer.body) > 16 * MIB else None
    return fault


def answered_or_unfinished(member):
    """The same with a refusal after the time budget."""
    return answered_or_refused(member, "check_unfinished", "memory_exceeded")


# ---------------------------------------------------------------- requests

def posted(body, path="/v1/plan"):
    data = body if isinstance(body, bytes) else json.dumps(body).encode()
    return request("POST", path, gzip.compress(data, 6), [("Content-Encoding", "gzip")])


def grid(columns, count, spacing):
    """The centres of the first squares of a grid, row by row."""
    return [{"x": spacing * (i % columns + 0.5), "y": spacing * (i // columns + 0.5)} for i in range(count)]


def crowd_with_long_ids():
    """2000 robots with ids of 256 characters, each of which blocks all others because of the inflation."""
    robots = [{"id": f"{i:04}" + "x" * 252, "start": place, "goal": {**place, "x": place["x"] + 5.0}}
              for i, place in enumerate(grid(45, 2000, 60.0))]
    return {"map": {"rows": ["..."] * 3, "resolution": 1000.0}, "robots": robots, "robot_defaults": ROBOT,
            "options": {"inflation": 900.0}}


def blocked_door():
    """A robot is parked in the only door of the room with the goal. The goal is far from the start, in a hall of 600 x
    600 cells.
    """
    rows = ["." * 600 for _ in range(600)]
    for row in range(10):
        rows[row] = "." * 590 + ("D" if row == 5 else "#") + "." * 9
    rows[10] = "." * 590 + "#" * 10
    rows[5] = rows[5].replace("D", ".")
    robots = [{"id": "guest", "start": {"x": 0.5, "y": 0.5}, "goal": {"x": 596.5, "y": 596.5}},
              {"id": "door", "start": {"x": 590.5, "y": 594.5}}]
    return {"map": {"rows": rows}, "robots": robots, "robot_defaults": {**ROBOT, "radius": 0.4}}


def chain():
    """The goal of each of 2000 robots is the start of the next one; the last one is parked."""
    places = grid(100, 2000, 1.0)
    robots = [{"id": f"r{i}", "start": place} for i, place in enumerate(places)]
    for robot, place in zip(robots, places[1:]):
        robot["goal"] = place
    return {"map": {"rows": ["." * 100] * 20}, "robots": robots, "robot_defaults": {**ROBOT, "radius": 0.4},
            "options": {"time_budget_ms": 200}}


def crowd_on_a_large_map(budget_ms):
    """2000 robots that cross 2000 x 2000 free cells."""
    robots = [{"id": f"r{i}", "start": place, "goal": {"x": 2000.0 - place["x"], "y": place["y"]}}
              for i, place in enumerate(grid(45, 2000, 44.0))]
    return {"map": {"rows": ["." * 2000] * 2000}, "robots": robots, "robot_defaults": {**ROBOT, "radius": 0.4},
            "options": {"time_budget_ms": budget_ms}}


def giants_on_a_blocked_map():
    """32 robots of half the size of a map without a free cell."""
    robots = [{"id": f"r{i}", "start": {"x": 1000.0, "y": 1000.0 + i}, "goal": {"x": 1000.0, "y": 1000.0 - i}}
              for i in range(32)]
    return {"map": {"rows": ["#" * 2000] * 2000}, "robots": robots, "robot_defaults": {**ROBOT, "radius": 999.0}}


def long_plan(legs):
    """One robot that goes to and fro in a diagonal corridor between opposite corners of 2000 x 2000 cells."""
    rows = ["#" * max(0, 1998 - row) + "." * (3 if 0 < row < 1999 else 2) + "#" * max(0, row - 1) for row in range(2000)]
    corners = [{"x": 0.5, "y": 0.5}, {"x": 1999.5, "y": 1999.5}]
    forth, back = math.pi / 4, -3 * math.pi / 4
    poses = [{**corners[at], "theta": theta} for at, theta in ((0, forth), (1, forth), (1, back), (0, back))]
    times = [i // 2 * 2830.0 + i % 2 * 2828.0 for i in range(legs + 1)]  # a little slower than it can
    actions = [{"type": ("translate", "rotate")[i % 2], "t_start": times[i], "t_end": times[i + 1],
                "from": poses[i % 4], "to": poses[(i + 1) % 4]} for i in range(legs)]
    return {"map": {"rows": rows}, "robots": [{"id": "a", "start": poses[0]}], "robot_defaults": ROBOT,
            "plans": [{"robot": "a", "cost": times[-1], "actions": actions}]}


def robots_that_start_near_each_other(defaults, options, spacing):
    """2000 robots; goals far enough apart for any of them."""
    robots = [{"id": f"r{i}", "start": start, "goal": goal}
              for i, (start, goal) in enumerate(zip(grid(50, 2000, spacing), grid(50, 2000, 11.0)))]
    return {"map": {"rows": ["." * 560] * 450}, "robots": robots, "robot_defaults": {**ROBOT, **defaults},
            "options": {"time_budget_ms": 20_000, **options}}


def huge_disk():
    """One robot of nearly half the size of 4000 x 4000 cells."""
    return {"map": {"rows": ["." * 4000] * 4000}, "robot_defaults": {**ROBOT, "radius": 1900.0},
            "robots": [{"id": "a", "start": {"x": 1950.0, "y": 2000.0}, "goal": {"x": 2050.0, "y": 2000.0}}],
            "options": {"time_budget_ms": 1000}}


def blocked_stars(outer):
    """1000 blocked stars of 20 corners on 2000 x 2000 cells; near the middle if they are large."""
    def star(k):
        spread = 950 if outer < 100 else 50
        x, y = 1000 + spread * math.sin(7.0 * k), 1000 + spread * math.sin(11.0 * k + 1.0)
        radii = [outer if i % 2 else 5.0 for i in range(20)]
        return [{"x": round(x + r * math.cos(0.1 * math.pi * i + k), 3), "y": round(y + r * math.sin(0.1 * math.pi * i + k), 3)}
                for i, r in enumerate(radii)]
    zones = [{"id": f"z{k}", "type": "blocked", "polygon": star(k)} for k in range(1000)]
    return {"map": {"rows": ["." * 2000] * 2000}, "robot_defaults": ROBOT, "zones": zones,
            "robots": [{"id": "a", "start": {"x": 1.0, "y": 1.0}, "goal": {"x": 1998.0, "y": 1998.0}}],
            "options": {"time_budget_ms": 1000}}


def isolated_dots(radius, far):
    """A blocked cell in every second column and row of 2000 x 2000."""
    rows = ["#." * 1000 if row % 2 == 0 else "." * 2000 for row in range(2000)]
    return {"map": {"rows": rows}, "robot_defaults": {**ROBOT, "radius": radius},
            "robots": [{"id": "a", "start": {"x": 1.5, "y": 0.5}, "goal": {"x": 1.5 + far, "y": 0.5 + far}}],
            "options": {"time_budget_ms": 300}}


def many_goals(places):
    """One robot with 20,000 goals; `places`: of each."""
    goals = [{"x": x, "y": y} for x, y in map(places, range(20_000))]
    return {"map": {"rows": ["." * 100] * 100}, "robot_defaults": ROBOT,
            "robots": [{"id": "a", "start": {"x": 0.5, "y": 0.5}, "goals": goals}], "options": {"time_budget_ms": 100}}


def mask_of_many_parts():
    """A mask for 2000 robots with a speed each, on 2000 x 2000 cells, and `/v1/advance`."""
    pixels = b"".join(bytes(255 * ((column // 29 + row // 29) % 2) for column in range(2000)) for row in (0, 29))
    rows = b"".join(pixels[2000 * (row // 29 % 2):][:2000] for row in range(2000))
    pgm = base64.b64encode(b"P5 2000 2000 255\n" + rows).decode()
    robots = [{"id": f"r{i}", "start": place, "linear_speed": 1.0 + i / 1000} for i, place in enumerate(grid(45, 2000, 44.0))]
    request_of_fleet = {"map": {"rows": ["." * 2000] * 2000}, "robots": robots, "robot_defaults": ROBOT,
                        "zones": [{"id": "m", "type": "speed", "mask": {"pgm": pgm, "mode": "scale"}}],
                        "options": {"time_budget_ms": 500}}
    plans = [{"robot": robot["id"], "cost": 0.0, "actions": []} for robot in robots]
    return {"request": request_of_fleet, "plans": plans, "at": 0.5}


def rough_way(**more):
    """One action with 300,000 bends and 30,000 stops."""
    here, there = {"x": 5, "y": 5, "theta": 0}, {"x": 3005, "y": 5, "theta": 0}
    action = {"type": "translate", "t_start": 0, "t_end": 3000, "from": here, "to": there}
    return {"map": {"rows": ["." * 310], "resolution": 10}, "robots": [{"id": "a", "start": here}], "robot_defaults": ROBOT,
            "plans": [{"robot": "a", "actions": [action]}], "policy": "open_loop", "runs": 1,
            "disturbance": {"stops": {"rate_per_hour": 36000, "mean_s": 0.001},
                            "cross_track": {"sigma": 0.01, "correlation_length": 0.01}}, **more}


def simulated_long_plan(legs):
    """`long_plan`, executed."""
    return {**long_plan(legs), "policy": "open_loop", "runs": 10, "options": {"time_budget_ms": 500},
            "disturbance": {"speed": {"min": 0.8, "max": 1}}}


def neighbours(legs, length, as_committed=False, **options):
    """Two robots that go to and fro beside each other."""
    robots, plans = [], []
    for name, y in (("a", 1.0), ("b", 2.0)):
        ends = [{"x": 1.0, "y": y, "theta": 0}, {"x": 1.0 + length, "y": y, "theta": 0}]
        actions = [{"type": "translate", "t_start": 1.01 * length * k, "t_end": 1.01 * length * (k + 1), "from": ends[k % 2],
                    "to": ends[1 - k % 2], "reverse": k % 2 == 1} for k in range(legs)]
        robots.append({"id": name, "start": ends[0], "may_reverse": True})
        plans.append({"robot": name, "actions": actions})
        if as_committed:
            robots[-1]["committed"] = actions
    body = {"map": {"rows": ["." * (length + 3)] * 4}, "robots": robots, "robot_defaults": ROBOT,
            "options": options}
    return body if as_committed else {**body, "plans": plans}


def many_equal_dependencies(count):
    """Two robots in lanes of their own, of which one waits for the other, as often as a body has room."""
    body = neighbours(1, 8)
    dependency = {"gate": {"robot": "a", "action": 0, "progress": 0.5}, "until": {"robot": "b", "action": 0, "progress": 0.1}}
    return {**body, "policy": "dependencies", "runs": 1, "dependencies": [dependency] * count, "options": {"time_budget_ms": 500}}


def committed_moves_that_meet(pairs, legs):
    """Pairs of robots that go to and fro towards each other, and meet at each leg."""
    robots = []
    for k in range(2 * pairs):
        x, y, way = 4.0 * (k // 2 % 45) + 1.0, 2.0 * (k // 90) + 1.0, 1.0
        if k % 2 == 1:
            x, way = x + 2.5, -1.3
        ends = [{"x": x, "y": y, "theta": 0}, {"x": x + way, "y": y, "theta": 0}]
        robots.append({"id": f"r{k}", "start": ends[0], "may_reverse": True, "committed": [
            {"type": "translate", "t_start": 2 * leg, "t_end": 2 * leg + 2, "from": ends[leg % 2], "to": ends[1 - leg % 2],
             "reverse": (leg + k) % 2 == 1} for leg in range(legs)]})
    return {"map": {"rows": ["." * 190] * (2 * (pairs // 45) + 4)}, "robots": robots, "robot_defaults": ROBOT,
            "options": {"time_budget_ms": 1000}}


def crowd(side, count, budget_ms):
    """Robots at random in a free hall, which need a plan whatever the time."""
    cells, chosen = [(x + 0.5, y + 0.5) for x in range(side) for y in range(side)], random.Random(2)
    ways = zip(chosen.sample(cells, count), chosen.sample(cells, count))
    robots = [{"id": f"r{k}", "start": {"x": start[0], "y": start[1]}, "goal": {"x": goal[0], "y": goal[1]}}
              for k, (start, goal) in enumerate(ways)]
    return {"map": {"rows": ["." * side] * side}, "robots": robots, "robot_defaults": {**ROBOT, "radius": 0.45},
            "options": {"time_budget_ms": budget_ms}}


def many_serial_numbers(members):
    """Serial numbers of robots that do not exist, for 2000 that do."""
    return {"version": "2.1.0", "map": {"rows": ["..."]}, "robot_defaults": ROBOT, "plans": [], "dependencies": [],
            "robots": [{"id": f"r{i}", "start": {"x": i + 0.5, "y": 0.5}} for i in range(2000)],
            "manufacturer": "m", "timestamp": "2026-01-31T12:00:00.000Z",
            "serial_numbers": {f"u{i}": "x" for i in range(members)}}


def orders_of_a_long_leg(**more):
    """One action, of which an order makes as many nodes as it may."""
    start, end = {"x": 0.5, "y": 0.5, "theta": 0}, {"x": 1490.5, "y": 0.5, "theta": 0}
    return {"version": "2.1.0", "manufacturer": "m", "timestamp": "2026-01-31T12:00:00.000Z", "robot_defaults": ROBOT,
            "robots": [{"id": "a", "start": start, "goal": end}], "dependencies": [], "release_ahead": 0.1,
            "plans": [{"robot": "a", "actions": [{"type": "translate", "t_start": 0, "t_end": 1490, "from": start, "to": end}]}],
            **more}


def report_of_many_actions(count):
    """What a vehicle reports that has ended so many actions, with as many nodes to come."""
    message = {"serialNumber": "a", "orderId": "o", "orderUpdateId": 0, "lastNodeId": "n", "lastNodeSequenceId": 2,
               "nodeStates": [{"sequenceId": 4 + 2 * k} for k in range(count)],
               "actionStates": [{"actionId": f"a{k}", "actionStatus": "FINISHED"} for k in range(count)],
               "errors": [{"errorLevel": "WARNING", "errorReferences": [{"referenceKey": "orderId", "referenceValue": "o"}]}] * count,
               "agvPosition": {"x": 700.5, "y": 0.5, "theta": 0}}
    progress = {"robot": "a", "action": 0, "progress": 0, "order_id": "o", "order_update_id": 0, "last_released_sequence_id": 2}
    return orders_of_a_long_leg(messages=[message], progress=[progress])


def many_places(count, **more):
    """Poses all over a map of a million cells with a comb of walls. Each pose has a way to each other pose."""
    rows = ["." * 1000 if row % 4 else "#" * 999 + "." if row % 8 else "." + "#" * 999 for row in range(1000)]
    places = [{"x": 0.5 + 37 * k % 997, "y": 4 * (61 * k % 249) + 1.5} for k in range(count)]
    return {"map": {"rows": rows}, "options": {"time_budget_ms": 1000}, **more}, places


def travel_times(count):
    body, places = many_places(count)
    return {**body, "robot": ROBOT, "from": places, "to": places}


def travel_times_on_a_large_map():
    """500 x 500 poses on a map of 16 million cells, each column of which takes a second; the body has 55 kB."""
    body = image_map(4000, 4000)
    return {"map": body["map"], "robot": ROBOT, "from": [{"x": 2000.0 + k, "y": 2000.0} for k in range(500)],
            "to": [{"x": 10.0 + k, "y": 20.0} for k in range(500)], "options": {"time_budget_ms": 15_000}}


def many_tasks(count):
    """Tasks for one robot: as many as a body can have."""
    robots = [{"id": "a", "start": {"x": 1.5, "y": 1.5}}]
    return {"request": {"map": {"rows": ["." * 8] * 8}, "robot_defaults": ROBOT, "robots": robots,
                        "options": {"time_budget_ms": 300}},
            "tasks": [{"id": f"t{k}", "goals": [{"x": 1.5 + k % 5, "y": 4.5}]} for k in range(count)]}


def robots_that_accelerate():
    """1000 robots that cross each other's ways, with short changes of speed."""
    robots = [{"id": f"r{i}", "start": place, "goal": {"x": 128.0 - place["x"], "y": 128.0 - place["y"]}}
              for i, place in enumerate(grid(32, 1000, 4.0))]
    accelerations = {"linear_acceleration": 0.5, "linear_deceleration": 0.3, "angular_acceleration": 1.0}
    return {"map": {"rows": ["." * 128] * 128}, "robots": robots, "robot_defaults": {**ROBOT, **accelerations},
            "options": {"time_budget_ms": 1000}}


def chunk(kind, data):
    """A chunk of a PNG."""
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def image_map(columns, rows, before=b"", inside=b"", behind=b""):
    """A robot on a free map that is a PNG with more chunks `before` its header and `inside` it, and data `behind` its pixels."""
    pixels = zlib.compress((b"\0" + b"\xff" * columns) * rows + behind, 9)
    header = chunk(b"IHDR", struct.pack(">IIBBBBB", columns, rows, 8, 0, 0, 0, 0))
    png = b"\x89PNG\r\n\x1a\n" + before + header + inside + chunk(b"IDAT", pixels) + chunk(b"IEND", b"")
    robot = {"id": "a", "start": {"x": 1.5, "y": 0.5}, "goal": {"x": columns - 1.5, "y": 0.5}}
    return {"map": {"image": {"png": base64.b64encode(png).decode(), "resolution": 1.0}}, "robots": [robot],
            "robot_defaults": ROBOT, "options": {"time_budget_ms": 100}}


def goals_at_one_of_several_poses(robots, poses):
    """Each robot may be served at other poses than all others."""
    places = [{"x": 1.0 + 398.0 * (k * 0.618 % 1.0), "y": 1.0 + 398.0 * (k * 0.414 % 1.0)} for k in range(robots * poses)]
    return {"map": {"rows": ["." * 400] * 400}, "robot_defaults": ROBOT, "options": {"time_budget_ms": 1000},
            "robots": [{"id": f"r{k}", "start": start, "goal": {"any_of": places[k * poses:(k + 1) * poses]}}
                       for k, start in enumerate(grid(50, robots, 2.0))]}


def drive_of_many_parts(parts):
    """Translations that follow each other at speed, with a stop every tenth of a second."""
    def at(k):
        return {"x": 5.0 + 3000.0 * k / parts, "y": 5.0, "theta": 0.0}
    # At 1 m/s after a metre, as the robot reaches it at 0.5 m/s per second; it stops within the last metre.
    accelerates = {"linear_acceleration": 0.5, "linear_deceleration": 0.5}
    corners = [at(0), {**at(0), "x": 6.0}, *(at(k) for k in range(1, parts) if 6.0 < at(k)["x"] < 3004.0),
               {**at(0), "x": 3004.0}, at(parts)]
    actions, now = [], 0.0
    for k, (here, there) in enumerate(zip(corners, corners[1:])):
        start, end = float(k > 0), float(k + 2 < len(corners))
        later = now + (there["x"] - here["x"]) * 2.0 / (start + end)
        actions.append({"type": "translate", "t_start": now, "t_end": later, "from": here, "to": there,
                        "profile": {"start": start, "cruise": 1.0, "end": end}})
        now = later
    return {"map": {"rows": ["." * 310], "resolution": 10}, "robots": [{"id": "a", "start": at(0), **accelerates}],
            "robot_defaults": ROBOT, "plans": [{"robot": "a", "actions": actions}], "policy": "open_loop", "runs": 100,
            "options": {"time_budget_ms": 500}, "disturbance": {"stops": {"rate_per_hour": 36000, "mean_s": 0.001}}}


def costly_requests():
    lying = chunk(b"juNk", struct.pack(">II", 2000, 1))
    texts = chunk(b"zTXt", b"k\0\0" + zlib.compress(bytes(3 * MIB), 9)) * 1000
    empty_objects = b'{"robots": [' + b",".join([b"{}"] * (14 * MIB // 3)) + b"]}"
    empty_strings = b'{"robots": [' + b",".join([b'""'] * (14 * MIB // 3)) + b"]}"
    members = b"{" + b",".join(b'"%d":0' % i for i in range(2_700_000)) + b"}"
    return [
        Costly("2000 ids of 256 characters", posted(crowd_with_long_ids()), 5.0, 512,
               planned(["none"], ["start_blocked", "goal_blocked", "budget_exhausted"])),
        Costly("a blocked door far away", posted(blocked_door()), 0.5, 200,
               planned(["partial"], ["blocked_by_robots"], ["door"])),
        Costly("10 x 14 MiB of {}", posted(empty_objects), 10.0, 1024,
               refused("invalid_request", "parse_unfinished", "memory_exceeded", "overloaded"), copies=10),
        Costly('10 x 14 MiB of ""', posted(empty_strings), 10.0, 1024,
               refused("invalid_request", "parse_unfinished", "memory_exceeded", "overloaded"), copies=10),
        Costly("2,700,000 unknown members", posted(members), 1.5, 768,
               refused("invalid_request", "parse_unfinished", "memory_exceeded")),
        Costly("a chain of 2000 goals", posted(chain()), 0.2, 300,
               planned(["solved", "partial", "none"], ["blocked_by_robots", "goal_blocked", "budget_exhausted"])),
        Costly("check of 40,000 legs", posted(long_plan(40_000), "/v1/validate"), 5.0, 300, valid_or_unfinished),
        Costly("a check behind long plans", posted(long_plan(8), "/v1/validate"), 5.0, 300, valid,
               before=lambda: posted(endless(30_000))),
        *(Costly(f"a small plan behind {name}", posted(crowd(40, 100, 5000)), 2.0, 600, planned(["solved"]),
                 before=lambda data=data: data)
          for name, data in (("large ones", posted(crowd(60, 2000, 15_000))),
                             ("matrices", posted(travel_times_on_a_large_map(), "/v1/matrix")))),
        Costly("giants on a blocked map", posted(giants_on_a_blocked_map()), 1.0, 300,
               refused("invalid_request", "parse_unfinished")),
        *(Costly(f"2000 robots, 4 M cells, {budget_ms} ms", posted(crowd_on_a_large_map(budget_ms)), budget_ms / 1000,
                 600, planned(["solved", "partial", "none"], ["budget_exhausted", "blocked_by_robots"]))
          for budget_ms in (500, 1000, 3000)),
        Costly("2000 near starts, vicinity", posted(robots_that_start_near_each_other({"vicinity": 5.0}, {}, 0.62)), 3.0,
               300, planned(["none"], ["start_blocked"])),
        Costly("2000 near starts, overlap", posted(robots_that_start_near_each_other({}, {"start_overlap": 1.0}, 0.01)),
               3.0, 300, planned(["none"], ["start_blocked"])),
        Costly("a disk of 1900 cells", posted(huge_disk()), 1.0, 300, planned(["none", "solved"], ["budget_exhausted"])),
        *(Costly(f"1000 blocked stars of {outer} m", posted(blocked_stars(outer)), 1.0, 300,
                 planned(["none", "solved"], ["budget_exhausted"])) for outer in (30.0, 900.0)),
        *(Costly(f"isolated dots, radius {radius}", posted(isolated_dots(radius, far)), 0.3, 300,
                 planned(["none", "solved"], ["budget_exhausted", "goal_unreachable"]))
          for radius, far in ((0.3, 1996), (0.45, 10))),
        Costly("20,000 goals", posted(many_goals(lambda k: (0.5 + 37 * k % 100, 0.5 + 61 * k % 97))), 0.1, 300,
               planned(["none"], ["budget_exhausted"])),
        Costly("20,000 goals off the lattice", posted(many_goals(lambda k: (2 + 0.0041 * k, 2 + k * 0.618 % 90))), 0.1,
               300, planned(["none"], ["budget_exhausted"])),
        Costly("a mask of many parts", posted(mask_of_many_parts(), "/v1/advance"), 0.5, 300,
               answered_or_unfinished("map")),
        Costly("300,000 bends, 30,000 stops", posted(rough_way(options={"time_budget_ms": 500}), "/v1/simulate"), 0.5, 300,
               answered_or_unfinished("runs")),
        Costly("a trace of 300,000 bends", posted(rough_way(options={"time_budget_ms": 3600}, trace=0), "/v1/simulate"), 3.6,
               300, answered_or_unfinished("runs")),
        Costly("simulation of 20,000 legs", posted(simulated_long_plan(20_000), "/v1/simulate"), 0.5, 300,
               answered_or_unfinished("runs")),
        Costly("dependencies of 60,000 legs", posted(neighbours(30_000, 8, execution_margin=0.1), "/v1/dependencies"), 5.0,
               300, answered_or_unfinished("dependencies")),
        Costly("dependencies of near legs", posted(neighbours(3000, 8, execution_margin=0.5), "/v1/dependencies"), 5.0, 300,
               answered_or_unfinished("dependencies")),
        Costly("a plan with dependencies",
               posted(neighbours(600, 2000, True, execution_margin=0.1, dependencies=True, time_budget_ms=150)), 0.15, 300,
               answered_or_unfinished("dependencies")),
        Costly("230,000 equal dependencies", posted(many_equal_dependencies(230_000), "/v1/simulate"), 0.5, 400,
               answered_or_refused("runs", "parse_unfinished", "check_unfinished")),
        Costly("200,000 committed moves", posted(committed_moves_that_meet(1000, 100)), 1.0, 500,
               refused("invalid_request", "parse_unfinished")),
        Costly("a PNG that lies about its size", posted(image_map(1, 1, before=lying)), 0.1, 200, bad_image),
        Costly("a PNG with data behind it", posted(image_map(8, 4, behind=bytes(50 * MIB))), 0.1, 200, planned(["solved"])),
        Costly("a PNG of 1000 texts", posted(image_map(8, 4, inside=texts)), 0.1, 200, planned(["solved"])),
        Costly("1,200,000 serial numbers", posted(many_serial_numbers(1_200_000), "/v1/export/vda5050"), 1.5, 300,
               refused("invalid_request", "parse_unfinished", "memory_exceeded")),
        Costly("orders of 29,800 nodes", posted(orders_of_a_long_leg(), "/v1/export/vda5050"), 1.0, 300,
               answered_or_unfinished("orders")),
        Costly("reports of 100,000 actions", posted(report_of_many_actions(100_000), "/v1/import/vda5050"), 1.5, 400,
               answered_or_unfinished("states")),
        Costly("250,000 travel times", posted(travel_times(500), "/v1/matrix"), 1.0, 400,
               answered_or_unfinished("seconds")),
        Costly("200,000 tasks", posted(many_tasks(200_000), "/v1/assign"), 1.5, 500,
               refused("invalid_request", "parse_unfinished", "check_unfinished", "memory_exceeded")),
        *(Costly(f"{robots} robots, {poses} poses each", posted(goals_at_one_of_several_poses(robots, poses)), 1.0, 600,
                 planned_or_refused("parse_unfinished", "memory_exceeded"))
          for robots, poses in ((2000, 10), (200, 100))),
        Costly("a drive of 20,000 parts", posted(drive_of_many_parts(20_000), "/v1/simulate"), 0.5, 300,
               answered_or_unfinished("runs")),
        Costly("1000 robots that accelerate", posted(robots_that_accelerate()), 1.0, 300,
               planned(["solved", "partial", "none"])),
    ]


# ---------------------------------------------------------------- measuring

@dataclasses.dataclass
class Outcome:
    milliseconds: float
    size: int
    fault: str | None


def ask(server, costly):
    connection = Connection(server.host, server.port, costly.seconds + 60)
    try:
        connection.send(costly.data)
        sent_at = time.monotonic()
        answer = connection.receive()
        return Outcome(1000 * (time.monotonic() - sent_at), len(answer.body), costly.fault(answer))
    except (Lost, OSError, ValueError, KeyError) as fault:
        return Outcome(0.0, 0, f"{type(fault).__name__} {fault}")
    finally:
        connection.close()


def ask_at_once(server, costly):
    outcomes = []
    threads = [threading.Thread(target=lambda: outcomes.append(ask(server, costly))) for _ in range(costly.copies)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return outcomes


def keep_busy(server, data):
    """Starts as many requests as there are workers; returns their connections."""
    busy = [Connection(server.host, server.port) for _ in range(server.get("/v1/limits")["workers"])]
    for connection in busy:
        connection.send(data)
    time.sleep(1.0)
    return busy


def cpu_seconds(server):
    with open(f"/proc/{server.process.pid}/stat", encoding="ascii") as stat:
        user, system = stat.read().rpartition(")")[2].split()[11:13]
    return (int(user) + int(system)) / os.sysconf("SC_CLK_TCK")


def cpu_after_leaving(server, costly, late_ms):
    """The seconds of CPU that the server uses in half a second, from `late_ms` after the client has left on."""
    connection = Connection(server.host, server.port)
    connection.send(costly.data)
    time.sleep(0.1)
    connection.close()
    time.sleep(late_ms / 1000)
    before = cpu_seconds(server)
    time.sleep(0.5)
    return cpu_seconds(server) - before


def faults_of(costly, outcomes, late_ms, peak_mib, idle_cpu):
    for outcome in outcomes:
        if outcome.fault:
            yield outcome.fault
        elif outcome.milliseconds > 1000 * costly.seconds + late_ms:
            yield f"{outcome.milliseconds:.0f} ms instead of {1000 * costly.seconds:.0f} ms"
    if peak_mib is not None and peak_mib > costly.mib:
        yield f"{peak_mib:.0f} MiB instead of {costly.mib} MiB"
    if idle_cpu is not None and idle_cpu > 0.1:
        yield f"{idle_cpu:.2f} s of CPU in half a second after the client left"


def measure_one(binary, url, costly, late_ms):
    """Prints a line of the table; returns the faults."""
    server = Server(binary, url)
    busy = keep_busy(server, costly.before()) if costly.before else []
    outcomes = ask_at_once(server, costly)
    for connection in busy:
        connection.close()
    peak_kib = server.peak_kib()
    peak_mib = peak_kib / 1024 if peak_kib else None
    idle_cpu = cpu_after_leaving(server, costly, late_ms) if binary and server.alive() else None
    faults = list(faults_of(costly, outcomes, late_ms, peak_mib, idle_cpu))
    if not server.alive():
        faults.append("the server ended")
    if code := server.end():
        faults.append(f"the server ended with {code}")
    print(f"{costly.name:30} {max(o.milliseconds for o in outcomes):9.0f} {1000 * costly.seconds:9.0f} "
          f"{max(o.size for o in outcomes) / 1024:9.0f} {peak_mib or 0:8.0f} {costly.mib:8} "
          f"{idle_cpu or 0:9.2f}  {'; '.join(sorted(set(faults))[:2]) or 'ok'}", flush=True)
    return faults


def measure(binary, url, late_ms):
    """Sends every costly request; returns the failures. `late_ms`: how much later than its time an answer may be,
    and how long work may go on after a client has left."""
    print(f"\n{'costly request':30} {'ms':>9} {'of':>9} {'KiB':>9} {'MiB':>8} {'of':>8} {'CPU after':>9}")
    failures = []
    for costly in costly_requests():
        failures += [f"{costly.name}: {fault}" for fault in measure_one(binary, url, costly, late_ms)]
    return failures
