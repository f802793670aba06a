"""Judges a day by what its robots have really driven, in continuous time: overlaps, services, waiting. It knows the map,
the radii and the tasks, and nothing of plans."""

import itertools
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "motion"))

from geometry import closest_of_paths  # noqa: E402
from replay import Walls  # noqa: E402

CONTACT = 1e-5  # metres: rounding
AT_PLACE = 0.1  # metres from a goal: at it
BUCKET = 2.0  # metres: more than two radii and what robots drive in a step
SERVICE_ROUNDING = 0.15  # seconds: steps of the simulation


def path_of(legs):
    """Contiguous segments; a robot that arrives within a step of the simulation stands until the next one."""
    path = []
    for leg in legs:
        line = leg.begin["x"], leg.begin["y"], leg.end["x"], leg.end["y"]
        if path and path[-1][1] < leg.t_start:
            path.append((path[-1][1], leg.t_start, *line[:2], *line[:2]))
        path.append((leg.t_start, leg.t_end, *line))
    return path


class Service:
    """The services of a task, by where a robot stands."""

    def __init__(self, goals, seconds):
        self.left = [(goal["x"], goal["y"], needed) for goal, needed in zip(goals, seconds)]

    def stands(self, x, y, seconds):
        """Whether that serves the next goal. A service that was broken off goes on."""
        if not self.left or math.hypot(self.left[0][0] - x, self.left[0][1] - y) > AT_PLACE:
            return False
        goal_x, goal_y, needed = self.left[0]
        self.left[0] = goal_x, goal_y, needed - seconds
        if self.left[0][2] <= SERVICE_ROUNDING:
            self.left.pop(0)
        return True


class Watch:
    def __init__(self, request):
        self.walls = Walls(request["map"])
        self.radii = {robot["id"]: robot["radius"] for robot in request["robots"]}
        self.overlaps = {}  # by pair of robots, or of a robot and "wall": the deepest, metres
        self.services = {}  # by robot, of its task
        self.busy = self.waited = 0.0  # seconds of robots with a task, and of these in which they stood and were not served
        self.waits = {robot: 0.0 for robot in self.radii}  # seconds, of the wait under way
        self.longest_waits = {robot: 0.0 for robot in self.radii}

    def begin(self, robot, goals, seconds):
        self.services[robot] = Service(goals, seconds)

    def end(self, robot, pose):
        """Ends the task of a robot in this pose; returns the goals that it has not served."""
        service = self.services.pop(robot)
        service.stands(pose["x"], pose["y"], 0.0)
        return service.left

    def look(self, fleet, standing=()):
        """Looks at what the robots have done since the last look. `standing`: the robots that could not go on."""
        paths = {robot: path_of(legs) for robot, legs in fleet.legs.items() if legs}
        for robot, legs in fleet.legs.items():
            self.account(robot, legs, robot in standing)
            legs.clear()
        self.check_walls(paths)
        self.check_pairs(paths)

    def account(self, robot, legs, must_stand):
        if robot not in self.services:
            self.waits[robot] = 0.0
            return
        for leg in legs:
            seconds = leg.t_end - leg.t_start
            self.busy += seconds
            stands = leg.begin == leg.end
            is_served = stands and self.services[robot].stands(leg.end["x"], leg.end["y"], seconds)
            if stands and not is_served and not must_stand:
                self.waited += seconds
                self.waits[robot] += seconds
                self.longest_waits[robot] = max(self.longest_waits[robot], self.waits[robot])
            else:
                self.waits[robot] = 0.0

    def starved(self, seconds):
        """The robots that have waited for longer without a break."""
        return [robot for robot, longest in self.longest_waits.items() if longest > seconds]

    def check_walls(self, paths):
        for robot, path in paths.items():
            radius = self.radii[robot]
            for _, _, *line in path:
                if line[:2] != line[2:] and self.walls.clearance(*line, radius) < radius - CONTACT:
                    self.overlap((robot, "wall"), radius - self.walls.clearance(*line, radius))

    def check_pairs(self, paths):
        buckets = {}
        for robot, path in paths.items():
            buckets.setdefault((int(path[0][2] // BUCKET), int(path[0][3] // BUCKET)), []).append(robot)
        for (column, row), here in buckets.items():
            others = [robot for step in ((1, 0), (-1, 1), (0, 1), (1, 1))
                      for robot in buckets.get((column + step[0], row + step[1]), ())]
            for first, second in itertools.chain(itertools.combinations(here, 2), itertools.product(here, others)):
                distance, _ = closest_of_paths(paths[first], paths[second])
                depth = self.radii[first] + self.radii[second] - distance
                if depth > CONTACT:
                    self.overlap((first, second), depth)

    def overlap(self, pair, depth):
        self.overlaps[pair] = max(depth, self.overlaps.get(pair, 0.0))
