"""Replays what robots have executed, and judges it by the contract of docs/api.md. No two disks overlap, no disk
overlaps a wall, no robot jumps or is faster than it can, and every goal is served. In continuous time, and exact
between the events."""

import collections
import math

from geometry import closest_of_paths, pose_in, to_rectangle, turned

CONTACT = 2e-6  # metres: tolerance of the check of plans and of the rounding of its times
JUMP = 1e-6  # metres, radians
SAME_TIME = 1e-6  # seconds


class Walls:
    """The blocked cells of a map and everything outside."""

    def __init__(self, map_):
        self.rows = map_["rows"]
        self.size = map_.get("resolution", 1.0)
        origin = map_.get("origin", {})
        self.x, self.y = origin.get("x", 0.0), origin.get("y", 0.0)
        self.width, self.height = len(self.rows[0]), len(self.rows)

    def blocked(self, column, row):
        """Row 0 is the bottom one."""
        return self.rows[self.height - 1 - row][column] not in ".G"

    def clearance(self, x0, y0, x1, y1, reach):
        """The distance of a segment to the nearest wall or the edge, if it is less than the reach."""
        size = self.size
        x0, x1, y0, y1 = x0 - self.x, x1 - self.x, y0 - self.y, y1 - self.y
        least = min(x0, x1, y0, y1, self.width * size - max(x0, x1), self.height * size - max(y0, y1), reach)
        columns = range(max(0, int((min(x0, x1) - reach) / size)),
                        min(self.width, int((max(x0, x1) + reach) / size) + 1))
        for row in range(max(0, int((min(y0, y1) - reach) / size)),
                         min(self.height, int((max(y0, y1) + reach) / size) + 1)):
            for column in columns:
                if self.blocked(column, row):
                    least = min(least, to_rectangle(x0, y0, x1, y1, column * size, row * size,
                                                    (column + 1) * size, (row + 1) * size))
        return least


class Visits:
    """The goals of a robot and which of them it has served, from its rests."""

    def __init__(self, goals):
        self.goals = collections.deque(dict(goal, done=0.0) for goal in goals)

    def rests(self, pose, begin, end):
        """The robot has been at rest in this pose. A service that was broken off goes on: /v1/advance keeps what is
        left of it."""
        while self.goals:
            goal = self.goals[0]
            if math.hypot(goal["x"] - pose[0], goal["y"] - pose[1]) > JUMP:
                return
            if "theta" in goal and abs(turned(goal["theta"] - pose[2])) > JUMP:
                return
            left = goal.get("service", 0.0) - goal["done"]
            if left > end - begin + SAME_TIME:
                goal["done"] += end - begin
                return
            begin = min(end, begin + left)
            self.goals.popleft()


class Replay:
    """Collects the executed motion of a fleet, round after round."""

    def __init__(self, request, noise=0.0):
        """`noise`: how far robots leave their path while they drive, metres. Then their headings are not compared."""
        self.walls, self.noise = Walls(request["map"]), noise
        self.robots = {}
        for robot in request["robots"]:
            traits = {**request.get("robot_defaults", {}), **robot}
            self.robots[robot["id"]] = traits
        self.poses = {r["id"]: self.pose_of(r["start"]) for r in request["robots"]}
        self.visits = {r["id"]: Visits(r.get("goals", [r["goal"]] if "goal" in r else []))
                       for r in request["robots"]}
        self.now = 0.0
        self.faults = []
        self.met = []  # robots and obstacles
        self.travelled = 0.0
        self.least_gap = math.inf

    @staticmethod
    def pose_of(pose):
        return pose["x"], pose["y"], pose.get("theta", 0.0)

    def fault(self, text):
        self.faults.append(f"t = {self.now:.3f} s: {text}")

    def give(self, robot, goals):
        self.visits[robot] = Visits(goals)

    def execute(self, actions, seconds, obstacles=()):
        """All robots execute their actions (by id; an absent robot stands) for a time."""
        paths = {robot: self.path(robot, actions.get(robot, ()), seconds) for robot in self.robots}
        self.check_walls(paths)
        self.check_pairs(paths, seconds)
        self.check_obstacles(paths, seconds, obstacles)
        self.now += seconds

    def path(self, robot, actions, seconds):
        """The segments of a robot's centre until then; moves it there."""
        pose, segments, t = self.poses[robot], [], 0.0
        traits, visits = self.robots[robot], self.visits[robot]
        for action in actions:
            if action["t_start"] >= seconds:
                break
            if abs(action["t_start"] - t) > SAME_TIME:
                self.fault(f"{robot} has no action from {t} s to {action['t_start']} s")
            begin, end = pose_in(action, action["t_start"]), pose_in(action, min(seconds, action["t_end"]))
            until = min(seconds, action["t_end"])
            turn = abs(turned(begin[2] - pose[2]))
            if math.hypot(begin[0] - pose[0], begin[1] - pose[1]) > JUMP or (turn > JUMP and not self.noise):
                self.fault(f"{robot} jumps from {pose} to {begin}")
            self.check_action(robot, traits, action)
            if action["type"] == "wait":
                visits.rests(pose, self.now + t, self.now + until)
            else:
                # At rest in the instant between two actions, not in the middle of one.
                if action["t_end"] <= seconds:
                    visits.rests(end, self.now + until, self.now + until)
            segments.append((t, until, pose[0], pose[1], end[0], end[1]))
            self.travelled += math.hypot(end[0] - pose[0], end[1] - pose[1])
            pose, t = end, until
        if t < seconds:
            segments.append((t, seconds, pose[0], pose[1], pose[0], pose[1]))
            visits.rests(pose, self.now + t, self.now + seconds)
        self.poses[robot] = pose
        return segments

    def check_action(self, robot, traits, action):
        a, b, duration = action["from"], action["to"], action["t_end"] - action["t_start"]
        length = math.hypot(b["x"] - a["x"], b["y"] - a["y"])
        turn = abs(turned(b["theta"] - a["theta"]))
        if length > traits["linear_speed"] * duration + JUMP + self.noise or turn > traits["angular_speed"] * duration + JUMP:
            self.fault(f"{robot} is too fast: {action}")
        if action["type"] == "translate":
            if turn > JUMP:
                self.fault(f"{robot} turns while it drives: {action}")
            aside = abs(math.cos(a["theta"]) * (b["y"] - a["y"]) - math.sin(a["theta"]) * (b["x"] - a["x"]))
            if aside > JUMP + self.noise:
                self.fault(f"{robot} drives {aside} m aside: {action}")
        elif length > JUMP or (action["type"] == "wait" and turn > JUMP):
            self.fault(f"{robot} moves in a {action['type']}: {action}")

    def check_walls(self, paths):
        for robot, segments in paths.items():
            radius = self.robots[robot]["radius"]
            for _, _, x0, y0, x1, y1 in segments:
                if (x0, y0) != (x1, y1) and self.walls.clearance(x0, y0, x1, y1, radius) < radius - CONTACT:
                    self.fault(f"{robot} overlaps a wall between ({x0}, {y0}) and ({x1}, {y1})")

    def check_pairs(self, paths, seconds):
        names = sorted(paths)
        for i, first in enumerate(names):
            one = self.robots[first]
            for second in names[i + 1:]:
                two = self.robots[second]
                p, q = paths[first], paths[second]
                required = one["radius"] + two["radius"]
                reach = required + (one["linear_speed"] + two["linear_speed"]) * seconds
                if abs(p[0][2] - q[0][2]) > reach or abs(p[0][3] - q[0][3]) > reach:
                    continue
                distance, t = closest_of_paths(p, q)
                self.least_gap = min(self.least_gap, distance - required)
                if distance < required - CONTACT:
                    self.fault(f"{first} and {second} overlap by {required - distance:.6f} m at +{t:.3f} s")

    def check_obstacles(self, paths, seconds, obstacles):
        for obstacle in obstacles:
            motion = [(e["t"], e["x"], e["y"]) for e in obstacle["motion"]]
            segments = [(*a[:1], b[0], *a[1:], *b[1:]) for a, b in zip(motion, motion[1:])]
            last = motion[-1]
            end = seconds if obstacle.get("after") == "stays" else last[0]
            segments.append((last[0], max(last[0], end), *last[1:], *last[1:]))
            for robot, path in paths.items():
                distance, t = closest_of_paths(path, segments)
                if distance < self.robots[robot]["radius"] + obstacle["radius"] - CONTACT:
                    self.met.append((robot, obstacle["id"], self.now + t))
