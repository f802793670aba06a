"""Places along the actions of one robot.

A place is whole progress: the number of actions executed, and the fraction of the one under way (of its length, angle
or time). So 2.25 is a quarter of the action with the number 2, and the number of all actions is the end.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias

from fleetplan.types import Action, ActionPlace, ActionProgress, Goal, PlanRequest, Pose, Robot, Visit

Place: TypeAlias = float

_STEERED = 0.05  # radians: a turn for which a robot under way need not stop, as plans from measured poses have them
_ROUNDED_TIME = 1e-6  # seconds: what times of a plan are off in text, at most
_TURNED = 0.25  # radians: by less, turns of the same way differ, which begins where the robot is measured
_ON_PLACE = 1e-9  # of whole progress, metres, radians or seconds: rounding


def turned(angle: float) -> float:
    """The angle in [-pi, pi]."""
    return math.remainder(angle, 2.0 * math.pi)


def whole(progress: ActionProgress | ActionPlace) -> Place:
    """The place that the service names."""
    return progress["action"] + progress["progress"]


@dataclass(frozen=True)
class Move:
    """What a robot has done: metres of a translation, radians of a rotation, or seconds of a wait."""

    type: str
    amount: float


@dataclass(frozen=True)
class Limits:
    """How fast the speed of a robot rises and falls: metres per second squared, or in turns radians. Infinite: at
    once."""

    rise: float = math.inf
    fall: float = math.inf
    turn: float = math.inf

    def of(self, action: Action) -> tuple[float, float]:
        """Rise and fall."""
        return (self.turn, self.turn) if action["type"] == "rotate" else (self.rise, self.fall)


def limits_of(request: PlanRequest, robot: Robot) -> Limits:
    """The limits of a robot of a request."""
    defaults = request.get("robot_defaults", {})
    rise = robot.get("linear_acceleration", defaults.get("linear_acceleration"))
    fall = robot.get("linear_deceleration", defaults.get("linear_deceleration", rise))
    turn = robot.get("angular_acceleration", defaults.get("angular_acceleration"))
    return Limits(*(math.inf if limit is None else limit for limit in (rise, fall, turn)))


def limits_by_action(request: PlanRequest, robot: Robot, actions: Sequence[Action],
                     visits: Sequence[Visit] | None) -> list[Limits]:
    """The limits of a robot in each of its actions. Goals change the limits at the end of their service. `visits`: the
    visits of the plan. None: the waits of the actions tell the visits."""
    limits, goals = limits_of(request, robot), goals_of(robot)
    left = _service_ends(actions) if visits is None else [
        (visit["t_leave"], visit["goal"]) for visit in visits
        if visit["t_arrive"] is not None and visit["t_leave"] is not None]
    found: list[Limits] = []
    for action in actions:
        while left and left[0][0] <= action["t_start"] + _ROUNDED_TIME:
            _, goal = left.pop(0)
            limits = _after(limits, goals[goal]) if goal < len(goals) else limits
        found.append(limits)
    return found


def _service_ends(actions: Sequence[Action]) -> list[tuple[float, int]]:
    """When services end, and at which goals."""
    return [(action["t_end"], action["goal"]) for action, after in zip(actions, [*actions[1:], None])
            if "goal" in action and (after is None or after.get("goal") != action["goal"])]


def _after(limits: Limits, goal: Goal) -> Limits:
    """The limits after a goal, of a robot that has some: a deceleration that is not given follows the acceleration."""
    rise = goal.get("linear_acceleration_after", limits.rise)
    fall = goal.get("linear_deceleration_after", goal.get("linear_acceleration_after", limits.fall))
    return Limits(rise, fall, limits.turn)


def goals_of(robot: Robot) -> list[Goal]:
    """The goals of a robot of a request, however they are given."""
    return robot["goals"] if "goals" in robot else [robot["goal"]] if "goal" in robot else []


@dataclass(frozen=True)
class _Purpose:
    """What a wait is for. The rest of it gives way to others."""

    service: float = 0.0  # seconds
    least: float = 0.0  # seconds: the service, or a wait before a move that is longer
    not_before: float = 0.0  # seconds of the plan's time: these do not begin earlier


class Course:
    """The actions of one robot."""

    def __init__(self, start: Pose, actions: Sequence[Action], goals: Sequence[Goal] = (),
                 wait_before_move: float = 0.0, limits: Sequence[Limits] = ()) -> None:
        """`goals`: the goals of the request, to which the numbers in the plan's waits refer. `limits`: the robot's
        limits, by action. Without limits, its speed changes at once."""
        self.start = start
        self._limits = limits or [Limits()] * len(actions)
        self.actions = actions
        self.end = float(len(actions))
        self._amounts = [_amount(action) for action in actions]
        self._purposes = [_purpose(actions, index, goals, wait_before_move) for index in range(len(actions))]

    def index(self, place: Place) -> int:
        """The action under way, before the end."""
        return min(int(place), len(self.actions) - 1)

    def progress(self, robot: str, place: Place) -> ActionProgress:
        """As the service names a place; at the end, the last action is done."""
        if not self.actions:
            return {"robot": robot, "action": 0, "progress": 0.0}
        index = self.index(place)
        return {"robot": robot, "action": index, "progress": min(1.0, place - index)}

    def amount(self, index: int) -> float:
        """Metres, radians or seconds. Of a wait, only the seconds that may not be skipped."""
        if self.actions[index]["type"] == "wait":
            return self._purposes[index].least
        return self._amounts[index]

    def not_before(self, index: int) -> float:
        """Seconds of the plan's time: what a wait is for does not begin earlier."""
        return self._purposes[index].not_before

    def after_service(self, place: Place, left: float) -> Place:
        """Where a robot is in its service if so much of it is left, seconds; where it is, if it is in no service."""
        index = self.index(place)
        goal, rest = self.actions[index].get("goal"), self.service_left(float(index))
        if goal is None:
            return place
        while index < len(self.actions) and self.actions[index].get("goal") == goal:
            rest -= self._purposes[index].service
            here = min(left - rest, self._purposes[index].service)
            if here > 0.0:
                return index + 1 - here / self._purposes[index].least
            index += 1
        return float(index)

    def service_left(self, place: Place) -> float:
        """Seconds that are left of the service under way, which may take several waits."""
        index = self.index(place)
        goal, left = self.actions[index].get("goal"), 0.0
        for following in range(index, len(self.actions)):
            if self.actions[following].get("goal") != goal:
                break
            share = index + 1 - place if following == index else 1.0
            left += min(self._purposes[following].service, share * self._purposes[following].least)
        return left

    def deceleration(self, index: int) -> float:
        """Metres per second squared, of the robot in an action; infinite if it stops at once."""
        return self._limits[index].fall if self._limits else math.inf

    def planned_speed(self, index: int) -> float:
        """The greatest, metres or radians per second; 0 of a wait."""
        action = self.actions[index]
        if "profile" in action:
            return action["profile"]["cruise"]
        duration = action["t_end"] - action["t_start"]
        return self._amounts[index] / duration if action["type"] != "wait" and duration > 0.0 else 0.0

    def pose(self, place: Place) -> Pose:
        if not self.actions:
            return self.start
        index = self.index(place)
        share, action = place - index, self.actions[index]
        begin, end = action["from"], action["to"]
        if share >= 1.0:
            return end
        if action["type"] == "rotate":
            theta = turned(begin["theta"] + share * turned(end["theta"] - begin["theta"]))
            return {"x": begin["x"], "y": begin["y"], "theta": theta}
        return {"x": begin["x"] + share * (end["x"] - begin["x"]), "y": begin["y"] + share * (end["y"] - begin["y"]),
                "theta": begin["theta"]}

    def begins_at_rest(self, index: int) -> bool:
        """Whether the robot stands when it begins an action."""
        return not any((self._goes_on_with(before) or 0) >= index for before in range(max(0, index - 2), index))

    def room(self, place: Place, limit: Place) -> float:
        """Metres, or radians of a rotation, from a place to where the robot has to stand, because it may not pass the
        limit. Translations in the same direction follow each other without a stop, unless a turn is steered between
        them."""
        index = self.index(place)
        room = (min(limit, index + 1) - place) * self._amounts[index]
        while (following := self._goes_on_with(index)) is not None and limit > following:
            index = following
            room += (min(limit, index + 1) - index) * self._amounts[index]
        return room

    def room_at_speed(self, place: Place, deceleration: float) -> float:
        """Metres from a place to where the robot would stand if it braked all the way. It would drive into the next
        action at the planned speed. Infinite if the next action begins at rest."""
        index = self.index(place)
        end = self.actions[index].get("profile", {"end": 0.0})["end"]
        return (index + 1 - place) * self._amounts[index] + end * end / (2.0 * deceleration) if end > 0.0 else math.inf

    def located(self, pose: Pose, place: Place, limit: Place, near: float) -> Place:
        """Where a robot is by its measured pose. `place`: where it has been. An action is done if less than `near` of
        it is left (metres; radians of a rotation), or if it is steered. In the same way, the robot is at the limit if
        it is near it. Past the limit, it is still in the same action."""
        while place < self.end and self.actions[self.index(place)]["type"] != "wait":
            index = self.index(place)
            done, amount = max(place, index + self._share(index, pose)), self._amounts[index]
            least = _STEERED if self._is_steered(index) else near
            if limit <= index + 1 and abs(limit - done) * amount <= least:
                return limit
            if limit < done or (index + 1 - done) * amount > least:
                return done
            place = index + 1.0
        return place

    def moves(self, begin: Place, end: Place) -> list[Move]:
        """What a robot does from one place to another."""
        found = []
        while begin < end - _ON_PLACE:
            index = self.index(begin)
            stop = min(end, index + 1.0)
            amount = (stop - begin) * self.amount(index)
            if amount > 0.0:
                found.append(Move(self.actions[index]["type"], amount))
            begin = stop
        return found

    def next_move(self, place: Place) -> int | None:
        """The number of the next move of a robot that is not under way with one."""
        for index in range(int(place + _ON_PLACE), len(self.actions)):
            if self.actions[index]["type"] != "wait":
                return index if place <= index + _ON_PLACE else None
        return None

    def driven(self, begin: Place, end: Place) -> float:
        """Metres from one place to another."""
        return sum(move.amount for move in self.moves(begin, end) if move.type == "translate")

    def after(self, place: Place, moves: Sequence[Move], near: float = _ON_PLACE) -> Place:
        """Where a robot is after its actions on another course that begins in the same way. One of the courses may have
        moves of less than `near`, and small turns, that the other does not have."""
        for move in moves:
            left = move.amount
            while left > _ON_PLACE and place < self.end:
                index = self.index(place)
                kind, amount = self.actions[index]["type"], self.amount(index)
                rest = (index + 1 - place) * amount
                is_small = move.type != "wait" and left <= _least(move.type, near, _TURNED)
                if kind == move.type and left < rest - _ON_PLACE:
                    place, left = place + left / amount, 0.0
                elif kind == move.type:
                    place, left = index + 1.0, left - rest
                elif is_small and self.actions[index].get("goal") is not None:
                    break  # the service has not been left for so little
                elif kind == "wait" or amount <= _least(kind, near, _STEERED if is_small else _TURNED):
                    place = index + 1.0
                elif move.type == "wait" or is_small:
                    break  # what is not on this course
                else:
                    return place  # another way
        return place

    def place_at(self, t: float) -> Place:
        """Where the plan has the robot at a time, seconds."""
        for index, action in enumerate(self.actions):
            if t < action["t_end"]:
                return index + self._share_after(index, max(0.0, t - action["t_start"]))
        return self.end

    def time_at(self, place: Place) -> float:
        """Until when the plan has the robot where it is at this place, seconds."""
        if place >= self.end - _ON_PLACE:
            return math.inf
        index = self.index(place + _ON_PLACE)
        action = self.actions[index]
        if action["type"] != "translate":
            return self.time_at(index + 1.0) if index + 1 < len(self.actions) else math.inf
        return action["t_start"] + self._seconds_until(index, place - index)

    def _share_after(self, index: int, seconds: float) -> float:
        """How much of an action is done, as planned, after so many seconds of it."""
        action, amount = self.actions[index], self._amounts[index]
        duration = action["t_end"] - action["t_start"]
        if "profile" not in action or amount <= 0.0:
            return seconds / duration
        profile = action["profile"]
        rise, fall = self._limits[index].of(action)
        rises = min(seconds, (profile["cruise"] - profile["start"]) / rise)
        falls = max(0.0, seconds - (duration - (profile["cruise"] - profile["end"]) / fall))
        covered = profile["cruise"] * max(0.0, seconds - rises - falls)
        if rises > 0.0:
            covered += rises * (profile["start"] + rise * rises / 2.0)
        if falls > 0.0:
            covered += falls * (profile["cruise"] - fall * falls / 2.0)
        return min(1.0, max(0.0, covered / amount))

    def _seconds_until(self, index: int, share: float) -> float:
        """The inverse: after how many seconds so much of an action is done, as planned."""
        action = self.actions[index]
        duration = action["t_end"] - action["t_start"]
        if share <= 0.0:  # at rest, or before it by rounding
            return 0.0
        if "profile" not in action:
            return share * duration
        profile, covered = action["profile"], share * self._amounts[index]
        rise, fall = self._limits[index].of(action)
        start, cruise, end = profile["start"], profile["cruise"], profile["end"]
        rises, falls = (cruise - start) / rise, (cruise - end) / fall
        rising, before_fall = (start + cruise) / 2.0 * rises, self._amounts[index] - (cruise + end) / 2.0 * falls
        if covered < rising:
            return 2.0 * covered / (start + math.sqrt(start * start + 2.0 * rise * covered))
        if covered <= before_fall or falls <= 0.0:
            return min(duration, rises + (covered - rising) / cruise)
        left = max(0.0, cruise * cruise - 2.0 * fall * (covered - before_fall))
        return min(duration, duration - falls + 2.0 * (covered - before_fall) / (cruise + math.sqrt(left)))

    def _share(self, index: int, pose: Pose) -> float:
        """How much of an action a robot in this pose has done."""
        action, amount = self.actions[index], self._amounts[index]
        if amount <= 0.0:
            return 1.0
        begin, end = action["from"], action["to"]
        if action["type"] == "rotate":
            return min(1.0, max(0.0, 1.0 - abs(turned(end["theta"] - pose["theta"])) / amount))
        x, y = end["x"] - begin["x"], end["y"] - begin["y"]
        along = ((pose["x"] - begin["x"]) * x + (pose["y"] - begin["y"]) * y) / (amount * amount)
        return min(1.0, max(0.0, along))

    def _goes_on_with(self, index: int) -> int | None:
        """The translation that a robot goes on with after this one without a stop."""
        following = index + 1
        if following < len(self.actions) and self._is_steered(following):
            following += 1
        if following >= len(self.actions):
            return None
        action, other = self.actions[index], self.actions[following]
        goes_on = (action["type"] == other["type"] == "translate"
                   and action.get("reverse", False) == other.get("reverse", False)
                   and abs(turned(_direction(other) - _direction(action))) <= _STEERED)
        return following if goes_on else None

    def _is_steered(self, index: int) -> bool:
        """Whether an action is a turn that a robot makes while it drives."""
        return (self.actions[index]["type"] == "rotate" and self._amounts[index] <= _STEERED
                and index + 1 < len(self.actions) and self.actions[index + 1]["type"] == "translate")


def _least(kind: str, near: float, turn: float) -> float:
    """Metres, radians or seconds: less is not noticed."""
    return max(near, turn) if kind == "rotate" else near


def _amount(action: Action) -> float:
    begin, end = action["from"], action["to"]
    if action["type"] == "translate":
        return math.hypot(end["x"] - begin["x"], end["y"] - begin["y"])
    if action["type"] == "rotate":
        return abs(turned(end["theta"] - begin["theta"]))
    return action["t_end"] - action["t_start"]


def _direction(action: Action) -> float:
    begin, end = action["from"], action["to"]
    return math.atan2(end["y"] - begin["y"], end["x"] - begin["x"])


def _purpose(actions: Sequence[Action], index: int, goals: Sequence[Goal], wait_before_move: float) -> _Purpose:
    """A service is at the end of the waits for its goal, of which there are several where a commitment has ended. At
    the end of a longer wait before a move, it counts towards that."""
    action = actions[index]
    if action["type"] != "wait":
        return _Purpose()
    planned = action["t_end"] - action["t_start"]
    service = least = not_before = 0.0
    if "goal" in action and action["goal"] < len(goals):
        goal, end = goals[action["goal"]], action["t_end"]
        for following in actions[index + 1:]:
            if following.get("goal") != action["goal"]:
                break
            end = following["t_end"]
        service = least = min(planned, max(0.0, goal.get("service", 0.0) - (end - action["t_end"])))
        not_before = min(goal.get("not_before", 0.0), action["t_end"] - least)
    precedes_move = index + 1 < len(actions) and actions[index + 1]["type"] == "translate"
    added = min(planned, wait_before_move) if precedes_move else 0.0
    if added > least:
        not_before = max(0.0, not_before - (added - least))
        least = added
    return _Purpose(service, least, not_before)
