"""The executor: gates, waits, services, braking, poses and new plans, by hand and with robots that are late."""

import json
import math
import random
import unittest

from support import PROJECT, met, service

from fleetplan import Client, Executor, Report
from fleetplan.course import Course, Limits, Move, limits_by_action
from fleetplan.simulation import SimulatedFleet


def pose(x, y=0.0, theta=0.0):
    return {"x": x, "y": y, "theta": theta}


def actions(*steps):
    """Actions from the origin: ("translate", metres), ("rotate", radians) or ("wait", seconds[, goal]), at 1 m/s and
    1 rad/s."""
    made, here, now = [], pose(0.0), 0.0
    for kind, amount, *goal in steps:
        there = dict(here)
        if kind == "translate":
            there["x"] += amount * math.cos(here["theta"])
            there["y"] += amount * math.sin(here["theta"])
        elif kind == "rotate":
            there["theta"] += amount
        made.append({"type": kind, "t_start": now, "t_end": now + abs(amount), "from": here, "to": there})
        if goal:
            made[-1]["goal"] = goal[0]
        here, now = there, now + abs(amount)
    return made


def planned(plans, dependencies=(), goals=None, options=None):
    """A request and its answer. The dependencies are (robot, action, progress, robot, action, progress)."""
    request = {"robots": [{"id": robot, "start": pose(0.0), "goals": (goals or {}).get(robot, [])} for robot in plans],
               "options": options or {}}
    answer = {"plans": [{"robot": robot, "actions": list_} for robot, list_ in plans.items()], "unplanned": [],
              "dependencies": [{"gate": dict(zip(("robot", "action", "progress"), one[:3])),
                                "until": dict(zip(("robot", "action", "progress"), one[3:]))} for one in dependencies]}
    return request, answer


class ByHand(unittest.TestCase):
    def executor(self, plans, dependencies=(), goals=None, options=None, **how):
        return Executor(*planned(plans, dependencies, goals, options), 0.0, **how)

    def instruction(self, executor, robot="a", now=0.0):
        return next(one for one in executor.instructions(now) if one.robot == robot)

    def test_a_robot_goes_along_its_actions_in_order(self):
        executor = self.executor({"a": actions(("translate", 2.0), ("rotate", 1.0), ("translate", 1.0))})
        first = self.instruction(executor)
        self.assertEqual((first.type, first.target, first.speed, first.room), ("translate", pose(2.0), 1.0, 2.0))
        executor.report(Report("a", pose(1.0)), 1.0)
        self.assertEqual(executor.progress("a"), {"robot": "a", "action": 0, "progress": 0.5})
        executor.report(Report("a", pose(1.995)), 2.0)
        second = self.instruction(executor, now=2.0)
        self.assertEqual((second.type, second.action, second.target["theta"]), ("rotate", 1, 1.0))
        executor.report(Report("a", pose(2.0, 0.0, 0.25)), 2.5)
        self.assertAlmostEqual(executor.progress("a")["progress"], 0.25)
        executor.report(Report("a", action=2, progress=1.0, plan=1), 5.0)
        self.assertTrue(executor.finished)
        self.assertEqual(self.instruction(executor, now=5.0).speed, 0.0)

    def test_a_gate_is_reached_and_not_passed_before_the_other_robot_has_made_its_progress(self):
        executor = self.executor({"a": actions(("translate", 4.0)), "b": actions(("translate", 2.0), ("translate", 2.0))},
                                 [("a", 0, 0.25, "b", 0, 1.0)])
        before = self.instruction(executor)
        self.assertEqual((before.target, before.waits_for), (pose(1.0), ("b",)))
        executor.report(Report("a", pose(0.995)), 1.0)
        at_gate = self.instruction(executor, now=1.0)
        self.assertEqual((at_gate.type, at_gate.waits_for, at_gate.speed), ("wait", ("b",), 0.0))
        executor.report(Report("b", action=0, progress=0.999), 1.0)
        self.assertEqual(self.instruction(executor, now=1.0).type, "wait")
        executor.report(Report("b", action=1, progress=0.0), 2.0)
        open_ = self.instruction(executor, now=2.0)
        self.assertEqual((open_.type, open_.target, open_.waits_for), ("translate", pose(4.0), ()))
        self.assertEqual(executor.overran, [])

    def test_a_robot_that_passes_a_closed_gate_is_told_to_stand_and_listed(self):
        executor = self.executor({"a": actions(("translate", 4.0)), "b": actions(("translate", 2.0))},
                                 [("a", 0, 0.25, "b", 0, 1.0)])
        executor.report(Report("a", pose(1.1)), 1.0)
        self.assertEqual(executor.overran, ["a"])
        self.assertEqual(self.instruction(executor, now=1.0).type, "wait")

    def test_a_pose_that_is_past_a_closed_gate_by_no_more_than_the_execution_margin_is_as_measured(self):
        for margins in ({"options": {"execution_margin": 0.05}}, {}):
            executor = self.executor({"a": actions(("translate", 4.0)), "b": actions(("translate", 2.0))},
                                     [("a", 0, 0.25, "b", 0, 1.0)], **margins)
            executor.report(Report("a", pose(1.04)), 1.0)
            self.assertEqual(executor.overran, [] if margins else ["a"])
            self.assertEqual(self.instruction(executor, now=1.0).type, "wait")
            executor.report(Report("a", pose(1.06)), 2.0)
            self.assertEqual(executor.overran, ["a"])

    def test_a_robot_under_way_does_not_stop_for_a_turn_that_it_steers(self):
        for turn, room in ((0.03, 3.0), (-0.03, 3.0), (0.2, 1.0)):
            executor = self.executor({"a": actions(("translate", 1.0), ("rotate", turn), ("translate", 2.0))},
                                     deceleration=1.0)
            self.assertAlmostEqual(self.instruction(executor).room, room)
        executor = self.executor({"a": actions(("translate", 1.0), ("rotate", 0.03), ("translate", 2.0))})
        executor.report(Report("a", pose(0.995)), 1.0)
        goes_on = self.instruction(executor, now=1.0)
        self.assertEqual((goes_on.type, goes_on.action), ("translate", 2))

    def test_several_robots_may_be_waited_for_at_one_gate(self):
        plans = {robot: actions(("translate", 1.0)) for robot in "abc"}
        executor = self.executor(plans, [("a", 0, 0.0, "b", 0, 1.0), ("a", 0, 0.0, "c", 0, 0.5)])
        self.assertEqual(self.instruction(executor).waits_for, ("b", "c"))
        executor.report(Report("b", action=0, progress=1.0), 1.0)
        self.assertEqual(self.instruction(executor, now=1.0).waits_for, ("c",))
        executor.report(Report("c", action=0, progress=0.5), 1.0)
        self.assertEqual(self.instruction(executor, now=1.0).type, "translate")

    def test_the_second_of_a_tight_pair_is_not_ahead_of_the_first_by_more_than_planned(self):
        request, answer = planned({"a": actions(("translate", 4.0)), "b": actions(("wait", 0.5), ("translate", 4.0))},
                                  [("b", 1, 0.5, "a", 0, 0.6)])
        answer["tight"] = [{"robots": ["a", "b"], "t": 0.7, "slack": 0.0}]
        executor = Executor(request, answer, 0.0)
        self.assertEqual(self.instruction(executor, "a").target, pose(4.0))
        self.assertEqual(self.instruction(executor, "b").waits_for, ("a",))  # its wait is as long as it takes
        executor.report(Report("a", pose(1.5)), 5.0)
        follows = self.instruction(executor, "b", 5.0)
        self.assertEqual((follows.type, follows.target, follows.waits_for), ("translate", pose(1.0), ("a",)))
        executor.report(Report("a", pose(2.8)), 6.0)  # two seconds after the least slack, gates are enough
        self.assertEqual(self.instruction(executor, "b", 6.0).target, pose(4.0))

    def test_waits_that_only_give_way_are_skipped_unless_robots_may_not_be_early(self):
        plans = {"a": actions(("wait", 5.0), ("translate", 1.0))}
        self.assertEqual(self.instruction(self.executor(plans)).type, "translate")
        on_time = self.executor(plans, early=False)
        self.assertEqual((self.instruction(on_time).type, self.instruction(on_time).seconds), ("wait", 5.0))
        self.assertEqual(self.instruction(on_time, now=5.0).type, "translate")

    def test_nobody_begins_a_move_before_its_time_unless_robots_may_be_early(self):
        executor = self.executor({"a": actions(("translate", 1.0), ("rotate", 1.0))}, early=False)
        executor.report(Report("a", action=0, progress=1.0), 0.5)
        waits = self.instruction(executor, now=0.5)
        self.assertEqual((waits.type, waits.seconds), ("wait", 0.5))
        self.assertEqual(self.instruction(executor, now=1.0).type, "rotate")

    def test_errors_of_measured_poses_do_not_begin_a_move_before_its_time(self):
        course = actions(("wait", 2.0), ("translate", 2.0))
        executor = self.executor({"a": course}, early=False)
        for now in (1.0, 2.0, 2.5):
            executor.report(Report("a", pose(0.005)), now - 0.2)
            expected = "wait" if now < 2.0 else "translate"
            self.assertEqual(self.instruction(executor, now=now).type, expected, now)
        # After a turn that ends sooner than planned, and if there is no stop between two moves, no robot is held.
        for turn, expected in ((0.5, "wait"), (0.03, "translate")):
            executor = self.executor({"a": actions(("translate", 2.0), ("rotate", turn), ("translate", 2.0))}, early=False)
            executor.report(Report("a", pose(2.0)), 1.9)
            executor.report(Report("a", pose(2.005, 0.0, turn)), 1.9)
            self.assertEqual(self.instruction(executor, now=1.9).type, expected, turn)

    def test_a_service_takes_its_time_however_late_it_begins(self):
        plans = {"a": actions(("translate", 1.0), ("wait", 4.0, 0), ("translate", 1.0))}
        executor = self.executor(plans, goals={"a": [{"x": 1.0, "y": 0.0, "service": 3.0}, {"x": 2.0, "y": 0.0}]})
        executor.report(Report("a", pose(1.0)), 10.0)
        serves = self.instruction(executor, now=11.0)
        self.assertEqual((serves.type, serves.goal, serves.seconds), ("wait", 0, 2.0))
        self.assertEqual(executor.states(11.0)[0]["service_left"], 2.0)
        self.assertEqual(self.instruction(executor, now=13.0).type, "translate")
        self.assertNotIn("service_left", executor.states(13.0)[0])

    def test_a_robot_may_tell_how_much_of_its_service_is_left(self):
        plans = {"a": actions(("wait", 4.0, 0), ("translate", 1.0))}
        executor = self.executor(plans, goals={"a": [{"x": 0.0, "y": 0.0, "service": 4.0}, {"x": 1.0, "y": 0.0}]})
        executor.report(Report("a", service_left=3.0), 3.0)
        self.assertEqual(self.instruction(executor, now=5.0).seconds, 1.0)
        executor.report(Report("a", service_left=0.0), 5.5)
        self.assertEqual(self.instruction(executor, now=5.5).type, "translate")

    def test_a_service_does_not_begin_before_its_time_or_a_closed_gate(self):
        plans = {"a": actions(("wait", 12.0, 0), ("translate", 1.0)), "b": actions(("translate", 1.0))}
        goals = {"a": [{"x": 0.0, "y": 0.0, "service": 2.0, "not_before": 10.0}, {"x": 1.0, "y": 0.0}]}
        executor = self.executor(plans, goals=goals)
        self.assertEqual(self.instruction(executor, now=4.0).seconds, 8.0)
        self.assertEqual(self.instruction(executor, now=12.0).type, "translate")
        executor = self.executor(plans, [("a", 0, 0.0, "b", 0, 1.0)], goals)
        self.assertEqual(self.instruction(executor, now=20.0).waits_for, ("b",))
        executor.report(Report("b", action=0, progress=1.0), 20.0)
        self.assertEqual(self.instruction(executor, now=20.0).seconds, 2.0)

    def test_a_wait_before_a_move_is_kept(self):
        plans = {"a": actions(("wait", 3.0), ("translate", 1.0))}
        executor = self.executor(plans, options={"wait_before_move": 2.0})
        self.assertEqual(self.instruction(executor, now=1.0).seconds, 1.0)
        self.assertEqual(self.instruction(executor, now=2.0).type, "translate")

    def test_the_speed_allows_to_stop_before_a_gate_but_not_between_moves_in_the_same_direction(self):
        plans = {"a": actions(("translate", 1.0), ("translate", 3.0)), "b": actions(("translate", 1.0))}
        executor = self.executor(plans, [("a", 1, 0.5, "b", 0, 1.0)], deceleration=0.5, reaction=0.5)
        far = self.instruction(executor)
        self.assertEqual((far.target, far.room, far.speed), (pose(1.0), 2.5, 1.0))
        executor.report(Report("a", pose(2.0)), 2.0)
        near = self.instruction(executor, now=2.0)
        self.assertAlmostEqual(near.room, 0.5)
        # It goes on for the reaction, and then brakes.
        self.assertAlmostEqual(near.speed * 0.5 + near.speed ** 2 / (2 * 0.5), 0.5)

    def test_a_robot_of_the_request_brakes_as_it_can_and_slows_down_for_the_next_action(self):
        course = actions(("translate", 6.0), ("translate", 4.0))
        course[0] |= {"t_end": 7.125, "profile": {"start": 0.0, "cruise": 1.0, "end": 0.5}}
        course[1] |= {"t_start": 7.125, "t_end": 15.625, "profile": {"start": 0.5, "cruise": 0.5, "end": 0.0}}
        request, answer = planned({"a": course})
        request["robot_defaults"] = {"linear_acceleration": 1.0, "linear_deceleration": 0.5}
        executor = Executor(request, answer, 0.0)
        self.assertEqual(self.instruction(executor).speed, 1.0)
        executor.report(Report("a", pose(5.5), speed=0.8), 5.0)
        slows_down = self.instruction(executor, now=5.0)
        self.assertEqual((slows_down.target, slows_down.room), (pose(6.0), 4.5))
        self.assertAlmostEqual(slows_down.speed, math.sqrt(0.5 ** 2 + 2 * 0.5 * 0.5))
        executor.report(Report("a", pose(9.9), speed=0.3), 15.0)
        self.assertAlmostEqual(self.instruction(executor, now=15.0).speed, math.sqrt(2 * 0.5 * 0.1))
        light = Executor(request, answer, 0.0, deceleration={"a": 0.01})
        self.assertLess(self.instruction(light).speed, 0.5)

    def test_measured_speeds_are_passed_on(self):
        executor = self.executor({"a": actions(("translate", 2.0)), "b": []})
        for robot, x in (("a", 0.5), ("b", 0.0)):
            executor.report(Report(robot, pose(x), speed=0.25), 1.0)
        self.assertEqual([state["speed"] for state in executor.states(1.0)], [0.25])
        self.assertEqual(executor.poses(1.0), [{"robot": "b", "speed": 0.25, **pose(0.0)}])

    def test_robots_may_brake_differently(self):
        plans = {robot: actions(("translate", 0.1)) for robot in "ab"}
        executor = self.executor(plans, deceleration={"a": 0.1})
        self.assertLess(self.instruction(executor).speed, 0.2)
        self.assertAlmostEqual(self.instruction(executor, "b").speed, 1.0)

    def test_reports_on_an_older_plan_are_ignored_unless_they_are_poses(self):
        executor = self.executor({"a": actions(("translate", 2.0))})
        executor.report(Report("a", action=0, progress=0.5, plan=0), 1.0)
        self.assertEqual(executor.progress("a")["progress"], 0.0)
        executor.report(Report("a", pose(1.0), plan=0), 1.0)
        self.assertEqual(executor.progress("a")["progress"], 0.5)

    def test_reports_that_no_action_has_are_refused(self):
        executor = self.executor({"a": actions(("translate", 2.0))})
        for action, progress in ((1, 0.0), (-1, 0.0), (0, 1.5)):
            with self.assertRaises(ValueError):
                executor.report(Report("a", action=action, progress=progress), 1.0)

    def test_a_plan_without_dependencies_is_refused(self):
        request, answer = planned({"a": actions(("translate", 2.0))})
        for missing in (answer | {"dependencies": None}, {"plans": [], "unplanned": []}):
            with self.assertRaisesRegex(ValueError, "dependencies"):
                Executor(request, missing, 0.0)

    def test_robots_that_are_invalid_stand_and_the_others_without_a_plan_do_what_is_committed(self):
        request, answer = planned({})
        for robot, reason in (("a", "invalid"), ("b", "blocked_by_robots")):
            request["robots"].append({"id": robot, "start": pose(0.0), "goals": [],
                                      "committed": actions(("translate", 1.0))})
            answer["unplanned"].append({"robot": robot, "reason": reason})
        executor = Executor(request, answer, 0.0)
        self.assertEqual([one.type for one in executor.instructions(0.0)], ["wait", "translate"])
        executor.report(Report("b", pose(1.0)), 1.0)
        self.assertEqual(executor.served, [])

    def test_robots_without_goals_that_make_way_have_nothing_to_serve_others_do_not_count(self):
        request, answer = planned({"stays": [], "yields": actions(("translate", 2.0)), "returns": [], "lost": []})
        for robot in request["robots"]:
            robot["idle"] = {"stays": "stay", "yields": "yield", "returns": "return", "lost": "yield"}[robot["id"]]
        answer["plans"] = [plan for plan in answer["plans"] if plan["robot"] != "lost"]
        answer["unplanned"].append({"robot": "lost", "reason": "blocked_by_robots"})
        executor = Executor(request, answer, 0.0)
        self.assertEqual(executor.served, ["yields", "returns"])


class FromPlanToPlan(unittest.TestCase):
    def setUp(self):
        self.old = actions(("translate", 4.0), ("rotate", 1.0), ("wait", 2.0, 0), ("translate", 2.0))
        goals = {"a": [{"x": 4.0, "y": 0.0, "service": 2.0}, {"x": 9.0, "y": 0.0}]}
        self.executor = Executor(*planned({"a": self.old}, goals=goals), 0.0)
        self.executor.report(Report("a", pose(1.0)), 1.0)
        self.executor.states(1.0)
        # From there: to the end of the translation, in two actions, and a turn.
        start = {**self.old[0], "from": pose(1.0), "t_start": 0.0}
        cut = [{**start, "to": pose(2.0), "t_end": 1.0}, {**start, "from": pose(2.0), "t_start": 1.0, "t_end": 3.0},
               {**self.old[1], "t_start": 3.0, "t_end": 4.0}]
        self.request = {"robots": [{"id": "a", "start": pose(1.0), "committed": cut[:1], "goals": goals["a"]}],
                        "progress": [{"robot": "a", "was": {"action": 0, "progress": 0.25},
                                      "is": {"action": 0, "progress": 0.0}}]}
        self.answer = planned({"a": cut})[1]

    def test_while_a_plan_is_made_a_robot_does_not_pass_the_end_of_its_commitment(self):
        self.executor.commit(self.request, self.executor.places(), 1.0)
        (goes,) = self.executor.instructions(1.0)
        self.assertEqual((goes.type, goes.target, goes.room), ("translate", pose(2.0), 1.0))
        self.executor.report(Report("a", pose(2.0)), 2.0)
        (stands,) = self.executor.instructions(2.0)
        self.assertEqual(stands.type, "wait")
        self.executor.release()
        self.assertEqual(self.executor.instructions(2.0)[0].target, pose(4.0))

    def test_what_a_robot_has_done_in_the_meantime_is_done_in_the_new_plan(self):
        self.executor.commit(self.request, self.executor.places(), 1.0)
        self.executor.report(Report("a", pose(1.75)), 1.75)
        self.executor.follow(self.request, self.answer, 1.0, 1.75)
        self.assertEqual(self.executor.progress("a"), {"robot": "a", "action": 0, "progress": 0.75})
        self.assertEqual((self.executor.plan, self.executor.start), (2, 1.0))
        (goes,) = self.executor.instructions(1.75)
        self.assertEqual((goes.plan, goes.target, goes.room), (2, pose(2.0), 2.25))

    def test_robots_that_have_passed_their_commitment_already_are_listed(self):
        places = self.executor.places()
        self.executor.report(Report("a", pose(2.5)), 2.5)
        self.assertEqual(self.executor.commit(self.request, places, 1.0), ["a"])

    def test_a_late_robot_is_not_ahead_of_its_commitment(self):
        course = actions(("translate", 4.0), ("wait", 0.5), ("translate", 2.0))
        executor = Executor(*planned({"a": course}), 0.0, early=False)
        executor.report(Report("a", pose(3.0)), 4.0)  # a second late; its wait is 4.0 to 4.5
        rest = actions(("translate", 1.0), ("wait", 0.5), ("translate", 2.0))
        request = {"robots": [{"id": "a", "start": pose(3.0), "committed": rest}]}
        executor.commit(request, executor.places(), 4.0)
        executor.report(Report("a", pose(4.0)), 5.0)
        self.assertEqual(executor.instructions(5.4)[0].type, "wait")
        self.assertEqual(executor.instructions(5.5)[0].type, "translate")
        executor.commit(request, executor.places(), 4.0)
        executor.release()
        self.assertEqual(executor.instructions(5.4)[0].type, "translate")

    def test_a_robot_that_waits_after_its_commitment_has_not_passed_it(self):
        course = actions(("translate", 4.0), ("wait", 1.0), ("wait", 1.0), ("translate", 2.0))
        executor = Executor(*planned({"a": course}), 0.0, early=False)
        executor.report(Report("a", pose(3.0)), 3.0)
        places = executor.places()
        executor.report(Report("a", pose(4.0)), 4.0)
        executor.instructions(5.5)
        self.assertGreater(executor.progress("a")["action"], 0)
        request = {"robots": [{"id": "a", "start": pose(3.0), "committed": actions(("translate", 1.0), ("wait", 1.0))}]}
        self.assertEqual(executor.commit(request, places, 3.0), [])

    def test_a_service_under_way_goes_on(self):
        self.executor.report(Report("a", action=2, progress=0.0), 5.0)
        self.executor.instructions(5.0)
        left = [{"x": 4.0, "y": 0.0, "service": 1.5}, {"x": 9.0, "y": 0.0}]
        wait = {**self.old[2], "t_start": 0.0, "t_end": 1.5}
        request = {"robots": [{"id": "a", "start": wait["from"], "committed": [wait], "goals": left}]}
        self.assertEqual(self.executor.states(5.5)[0]["service_left"], 1.5)
        self.executor.commit(request, self.executor.places(), 5.5)
        self.assertAlmostEqual(self.executor.instructions(6.0)[0].seconds, 1.0)  # it is counted in the meantime
        self.executor.follow(request, planned({"a": [wait, self.old[3]]})[1], 5.5, 6.0)
        self.assertAlmostEqual(self.executor.instructions(6.0)[0].seconds, 1.0)
        self.assertEqual(self.executor.instructions(7.0)[0].type, "translate")

    def test_a_plan_is_not_followed_before_each_robot_can_stop_before_its_closed_gates(self):
        course = actions(("translate", 4.0))
        old, new = planned({"a": course, "b": course}), planned({"a": course, "b": course}, [("a", 0, 0.35, "b", 0, 0.2)])
        for robot in old[0]["robots"]:
            robot["committed"] = course
        for at, speed, can_stop in ((1.2, 1.0, False), (1.2, 0.4, True), (1.45, 0.0, False), (1.405, 0.0, True)):
            executor = Executor(*old, 0.0, deceleration=1.0, reaction=0.1)
            executor.commit(old[0], executor.places(), 0.0)
            executor.report(Report("a", pose(at), speed=speed), 1.2)
            with self.subTest(at=at, speed=speed):
                self.assertEqual(executor.follow(old[0], new[1], 0.0, 1.2), [] if can_stop else ["a"])
                goes, _ = executor.instructions(1.2)
                self.assertEqual((executor.plan, goes.waits_for), (2, ("b",)) if can_stop else (1, ()))
                executor.report(Report("b", pose(0.8)), 1.3)  # which opens the gate
                if not can_stop:
                    self.assertEqual(executor.follow(old[0], new[1], 0.0, 1.3), [])
                goes, _ = executor.instructions(1.3)
                self.assertEqual((goes.plan, goes.target, goes.waits_for), (2, pose(4.0), ()))
                self.assertEqual(executor.progress("a")["progress"], at / 4.0)

    def test_no_robot_passes_a_closed_gate_whatever_gates_the_next_plan_has(self):
        def steps(dice):
            """Gates of a, which wait for b."""
            gates, untils = (sorted(dice.uniform(0.0, 1.0) for _ in range(12)) for _ in range(2))
            return [("a", 0, gate, "b", 0, until) for gate, until in zip(gates, untils)]

        put_off, course = 0, actions(("translate", 20.0))
        for seed in range(30):
            dice = random.Random(seed)
            request, answer = planned({"a": course, "b": course}, steps(dice), options={"execution_margin": 0.02})
            request["robot_defaults"] = {"linear_acceleration": 0.5, "linear_deceleration": dice.uniform(0.3, 1.0)}
            for robot in request["robots"]:
                robot["committed"] = course
            executor = Executor(request, answer, 0.0, reaction=0.1)
            fleet = SimulatedFleet(request, seed=seed, speed=(0.5, 1.0), stops_per_hour=600.0)
            begin = None  # of the plan that is made
            while not executor.finished:
                fleet.obey(executor.instructions(fleet.now))
                fleet.drive(0.1)
                for report in fleet.reports():
                    executor.report(report, fleet.now)
                if begin is None:
                    begin, answer = fleet.now, planned({"a": course, "b": course}, steps(dice))[1]
                    request["progress"] = [{"robot": robot, "was": executor.progress(robot), "is": executor.progress(robot)}
                                           for robot in "ab"]
                    executor.commit(request, executor.places(), begin)
                elif fleet.now >= begin + 0.4:
                    too_fast = executor.follow(request, answer, begin, fleet.now)
                    put_off += bool(too_fast)
                    begin = begin if too_fast else None
                self.assertEqual(executor.overran, [], seed)
                self.assertLess(fleet.now, 300.0, "a waits for ever")
        self.assertGreater(put_off, 100)

    def test_robots_that_are_added_begin_at_their_start(self):
        self.executor.commit(self.request, self.executor.places(), 1.0)
        request = {**self.request, "robots": [*self.request["robots"], {"id": "new", "start": pose(7.0)}]}
        answer = planned({"a": self.answer["plans"][0]["actions"], "new": actions(("translate", 1.0))})[1]
        self.executor.follow(request, answer, 1.0, 1.0)
        self.assertEqual(self.executor.progress("new")["progress"], 0.0)


class Courses(unittest.TestCase):
    def test_a_service_may_take_several_waits_of_which_the_first_is_for_its_time(self):
        goals = [{"x": 0.0, "y": 0.0, "service": 4.0, "not_before": 6.0}, {"x": 1.0, "y": 0.0}]
        course = Course(pose(0.0), actions(("wait", 5.0, 0), ("wait", 2.0, 0), ("wait", 3.0, 0), ("translate", 1.0)), goals)
        self.assertEqual([course.amount(index) for index in range(3)], [0.0, 1.0, 3.0])
        self.assertEqual([course.not_before(index) for index in range(3)], [5.0, 6.0, 6.0])
        for place, left in ((0.0, 4.0), (1.0, 4.0), (1.5, 3.5), (2.0, 3.0), (2.5, 1.5)):
            self.assertEqual(course.service_left(place), left)
            if place > 0.0:
                self.assertEqual(course.after_service(1.0, left), place)
        self.assertEqual(course.after_service(1.25, 9.0), 1.0)
        self.assertEqual(course.after_service(1.25, 0.0), 3.0)

    def test_moves_lead_to_the_same_place_on_a_course_that_is_cut_elsewhere(self):
        random_ = random.Random(11)
        for _ in range(200):
            steps = [(random_.choice(("translate", "rotate")), random_.uniform(0.1, 3.0)) for _ in range(6)]
            whole = Course(pose(0.0), actions(*steps))
            pieces = []
            for kind, amount in steps:
                share = random_.uniform(0.1, 0.9)
                pieces += [(kind, share * amount), ("wait", random_.uniform(0.0, 2.0)), (kind, (1.0 - share) * amount)]
            cut = Course(pose(0.0), actions(*pieces))
            end = random_.uniform(0.0, whole.end)
            begin = random_.uniform(0.0, end)
            there = cut.after(cut.after(0.0, whole.moves(0.0, begin)), whole.moves(begin, end))
            for axis in ("x", "y", "theta"):
                self.assertAlmostEqual(math.remainder(cut.pose(there)[axis] - whole.pose(end)[axis], math.tau), 0.0, 6)

    def test_planned_times_and_places_follow_profiles(self):
        course = actions(("rotate", 1.0), ("translate", 18.0))
        course[0] |= {"t_end": 2.0, "profile": {"start": 0.0, "cruise": 1.0, "end": 0.0}}
        course[1] |= {"t_start": 2.0, "t_end": 14.0, "profile": {"start": 0.0, "cruise": 2.0, "end": 0.0}}
        moves = Course(pose(0.0), course, limits=[Limits(1.0, 0.5, 1.0)] * 2)
        for t, place in ((0.5, 0.125), (1.0, 0.5), (1.5, 0.875), (3.0, 1 + 0.5 / 18), (4.0, 1 + 2.0 / 18),
                         (10.0, 1 + 14.0 / 18), (12.0, 1 + 17.0 / 18), (14.0, 2.0)):
            self.assertAlmostEqual(moves.place_at(t), place)
            if 1.0 < place < 2.0:
                self.assertAlmostEqual(moves.time_at(place), t)
        for place in (1.0, 1.0 - 2e-10):  # at rest before the translation, except for rounding
            self.assertEqual(moves.time_at(place), 2.0)
        self.assertEqual(moves.planned_speed(1), 2.0)

    def test_loads_change_the_limits_of_the_actions_after_them(self):
        goals = [{"linear_acceleration_after": 0.2}, {"linear_deceleration_after": 0.1}, {}]
        request = {"robot_defaults": {"linear_acceleration": 1.0}}
        robot = {"goals": goals}
        course = actions(("translate", 2.0), ("wait", 1.0, 0), ("translate", 2.0), ("wait", 1.0, 1), ("translate", 1.0))
        empty, loaded, heavy = Limits(1.0, 1.0), Limits(0.2, 0.2), Limits(0.2, 0.1)
        by_action = [empty, empty, loaded, loaded, heavy]
        self.assertEqual(limits_by_action(request, robot, course, None), by_action)
        visits = [{"goal": 0, "t_arrive": 2.0, "t_leave": 3.0}, {"goal": 1, "t_arrive": 5.0, "t_leave": 6.0},
                  {"goal": 2, "t_arrive": 7.0, "t_leave": None}]
        self.assertEqual(limits_by_action(request, robot, course, visits), by_action)
        self.assertEqual(limits_by_action(request, robot, course, visits[1:])[4], Limits(1.0, 0.1))
        put_off = [{"goal": 0, "t_arrive": None, "t_leave": None}]
        self.assertEqual(limits_by_action(request, robot, course, put_off), [empty] * 5)

    def test_moves_end_where_the_other_course_leads_elsewhere(self):
        course = Course(pose(0.0), actions(("translate", 1.0), ("rotate", 1.0)))
        self.assertEqual(course.after(0.0, [Move("translate", 3.0)]), 1.0)

    def test_small_turns_need_not_be_on_the_other_course(self):
        course = Course(pose(0.0), actions(("translate", 1.0), ("rotate", 0.2), ("translate", 2.0)))
        self.assertEqual(course.after(0.0, [Move("translate", 2.0)]), 2.5)
        self.assertEqual(course.after(0.0, [Move("translate", 1.005)], 0.01), 1.0, "it may not have turned yet")
        straight = Course(pose(0.0), actions(("translate", 4.0)))
        self.assertEqual(straight.after(0.0, [Move("translate", 1.0), Move("rotate", 0.2), Move("translate", 1.0)]), 0.5)
        turned = Course(pose(0.0), actions(("translate", 1.0), ("rotate", 0.8), ("translate", 2.0)))
        moves = [Move("translate", 1.0), Move("rotate", 0.9), Move("translate", 1.0)]
        self.assertEqual(turned.after(0.0, moves), 2.5)
        self.assertEqual(turned.after(0.0, [Move("translate", 2.0)]), 1.0)

    def test_a_little_more_than_the_moves_before_a_service_does_not_end_it(self):
        course = Course(pose(0.0), actions(("translate", 1.0), ("rotate", 0.1), ("wait", 7.0, 0), ("rotate", 3.0)))
        self.assertEqual(course.after(0.0, [Move("translate", 1.0), Move("rotate", 0.1001)], 0.03), 2.0)
        self.assertEqual(course.after(0.0, [Move("translate", 1.0), Move("rotate", 1.6)], 0.03), 3.5)

    def test_a_pose_is_found_on_a_course_that_passes_it_twice(self):
        course = Course(pose(0.0), actions(("translate", 2.0), ("rotate", math.pi), ("translate", 2.0)))
        self.assertEqual(course.located(pose(1.0), 0.0, course.end, 0.01), 0.5)
        self.assertEqual(course.located(pose(1.0, 0.0, math.pi), 2.0, course.end, 0.01), 2.5)
        self.assertEqual(course.located(pose(0.0, 0.0, math.pi), 2.5, course.end, 0.01), 3.0)

    def test_a_robot_turns_the_short_way(self):
        course = Course(pose(0.0, 0.0, 3.0), [{"type": "rotate", "t_start": 0.0, "t_end": 1.0,
                                              "from": pose(0.0, 0.0, 3.0), "to": pose(0.0, 0.0, -3.0)}])
        self.assertAlmostEqual(course.amount(0), math.tau - 6.0)
        self.assertAlmostEqual(abs(course.pose(0.5)["theta"]), math.pi)


class WithRobots(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        with service() as url, Client(url) as client:
            cls.request = json.loads((PROJECT / "tests/scenarios/warehouse.json").read_text())
            cls.request["robots"] = cls.request["robots"][:25]
            cls.request["options"] = {"dependencies": True, "interval_margin": 0.5, "time_budget_ms": 60000}
            cls.answer = client.plan(cls.request)
            limits = {"linear_acceleration": 0.5, "linear_deceleration": 0.8}
            cls.accelerating = cls.request | {"robot_defaults": limits}
            cls.with_profiles = client.plan(cls.accelerating)

    def execute(self, robots, **how):
        """The fleet that has executed the plan, and the robots that have passed closed gates. Poses are exact."""
        executor = Executor(self.request, self.answer, 0.0, near=1e-6, **how)
        fleet, overran = SimulatedFleet(self.request, **robots), set()
        while not executor.finished:
            fleet.obey(executor.instructions(fleet.now))
            fleet.drive(0.2)
            for report in fleet.reports():
                executor.report(report, fleet.now)
            overran |= set(executor.overran)
            self.assertLess(fleet.now, 600.0, "robots wait for each other")
        return fleet, overran

    def assert_all_have_arrived_and_met_nobody(self, fleet):
        self.assertEqual(met(self.request, fleet), ([], []))
        for plan in self.answer["plans"]:
            there, goal = fleet.pose(plan["robot"]), plan["actions"][-1]["to"]
            self.assertLess(math.hypot(there["x"] - goal["x"], there["y"] - goal["y"]), 1e-5)

    def test_late_robots_that_obey_all_arrive_and_meet_nobody(self):
        self.assertEqual(self.answer["tight"], [])
        for seed in range(2):
            fleet, overran = self.execute({"seed": seed, "speed": (0.4, 1.0), "stops_per_hour": 60.0})
            self.assertEqual(overran, set(), f"seed {seed}")
            self.assert_all_have_arrived_and_met_nobody(fleet)

    def test_robots_with_inertia_stop_before_gates(self):
        fleet, overran = self.execute({"seed": 7, "acceleration": 0.6}, deceleration=0.5, reaction=0.2)
        self.assertEqual(overran, set())
        self.assert_all_have_arrived_and_met_nobody(fleet)

    def test_robots_that_accelerate_as_planned_arrive_as_planned(self):
        fleet = SimulatedFleet(self.accelerating, speed=(1.0, 1.0))
        executor = Executor(self.accelerating, self.with_profiles, 0.0, early=False, near=1e-6)
        arrivals = {}
        while not executor.finished:
            fleet.obey(executor.instructions(fleet.now))
            fleet.drive(0.2)
            for report in fleet.reports():
                executor.report(report, fleet.now)
            self.assertEqual(executor.overran, [])
            for robot in executor.served:
                arrivals.setdefault(robot, fleet.now)
            self.assertLess(fleet.now, 600.0, "robots wait for each other")
        self.assertEqual(met(self.accelerating, fleet), ([], []))
        plans = self.with_profiles["plans"]
        late = sum(arrivals[plan["robot"]] for plan in plans) / sum(plan["cost"] for plan in plans)
        self.assertLess(late, 1.05)  # an action that ends within a step of 0.2 s goes on with the next one

    def test_robots_with_inertia_that_brake_too_late_pass_gates(self):
        _, overran = self.execute({"seed": 7, "acceleration": 0.6})
        self.assertNotEqual(overran, set())


if __name__ == "__main__":
    unittest.main()
