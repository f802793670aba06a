"""Tasks that come at random moments, and the robots that get them."""

import math
import random
from dataclasses import dataclass, field

PLANNED = (4.0, 12.0)  # seconds: a service
AT_PLACE = 0.05  # metres
NEAR = 2.0  # metres: to a rectangle that is closed
LATE = 0.4, (1.2, 2.5)  # the share of services that take longer than planned, and how many times as long


@dataclass
class Task:
    goals: list  # as given to the loop, with the planned services
    seconds: list  # that the services really take
    offered: float
    robot: str = ""
    begin: float = 0.0
    end: float = 0.0
    alone: float = 0.0  # seconds that it would take the robot alone
    left: list = field(init=False)  # seconds of the services that are left

    def __post_init__(self):
        self.left = list(self.seconds)

    def is_at_next(self, pose):
        """Whether a robot is at the goal that is served next."""
        if not self.left:
            return False
        goal = self.goals[len(self.goals) - len(self.left)]
        return math.hypot(goal["x"] - pose["x"], goal["y"] - pose["y"]) < AT_PLACE

    def serve(self, seconds):
        """Goes on with that service; returns what is left of it. Less than a step is nothing."""
        self.left[0] -= seconds
        if self.left[0] >= seconds:
            return self.left[0]
        self.left.pop(0)
        return 0.0


class Tasks:
    """Goods are taken from a station to a shelf, or from a shelf to a station. A robot ends beside a shelf, or in a
    waiting place, where no other one ends."""

    def __init__(self, warehouse, request, per_hour, seed):
        self.warehouse, self.rng, self.rate = warehouse, random.Random(seed), per_hour / 3600.0
        self.rests = {robot["id"]: (robot["start"]["x"], robot["start"]["y"]) for robot in request["robots"]}
        self.next = self.rng.expovariate(self.rate)
        self.offered, self.waiting, self.active, self.done = 0, [], {}, []

    def come(self, now):
        while self.next <= now:
            self.offered += 1
            self.waiting.append(self.next)
            self.next += self.rng.expovariate(self.rate)

    def assign(self, idle, poses, now, closed=()):
        """Gives the tasks that wait to the nearest robots that are idle; returns these tasks."""
        free = [robot for robot in idle if robot not in self.active]
        begun = []
        while self.waiting and free:
            first, last, via = self.draw(closed)
            robot = min(free, key=lambda name: math.hypot(poses[name]["x"] - first[0], poses[name]["y"] - first[1]))
            free.remove(robot)
            goals, seconds = [], []
            for x, y in via + [last]:
                planned = 0.0 if (x, y) in self.warehouse.waiting else round(self.rng.uniform(*PLANNED), 1)
                is_late = self.rng.random() < LATE[0]
                goals.append({"x": x, "y": y, "service": planned})
                seconds.append(planned * (self.rng.uniform(*LATE[1]) if is_late else 1.0))
            task = Task(goals, seconds, self.waiting.pop(0), robot, now)
            self.rests[robot] = last
            self.active[robot] = task
            begun.append(task)
        return begun

    def draw(self, closed):
        """The first goal, the last one, and all before the last one."""
        def free(places):
            taken = set(self.rests.values())
            return self.rng.choice([place for place in places if place not in taken and not is_in(place, closed)])
        station = self.rng.choice(self.warehouse.stations)
        shelf = free(self.warehouse.shelves)
        if self.rng.random() < 0.5:
            return station, shelf, [station]
        return shelf, free(self.warehouse.waiting), [shelf, station]

    def finish(self, robot, now):
        task = self.active.pop(robot)
        task.end = now
        self.done.append(task)
        return task


def is_in(place, closed):
    """Whether a place is in one of these rectangles (left, low, right, high), or near to one."""
    return any(left - NEAR < place[0] < right + NEAR and low - NEAR < place[1] < high + NEAR
               for left, low, right, high in closed)
