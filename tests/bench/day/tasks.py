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
    """Goods are taken from a station to a shelf, or from a shelf to a station. Robots end where they serve the last
    goal. Robots that have nothing to do make way."""

    def __init__(self, warehouse, per_hour, seed):
        self.warehouse, self.rng, self.rate = warehouse, random.Random(seed), per_hour / 3600.0
        self.next = self.rng.expovariate(self.rate)
        self.offered, self.waiting, self.active, self.done = 0, [], {}, []

    def come(self, now, closed=()):
        """Tasks that are offered by now, at places that are not in these rectangles."""
        while self.next <= now:
            self.offered += 1
            self.waiting.append(self.draw(self.next, closed))
            self.next += self.rng.expovariate(self.rate)

    def draw(self, offered, closed):
        shelves = [place for place in self.warehouse.shelves if not is_in(place, closed)]
        places = [self.rng.choice(self.warehouse.stations), self.rng.choice(shelves)]
        self.rng.shuffle(places)
        goals, seconds = [], []
        for x, y in places:
            planned = round(self.rng.uniform(*PLANNED), 1)
            is_late = self.rng.random() < LATE[0]
            goals.append({"x": x, "y": y, "service": planned})
            seconds.append(planned * (self.rng.uniform(*LATE[1]) if is_late else 1.0))
        return Task(goals, seconds, offered)

    def begin(self, assigned, now):
        """Notes who gets which of the tasks that wait: {their numbers in `waiting`: robot}; returns these tasks."""
        begun = [self.waiting[number] for number in assigned]
        for task, robot in zip(begun, assigned.values()):
            task.robot, task.begin = robot, now
            self.active[robot] = task
        self.waiting = [task for number, task in enumerate(self.waiting) if number not in assigned]
        return begun

    def finish(self, robot, now):
        task = self.active.pop(robot)
        task.end = now
        self.done.append(task)
        return task


def is_in(place, closed):
    """Whether a place is in one of these rectangles (left, low, right, high), or near to one."""
    return any(left - NEAR < place[0] < right + NEAR and low - NEAR < place[1] < high + NEAR
               for left, low, right, high in closed)
