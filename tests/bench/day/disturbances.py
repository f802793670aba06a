"""What happens in a warehouse: people walk, robots are held or break down, aisles are closed, services take longer."""

import math
import random
from dataclasses import dataclass

from fleetplan import Report
from tasks import is_in
from warehouse import AISLE, AISLES, BLOCKS, WIDTH, aisle_of

HOLD, CLOSURE = 30.0, 180.0  # seconds
NOTICED = 5.0  # seconds until a breakdown is known
RENEWED = 20.0  # seconds: how long a robot that has broken down is held at a time
CLOSED_LENGTH = 6.0  # metres of an aisle
MAX_TRIES = 50  # to find an aisle that can be closed
PERSON = 0.3  # metres: radius
SEEN = 8.0  # seconds: how far ahead the way of a person is known
PATIENCE = 3.0  # seconds until a person who is hindered turns round
TRAPPED = 10.0  # seconds until one who is hindered all the time steps aside, and walks on elsewhere
CLEAR, TOO_NEAR = 0.4, 0.15  # metres: what people keep from robots, and where robots stop
BRAKES = 1.0  # metres per second squared
CROSSINGS = (3.0, WIDTH / 2.0, WIDTH - 3.0)  # metres: where people walk from aisle to aisle


@dataclass(frozen=True)
class Rates:
    """How often something happens in an hour, to the whole fleet."""

    holds: float = 20.0
    breakdowns: float = 6.0
    closures: float = 6.0
    repair: float = 180.0  # seconds until a robot that has broken down goes on, on average
    people: int = 6  # how many walk all the time


class Services:
    """Services that take longer than planned: the robots tell how much is left."""

    @staticmethod
    def reports(fleet, instructions, tasks, seconds):
        """What robots report after `seconds` of these instructions."""
        reports = {report.robot: report for report in fleet.reports()}
        for instruction in instructions:
            robot, task = instruction.robot, tasks.active.get(instruction.robot)
            if task is None or instruction.goal is None or not task.is_at_next(fleet.pose(robot)):
                continue
            measured, left = reports[robot], task.serve(seconds)
            reports[robot] = Report(robot, pose=measured.pose, speed=measured.speed, service_left=left)
        return list(reports.values())


class Person:
    """Walks along aisles and crossings, and stops before robots."""

    def __init__(self, number, rng):
        self.id, self.rng, self.speed = f"person-{number}", rng, rng.uniform(0.7, 1.3)
        self.x, self.row = rng.choice(CROSSINGS), rng.randrange(AISLES)
        self.y, self.along = self.lane(), True
        self.target, self.hindered, self.trapped, self.robots = (self.x, self.y), 0.0, 0.0, ()

    def lane(self):
        return aisle_of(self.row) + 0.8 * AISLE

    def walk(self, seconds, robots):
        """`robots`: (x, y, radius)."""
        self.robots = robots
        if (self.x, self.y) == self.target:
            self.choose()
        x, y = self.after(seconds)
        if self.is_hindered_at(x, y):
            self.hindered += seconds
            self.trapped += seconds
            if self.trapped > TRAPPED:
                self.step_aside()
            elif self.hindered > PATIENCE:
                self.choose()
                self.hindered = 0.0
            return
        self.x, self.y, self.hindered = x, y, 0.0
        self.trapped = max(0.0, self.trapped - seconds)

    def step_aside(self):
        for _ in range(MAX_TRIES):
            self.x, self.row = self.rng.choice(CROSSINGS), self.rng.randrange(AISLES)
            self.y, self.along, self.hindered, self.trapped = self.lane(), True, 0.0, 0.0
            self.target = self.x, self.y
            if all(math.hypot(self.x - x, self.y - y) > radius + PERSON + 1.0 for x, y, radius in self.robots):
                return

    def after(self, seconds):
        """Where the person is then, if nothing is in the way."""
        away = math.hypot(self.target[0] - self.x, self.target[1] - self.y)
        share = min(1.0, self.speed * seconds / away) if away > 0.0 else 1.0
        return self.x + share * (self.target[0] - self.x), self.y + share * (self.target[1] - self.y)

    def is_hindered_at(self, x, y):
        """Whether that is nearer to a robot than the person is and wants to be."""
        return any(math.hypot(x - rx, y - ry) < min(radius + PERSON + CLEAR, math.hypot(self.x - rx, self.y - ry))
                   for rx, ry, radius in self.robots)

    def choose(self):
        """Another crossing along the aisle, or another aisle along the crossing."""
        at_crossing = min(CROSSINGS, key=lambda x: abs(x - self.x))
        if self.along or self.x != at_crossing:
            self.target, self.along = (self.rng.choice(CROSSINGS), self.y), False
        else:
            self.row, self.along = self.rng.randrange(AISLES), True
            self.target = (self.x, self.lane())

    def obstacle(self):
        """Goes on until the next robot, as far as that is known."""
        t = 0.0
        while self.hindered == 0.0 and t < SEEN and not self.is_hindered_at(*self.after(t + SEEN / 16.0)):
            t += SEEN / 16.0
        x, y = self.after(t)
        motion = [{"t": 0.0, "x": self.x, "y": self.y}, {"t": max(t, SEEN / 16.0), "x": x, "y": y}]
        return {"id": self.id, "radius": PERSON, "motion": motion, "after": "leaves"}


class Moments:
    """Random moments."""

    def __init__(self, rng, per_hour):
        self.rng, self.rate = rng, per_hour / 3600.0
        self.next = rng.expovariate(self.rate) if per_hour > 0.0 else math.inf

    def has_come(self, now):
        if now < self.next:
            return False
        self.next = now + self.rng.expovariate(self.rate)
        return True


class Disturbances:
    def __init__(self, rates, seed):
        self.rng, self.repair = random.Random(seed), rates.repair
        self.people = [Person(number, self.rng) for number in range(rates.people)]
        self.holds, self.breakdowns, self.closures = (
            Moments(self.rng, rate) for rate in (rates.holds, rates.breakdowns, rates.closures))
        self.closed = []  # (until, rectangle)
        self.broken = {}  # robot: (since, until, held until)
        self.held = {}  # robot: until
        self.near = set()  # pairs of a robot that had to stop and a person
        self.count = {"holds": 0, "breakdowns": 0, "closures": 0}

    def happen(self, now, seconds, fleet, loop, tasks, radii, speeds):
        """What happens within so many seconds."""
        robots = [(pose["x"], pose["y"], radii[name]) for name in radii for pose in [fleet.pose(name)]]
        for person in self.people:
            person.walk(seconds, robots)
        self.stop_before_people(fleet, radii, speeds)
        free = [robot for robot in tasks.active if robot not in self.broken and robot not in self.held]
        if self.holds.has_come(now) and free:
            robot = self.rng.choice(free)
            self.held[robot] = now + HOLD
            loop.hold(robot, HOLD)
            self.count["holds"] += 1
        if self.breakdowns.has_come(now) and free:
            self.break_down(self.rng.choice(free), now, fleet)
        if self.closures.has_come(now):
            self.close(now, robots, tasks)
        self.renew(now, loop)

    def standing(self):
        """Robots that cannot go on, whatever the plan is."""
        return {*self.broken, *self.held}

    def closed_rectangles(self):
        return [rectangle for _, rectangle in self.closed]

    def change(self, request):
        """Adds people and closed aisles to a request."""
        request["obstacles"] = [person.obstacle() for person in self.people]
        request["zones"] = [{"id": f"closed-{k}", "type": "blocked", "polygon": corners_of(rectangle)}
                            for k, rectangle in enumerate(self.closed_rectangles())]

    def stop_before_people(self, fleet, radii, speeds):
        """Robots stop for who is right before them."""
        for person in self.people:
            for robot, radius in radii.items():
                pose = fleet.pose(robot)
                x, y = person.x - pose["x"], person.y - pose["y"]
                gap = math.hypot(x, y) - radius - PERSON
                is_ahead = x * math.cos(pose["theta"]) + y * math.sin(pose["theta"]) > 0.0
                if is_ahead and speeds[robot] > 0.0 and gap < TOO_NEAR + speeds[robot] ** 2 / (2.0 * BRAKES):
                    fleet.stop(robot, 0.5)
                    self.near.add((robot, person.id))

    def break_down(self, robot, now, fleet):
        seconds = self.rng.uniform(0.5, 1.5) * self.repair
        fleet.stop(robot, seconds)
        self.broken[robot] = now, now + seconds, now
        self.count["breakdowns"] += 1

    def close(self, now, robots, tasks):
        """A part of an aisle, where no robot is or goes."""
        places = [(x, y) for x, y, _ in robots]
        places += [(goal["x"], goal["y"]) for task in [*tasks.waiting, *tasks.active.values()] for goal in task.goals]
        for _ in range(MAX_TRIES):
            begin, end = self.rng.choice(BLOCKS)
            low, left = aisle_of(self.rng.randrange(AISLES)), self.rng.uniform(begin, end - CLOSED_LENGTH)
            rectangle = left, low, left + CLOSED_LENGTH, low + AISLE
            if not any(is_in(place, [rectangle]) for place in places):
                self.closed.append((now + CLOSURE, rectangle))
                self.count["closures"] += 1
                return

    def renew(self, now, loop):
        """Holds robots that have broken down, as soon as that is known, and lets others go on."""
        self.closed = [(until, rectangle) for until, rectangle in self.closed if until > now]
        self.held = {robot: until for robot, until in self.held.items() if until > now}
        for robot, (since, until, held_until) in list(self.broken.items()):
            if now >= until:
                del self.broken[robot]
            elif now >= since + NOTICED and now + 2.0 >= held_until:
                loop.hold(robot, RENEWED)
                self.broken[robot] = since, until, now + RENEWED


def corners_of(rectangle):
    left, low, right, high = rectangle
    return [{"x": x, "y": y} for x, y in ((left, low), (right, low), (right, high), (left, high))]
