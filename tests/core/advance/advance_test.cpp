#include "core/advance/advance.h"

#include <gtest/gtest.h>

#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "core/advance/timeline.h"
#include "tests/core/advance/driving_fleet.h"
#include "tests/support/unbounded_work.h"

namespace fleetplan::core {
namespace TEST_FILE {

using Type = Action::Type;

Goal goal(double x, double service = 0.0, double not_before = 0.0) {
  return {{x, 1.0}, std::nullopt, service, not_before};
}

/// Serves at x = 3 from 2 s to 7 s, waits for others until 8 s, and is at x = 6 from 11 s on.
Robot robot() {
  Robot robot = robot_at(at_x(1.0), 0.0);
  robot.via = {goal(3.0, 5.0)};
  robot.goal = goal(6.0, 1.0);
  return robot;
}

Execution plan() {
  return {{{Type::translate, 0.0, 2.0, at_x(1.0), at_x(3.0)},
           {Type::wait, 2.0, 7.0, at_x(3.0), at_x(3.0), 0},
           {Type::wait, 7.0, 8.0, at_x(3.0), at_x(3.0)},
           {Type::translate, 8.0, 11.0, at_x(3.0), at_x(6.0)},
           {Type::wait, 11.0, 12.0, at_x(6.0), at_x(6.0), 1}},
          true};
}

TEST(Advance, ByDefaultTheActionUnderWayIsCommitted) {
  const Robot next = advanced(robot(), plan(), moment(0.5));
  EXPECT_EQ(next.start.position.x(), 1.5);
  ASSERT_EQ(next.committed.size(), 1U);
  EXPECT_EQ(next.committed[0].t_end, 1.5);
  EXPECT_EQ(next.committed[0].to.position.x(), 3.0);
  ASSERT_EQ(next.previous->size(), 5U);
  EXPECT_EQ(next.goal_count(), 2U);
}

TEST(Advance, CountsDueFromTheMoment) {
  Robot due = robot();
  due.weight = 5.0;
  due.via[0].due = 1.0;
  due.goal->due = 20.0;
  const Robot next = advanced(due, plan(), moment(4.0));
  EXPECT_EQ(next.goal_at(0).due, -3.0) << "it is late already";
  EXPECT_EQ(next.goal_at(1).due, 16.0);
  EXPECT_EQ(next.weight, 5.0);
}

TEST(Advance, AHorizonCutsTheActionUnderWay) {
  const Robot next = advanced(robot(), plan(), moment(0.5, 1.0));
  ASSERT_EQ(next.committed.size(), 1U);
  EXPECT_EQ(next.committed[0].t_end, 1.0);
  EXPECT_EQ(next.committed[0].to.position.x(), 2.5);
  EXPECT_TRUE(advanced(robot(), plan(), moment(0.5, 0.0)).committed.empty());
}

TEST(Advance, ThePreviousActionsBeginWithTheCommittedOnes) {
  const Robot next = advanced(robot(), plan(), moment(0.5, 1.0));
  ASSERT_EQ(next.previous->size(), 6U);
  EXPECT_EQ(next.previous->at(0).to.position, next.committed[0].to.position);
  EXPECT_EQ(next.previous->at(0).t_end, 1.0);
  EXPECT_EQ(next.previous->at(1).t_start, 1.0);
  EXPECT_EQ(next.previous->at(1).from.position, next.committed[0].to.position);
  EXPECT_EQ(next.previous->at(1).t_end, 1.5);
}

TEST(Advance, AServiceUnderWayKeepsWhatIsLeftOfIt) {
  const Robot next = advanced(robot(), plan(), moment(4.5));
  ASSERT_EQ(next.goal_count(), 2U);
  EXPECT_DOUBLE_EQ(next.via[0].service, 2.5);
  EXPECT_TRUE(next.committed.empty());
  EXPECT_EQ(next.previous->front().t_end, 2.5);
  EXPECT_EQ(next.previous->front().goal, 0U);
}

TEST(Advance, VisitedGoalsAreLeftOutAndTheWaitsAreNumberedAnew) {
  const Robot next = advanced(robot(), plan(), moment(7.0));
  EXPECT_TRUE(next.via.empty());
  EXPECT_EQ(next.goal->service, 1.0);
  EXPECT_EQ(next.previous->front().goal, std::nullopt);
  EXPECT_EQ(next.previous->back().goal, 0U);
}

TEST(Advance, TheLastGoalStaysWithoutAServiceWhenItHasBeenServed) {
  for (const double at : {12.0, 40.0}) {
    const Robot next = advanced(robot(), plan(), moment(at));
    ASSERT_EQ(next.goal_count(), 1U);
    EXPECT_EQ(next.goal->position.x(), 6.0);
    EXPECT_EQ(next.goal->service, 0.0);
    EXPECT_TRUE(next.previous->empty());
  }
}

TEST(Advance, TimesOfGoalsMove) {
  Robot late = robot();
  late.goal->not_before = 30.0;
  EXPECT_EQ(advanced(late, plan(), moment(10.0)).goal->not_before, 20.0);
  EXPECT_EQ(advanced(late, {{}, false}, moment(31.0)).goal->not_before, 0.0);
}

TEST(Advance, NewGoalsReplaceTheOthersAndThePreviousPlan) {
  Execution execution = plan();
  execution.goals = {goal(2.0), goal(8.0, 3.0)};
  const Robot next = advanced(robot(), execution, moment(1.0));
  ASSERT_EQ(next.goal_count(), 2U);
  EXPECT_EQ(next.goal->service, 3.0);
  EXPECT_FALSE(next.previous);
  EXPECT_EQ(next.committed.size(), 1U);
}

TEST(Advance, AHoldIsCommittedAndBreaksTheActionOff) {
  Execution execution = plan();
  execution.hold = 30.0;
  const Robot next = advanced(robot(), execution, moment(1.0, 1.0));
  ASSERT_EQ(next.committed.size(), 1U);
  EXPECT_EQ(next.committed[0].type, Type::wait);
  EXPECT_EQ(next.committed[0].t_end, 30.0);
  EXPECT_EQ(next.start.position.x(), 2.0);
  EXPECT_EQ(next.previous->at(1).t_end, 31.0);
}

TEST(Advance, ARobotThatIsElsewhereHasNoCommitmentAndNoPreviousPlan) {
  Execution execution = plan();
  execution.measured = Pose{{2.0, 1.5}, 0.0};
  const Robot next = advanced(robot(), execution, moment(1.0));
  EXPECT_EQ(next.start.position.y(), 1.5);
  EXPECT_TRUE(next.committed.empty());
  EXPECT_FALSE(next.previous);
  EXPECT_EQ(next.goal_count(), 2U);
}

TEST(Advance, ALateRobotHasNotVisitedWhatItsPlanHasVisited) {
  Execution execution = plan();
  execution.measured = Pose{{2.0, 1.0}, 0.0};
  const Robot next = advanced(robot(), execution, moment(9.0));
  ASSERT_EQ(next.goal_count(), 2U);
  EXPECT_EQ(next.via[0].service, 5.0);
  EXPECT_EQ(next.previous->back().t_end, 11.0);
}

TEST(Advance, ARobotWithoutAPlanFollowsItsCommitmentAndStays) {
  const Execution execution{{{Type::translate, 0.0, 2.0, at_x(1.0), at_x(3.0)}}, false};
  const Robot moving = advanced(robot(), execution, moment(1.0));
  EXPECT_EQ(moving.committed.size(), 1U);
  EXPECT_FALSE(moving.previous);
  // It is served where it stands.
  const Robot standing = advanced(robot(), execution, moment(4.0));
  EXPECT_EQ(standing.start.position.x(), 3.0);
  EXPECT_DOUBLE_EQ(standing.via[0].service, 3.0);
}

TEST(Advance, WhatIsLeftOfAWaitBeforeAMoveIsCommitted) {
  const Robot next = advanced(robot(), plan(), moment(7.5, 0.1, 2.0));
  ASSERT_EQ(next.committed.size(), 1U);
  EXPECT_EQ(next.committed[0].t_end, 0.5);
  EXPECT_TRUE(advanced(robot(), plan(), moment(7.5, {}, 0.1)).committed.empty());
}

TEST(Advance, ItsResultCanBeAdvancedAgain) {
  for (int step = 0; step < 36; ++step) {
    const double first = 0.37 * step;
    const Robot once = advanced(robot(), plan(), moment(first));
    const Robot twice = advanced(once, {*once.previous, true}, moment(0.7));
    const Robot direct = advanced(robot(), plan(), moment(first + 0.7));
    EXPECT_NEAR(twice.start.position.x(), direct.start.position.x(), 1e-9) << first;
    ASSERT_EQ(twice.goal_count(), direct.goal_count()) << first;
    EXPECT_NEAR(twice.goal_at(0).service, direct.goal_at(0).service, 1e-9) << first;
    EXPECT_EQ(twice.previous->size(), direct.previous->size()) << first;
  }
}

/// The plan of a robot that reports how far it is.
Execution reported(std::size_t action, double fraction, std::optional<double> service_left = {}) {
  Execution execution = plan();
  execution.reported = ReportedState{{action, fraction}, service_left};
  return execution;
}

TEST(AdvanceByState, ALateServiceKeepsWhatIsLeftOfIt) {
  const Robot next = advanced(robot(), reported(1, 0.2), moment(9.0, 2.0));  // planned: on its way to x = 6
  ASSERT_EQ(next.goal_count(), 2U);
  EXPECT_DOUBLE_EQ(next.via[0].service, 4.0);
  EXPECT_EQ(next.start.position.x(), 3.0);
  EXPECT_EQ(next.committed.back().t_end, 2.0);
  EXPECT_EQ(next.previous->front().goal, 0U);
  EXPECT_DOUBLE_EQ(next.previous->at(1).t_end, 4.0);
  EXPECT_DOUBLE_EQ(next.previous->back().t_end, 4.0 + 1.0 + 3.0 + 1.0);
}

TEST(AdvanceByState, TheServiceThatIsLeftIsAsReported) {
  for (const double left : {0.5, 12.0}) {  // the planned one takes 5 s
    const Robot next = advanced(robot(), reported(1, 1.0, left), moment(9.0));
    ASSERT_EQ(next.goal_count(), 2U);
    EXPECT_EQ(next.via[0].service, left);
    EXPECT_EQ(next.previous->front().t_end, left);
    EXPECT_EQ(next.previous->at(1).goal, std::nullopt);
  }
  const Robot served = advanced(robot(), reported(1, 0.1, 0.0), moment(9.0));
  EXPECT_EQ(served.goal_count(), 1U);
  EXPECT_EQ(served.goal->service, 1.0);
  EXPECT_EQ(served.previous->front().t_end, 1.0) << "the wait for others";
}

TEST(AdvanceByState, AServiceInTwoPartsIsOne) {
  Execution execution = reported(1, 0.5, 4.0);
  execution.actions[1].t_end = 4.0;
  execution.actions[2].t_start = 4.0;
  execution.actions[2].t_end = 7.0;
  execution.actions[2].goal = 0;
  const Robot next = advanced(robot(), execution, moment(3.5));
  EXPECT_EQ(next.via[0].service, 4.0);
  EXPECT_EQ(next.previous->at(0).t_end, 4.0);
  EXPECT_NE(next.previous->at(1).goal, 0U);
  execution.reported->service_left.reset();
  const Robot as_planned = advanced(robot(), execution, moment(3.5));
  EXPECT_DOUBLE_EQ(as_planned.via[0].service, 4.0);
  EXPECT_DOUBLE_EQ(as_planned.previous->at(0).t_end, 1.0);
  EXPECT_DOUBLE_EQ(as_planned.previous->at(1).t_end, 4.0);
  execution.reported->service_left = 0.0;
  EXPECT_EQ(advanced(robot(), execution, moment(3.5)).goal_count(), 1U);
}

TEST(AdvanceByState, AWaitForAGoalGoesOnUntilItMayBegin) {
  Robot early = robot();
  early.via[0].not_before = 4.0;  // the wait is from 2 s to 9 s, of which the last five are the service
  Execution execution = reported(1, 0.0);
  execution.actions[1].t_end = 9.0;
  const Robot late = advanced(early, execution, moment(3.0));
  EXPECT_EQ(late.via[0].not_before, 1.0);
  EXPECT_EQ(late.via[0].service, 5.0);
  EXPECT_DOUBLE_EQ(late.previous->front().t_end, 6.0);
  const Robot later = advanced(early, execution, moment(20.0));
  EXPECT_EQ(later.via[0].not_before, 0.0);
  EXPECT_EQ(later.via[0].service, 5.0);
  EXPECT_DOUBLE_EQ(later.previous->front().t_end, 5.0);
}

TEST(AdvanceByState, AServiceNeverHappensBecauseTimeHasPassed) {
  const Robot next = advanced(robot(), reported(0, 1.0), moment(40.0));
  ASSERT_EQ(next.goal_count(), 2U);
  EXPECT_EQ(next.via[0].service, 5.0);
  EXPECT_EQ(next.start.position.x(), 3.0);
  EXPECT_DOUBLE_EQ(next.previous->front().t_end, 5.0);
  Execution unplanned = reported(0, 1.0);
  unplanned.planned = false;
  unplanned.actions.resize(1);
  EXPECT_EQ(advanced(robot(), unplanned, moment(40.0)).via[0].service, 5.0);
}

TEST(AdvanceByState, ARobotGoesOnFromItsProgress) {
  const Robot next = advanced(robot(), reported(3, 0.5), moment(8.5));  // planned: x = 3.5
  EXPECT_DOUBLE_EQ(next.start.position.x(), 4.5);
  EXPECT_DOUBLE_EQ(next.committed.back().t_end, 1.5);
  EXPECT_EQ(next.goal_count(), 1U);
  EXPECT_DOUBLE_EQ(next.previous->back().t_end, 3.5) << "it is early, and is served when that is due";
}

TEST(AdvanceByState, AllDoneIsTheEndOfTheLastAction) {
  const Robot next = advanced(robot(), reported(4, 1.0), moment(5.0));
  EXPECT_EQ(next.start.position.x(), 6.0);
  EXPECT_EQ(next.goal->service, 0.0);
  EXPECT_TRUE(next.previous->empty());
}

TEST(AdvanceByState, AMeasuredPoseIsTheStart) {
  Execution execution = reported(3, 0.5);
  execution.measured = Pose{{4.5, 1.05}, 0.05};
  const Robot near = advanced(robot(), execution, moment(9.5));
  EXPECT_EQ(near.start.position, Position(4.5, 1.05));
  EXPECT_EQ(near.committed.front().to.position, Position(6.0, 1.0));
  for (const Pose& far : {Pose{{4.5, 1.2}, 0.0}, Pose{{4.3, 1.0}, 0.0}, Pose{{4.5, 1.0}, 0.3}}) {
    execution.measured = far;
    const Robot elsewhere = advanced(robot(), execution, moment(9.5));
    EXPECT_EQ(elsewhere.start.position, far.position);
    EXPECT_TRUE(elsewhere.committed.empty());
    EXPECT_FALSE(elsewhere.previous);
    EXPECT_EQ(elsewhere.goal_count(), 1U) << "what it has reported to have visited";
  }
}

TEST(AdvanceByState, AHeldRobotGoesOnLater) {
  Execution execution = reported(1, 0.4);
  execution.hold = 10.0;
  const Robot next = advanced(robot(), execution, moment(9.0));
  EXPECT_EQ(next.committed_until(), 10.0);
  EXPECT_DOUBLE_EQ(next.via[0].service, 3.0);
}

TEST(AdvanceByState, ThePlaceIsThatOfTheStateOrOfThePlan) {
  const auto expect_place = [](const Execution& execution, double at, std::size_t action, double fraction) {
    const ActionPlace place = place_of(robot(), execution, moment(at));
    EXPECT_EQ(place.action, action) << at;
    EXPECT_DOUBLE_EQ(place.fraction, fraction) << at;
  };
  expect_place(reported(1, 0.25, 1.0), 9.0, 1, 0.25);
  expect_place(plan(), 0.5, 0, 0.25);
  expect_place(plan(), 2.0, 1, 0.0);
  expect_place(plan(), 30.0, 4, 1.0);
  expect_place({{}, true}, 3.0, 0, 0.0);
  Execution late = plan();
  late.measured = Pose{{2.0, 1.0}, 0.0};
  expect_place(late, 9.0, 0, 0.5);
  late.measured = Pose{{2.0, 2.0}, 0.0};  // beside its path
  expect_place(late, 9.5, 3, 0.5);
}

/// The plan of a robot that may drive to a place already.
Execution released(ActionPlace at, ActionPlace until) {
  Execution execution = reported(at.action, at.fraction);
  execution.reported->released = until;
  return execution;
}

Moment standing(double at, double until) {
  Moment then = moment(at);
  then.stand_until = until;
  return then;
}

TEST(AdvanceByRelease, ARobotIsCommittedToWhatIsReleasedAndThenStands) {
  const Robot next = advanced(robot(), released({0, 0.5}, {0, 0.75}), standing(5.0, 2.0));
  EXPECT_EQ(next.start.position.x(), 2.0);
  ASSERT_EQ(next.committed.size(), 2U);
  EXPECT_DOUBLE_EQ(next.committed[0].to.position.x(), 2.5);
  EXPECT_DOUBLE_EQ(next.committed[0].t_end, 0.5);
  EXPECT_EQ(next.committed[1].type, Type::wait);
  EXPECT_EQ(next.committed_until(), 2.0);
  ASSERT_EQ(next.previous->size(), 7U);
  EXPECT_DOUBLE_EQ(next.previous->at(2).to.position.x(), 3.0);
  EXPECT_DOUBLE_EQ(next.previous->at(2).t_end, 2.5);
  EXPECT_EQ(next.goal_count(), 2U);
  // It stands where it may stand.
  const Robot stands = advanced(robot(), released({0, 0.75}, {0, 0.75}), standing(5.0, 2.0));
  EXPECT_DOUBLE_EQ(stands.start.position.x(), 2.5);
  ASSERT_EQ(stands.committed.size(), 1U);
  EXPECT_EQ(stands.committed[0].type, Type::wait);
  const Robot at_start = advanced(robot(), released({0, 0.0}, {0, 0.0}), standing(5.0, 0.0));
  EXPECT_EQ(at_start.start.position.x(), 1.0);
  EXPECT_TRUE(at_start.committed.empty());
}

TEST(AdvanceByRelease, ServicesAreDoneButWaitsThatGiveWayAreLeftOut) {
  const Robot next = advanced(robot(), released({0, 0.5}, {3, 0.5}), standing(1.0, 0.0));
  ASSERT_EQ(next.committed.size(), 3U);
  EXPECT_EQ(next.committed[1].goal, 0U);
  EXPECT_DOUBLE_EQ(next.committed[1].t_end, 6.0);
  EXPECT_DOUBLE_EQ(next.committed[2].to.position.x(), 4.5);
  EXPECT_DOUBLE_EQ(next.committed_until(), 7.5);
  // It does not wait for others where it may go on.
  const Robot waiting = advanced(robot(), released({2, 0.25}, {3, 0.5}), standing(7.25, 0.0));
  ASSERT_EQ(waiting.committed.size(), 1U);
  EXPECT_DOUBLE_EQ(waiting.committed_until(), 1.5);
}

TEST(AdvanceByRelease, AllStandUntilTheLastHasComeToWhereItMayGo) {
  const std::vector<Robot> robots(3, robot());
  std::vector<Execution> executions{released({0, 0.5}, {0, 0.75}), released({3, 0.0}, {4, 1.0}), plan()};
  Moment then = moment(8.0);
  then.stand_until = standing_time(robots, executions, then, unbounded_work());
  EXPECT_EQ(then.stand_until, 3.0);  // the service at x = 6 does not count
  EXPECT_EQ(advanced(robots[0], executions[0], then).committed_until(), 3.0);
  EXPECT_EQ(advanced(robots[1], executions[1], then).committed_until(), 4.0);
  const Robot other = advanced(robots[2], executions[2], then);
  EXPECT_EQ(other.committed_until(), 3.0);
  EXPECT_EQ(other.committed.front().type, Type::wait);
  executions[0].hold = 5.0;
  EXPECT_EQ(standing_time(robots, executions, then, unbounded_work()), 5.5);
  then.commit = 20.0;
  EXPECT_EQ(standing_time(robots, executions, then, unbounded_work()), 20.0);
  executions = {plan(), plan(), plan()};
  EXPECT_EQ(standing_time(robots, executions, then, unbounded_work()), std::nullopt);
}

TEST(AdvanceByRelease, ARobotThatIsElsewhereStandsWhereItIs) {
  Execution execution = released({0, 0.5}, {0, 0.75});
  execution.measured = Pose{{2.0, 2.0}, 0.0};
  const Robot next = advanced(robot(), execution, standing(5.0, 2.0));
  EXPECT_EQ(next.start.position, Position(2.0, 2.0));
  EXPECT_EQ(next.committed_until(), 2.0);
  EXPECT_EQ(next.committed.front().type, Type::wait);
  EXPECT_FALSE(next.previous);
  EXPECT_EQ(standing_time({robot()}, {execution}, moment(5.0), unbounded_work()), 0.0);
}

/// The same robot picks a load up at x = 3, and puts it down at x = 6.
Robot carrier() {
  Robot carrier = robot();
  carrier.radius = 0.3;
  carrier.via[0].radius_after = 0.5;
  carrier.goal->radius_after = 0.4;
  return carrier;
}

TEST(Advance, ARobotHasTheRadiusOfItsLoad) {
  const Robot driving = advanced(carrier(), plan(), moment(6.9));
  EXPECT_EQ(driving.radius, 0.3);
  EXPECT_EQ(driving.via[0].radius_after, 0.5);
  const Robot loaded = advanced(carrier(), plan(), moment(7.1));
  EXPECT_EQ(loaded.radius, 0.5);
  EXPECT_EQ(loaded.goal->radius_after, 0.4);
}

TEST(Advance, ARobotThatHasServedItsLastGoalKeepsItsLastRadius) {
  EXPECT_EQ(advanced(carrier(), plan(), moment(11.5)).radius, 0.5);
  const Robot served = advanced(carrier(), plan(), moment(12.5));
  EXPECT_EQ(served.radius, 0.4);
  EXPECT_EQ(served.goal->radius_after, std::nullopt);
}

TEST(Advance, NewGoalsDoNotTakeALoadAway) {
  Execution execution = plan();
  execution.goals = std::vector{goal(9.0)};
  EXPECT_EQ(advanced(carrier(), execution, moment(7.5)).radius, 0.5);
  EXPECT_EQ(advanced(carrier(), execution, moment(12.5)).radius, 0.4);
}

/// Robots that follow each other along a line, half a metre apart.
DrivingFleet convoy_of(int count) {
  DrivingFleet convoy;
  for (int k = 0; k < count; ++k) convoy.add_on_line(5.0 - 0.5 * k, 9.0 - 0.5 * k);
  return convoy;
}

TEST(AdvancedFleet, RobotsBehindOneThatIsHeldAreCommittedUntilTheyTouch) {
  DrivingFleet convoy = convoy_of(4);
  convoy.executions[1].hold = 30.0;
  convoy.robots[2].start.position.x() -= 0.25;
  convoy.executions[2].actions[0].from = convoy.robots[2].start;
  convoy.executions[2].actions[0].t_end = 4.25;
  convoy.robots[3].start.position.x() -= 0.25;
  convoy.executions[3].actions[0].from = convoy.robots[3].start;
  convoy.executions[3].actions[0].t_end = 4.25;
  const auto next = convoy.advance(1.0, 1.0);
  EXPECT_EQ(next[0].committed.back().t_end, 1.0);
  EXPECT_EQ(next[1].committed.back().t_end, 30.0);
  for (const std::size_t behind : {2U, 3U}) {
    ASSERT_EQ(next[behind].committed.size(), 1U);
    EXPECT_NEAR(next[behind].committed[0].t_end, 0.25, 1e-6);
    EXPECT_EQ(next[behind].previous->front().t_end, next[behind].committed[0].t_end);
  }
}

TEST(AdvancedFleet, OneThatTouchesAHeldRobotIsNotCommittedToGoOn) {
  DrivingFleet convoy = convoy_of(2);
  convoy.executions[0].hold = 30.0;
  EXPECT_TRUE(convoy.advance(1.0, 1.0)[1].committed.empty());
}

TEST(AdvancedFleet, OneThatMovesAwayFromAHeldRobotGoesOn) {
  DrivingFleet convoy = convoy_of(2);
  convoy.executions[1].hold = 30.0;
  EXPECT_EQ(convoy.advance(1.0, 1.0)[0].committed.back().t_end, 1.0);
}

TEST(AdvancedFleet, ALateRobotStopsThoseThatWouldDriveIntoIt) {
  DrivingFleet convoy = convoy_of(2);
  convoy.executions[0].measured = Pose{{5.9, 1.0}, 0.0};  // planned: 6
  const auto next = convoy.advance(1.0, 1.0);
  // Both drive at the same speed, so the gap that is left stays.
  EXPECT_EQ(next[0].committed.back().t_end, 1.0);
  EXPECT_EQ(next[1].committed.back().t_end, 1.0);
  convoy.executions[0].measured = Pose{{6.2, 1.3}, 0.0};  // beside its path
  EXPECT_NEAR(convoy.advance(1.0, 1.0)[1].committed.back().t_end, 0.3, 1e-6);
}

/// One robot drives to x = 3 and then aside to y = 3. The other robot passes there later, in one long move.
DrivingFleet crossing(double inflation = 0.0) {
  const Robot first = robot_at(at_x(1.0));
  const Robot second = robot_at({{3.0, -5.0}, 1.5});
  DrivingFleet fleet;
  fleet.inflation = inflation;
  fleet.add(first, {{Type::translate, 0.0, 2.0, first.start, at_x(3.0)},
                    {Type::translate, 2.0, 4.0, {{3.0, 1.0}, 1.5}, {{3.0, 3.0}, 1.5}}});
  fleet.add(second, {{Type::translate, 0.0, 8.0, second.start, {{3.0, 3.0}, 1.5}}});
  return fleet;
}

TEST(AdvancedFleet, NobodyIsCommittedToPassWhereAnotherCommitmentHasEnded) {
  const auto next = crossing().advance(1.0);
  EXPECT_EQ(next[0].committed.back().to.position, Position(3.0, 1.0));
  // From y = -4 to half a metre before y = 1.
  EXPECT_NEAR(next[1].committed.back().t_end, 4.5, 1e-6);
  ASSERT_EQ(next[1].previous->size(), 2U);
  EXPECT_EQ(next[1].previous->at(1).t_end, 7.0);
}

TEST(AdvancedFleet, CommitmentsKeepTheDistanceOfThePlan) {
  EXPECT_NEAR(crossing(0.1).advance(1.0)[1].committed.back().t_end, 4.3, 1e-6);
  DrivingFleet fleet = crossing(0.1);
  fleet.robots[0].vicinity = 0.2;
  EXPECT_NEAR(fleet.advance(1.0)[1].committed.back().t_end, 4.1, 1e-6);
}

/// One robot stops where it touches another robot that waits, and then goes on past it.
TEST(AdvancedFleet, NobodyGoesOnIntoOneThatHasStoppedBesideIt) {
  const Robot waits = robot_at({{9.75, 9.75}, -3.0691895301690075}, 0.5);
  const Action wait{Type::wait, 0.0, 2.2, waits.start, waits.start};
  const Action past{Type::translate, 2.2, 7.4, waits.start, {{2.0, 9.187893222363368}, waits.start.theta}};
  const Robot comes = robot_at({{8.2, 5.13}, 1.279898456223541});
  const Action drive{
      Type::translate, 0.0, 4.63, comes.start, {{10.859688605502331, 14.0}, comes.start.theta}};
  DrivingFleet fleet;
  fleet.add(waits, {wait, past});
  fleet.add(comes, {drive});
  for (const double inflation : {0.0, 0.05, 0.1}) {
    fleet.inflation = inflation;
    const auto next = fleet.advance(0.0, 4.0);
    EXPECT_LT(next[1].committed_until(), 3.0);
    const Position stands = next[1].committed_end().position;
    for (double t = 2.2; t <= next[0].committed_until(); t += 0.01) {
      EXPECT_GT((pose_at(past, t).position - stands).norm(), 0.75 + 2.0 * inflation - 1e-6) << t;
    }
  }
}

/// Two robots of radius 0.25 pass each other 0.7 m apart, as near as an inflation of 0.1 m allows.
TEST(AdvancedFleet, InflationIsUsedUpByRobotsThatAreNotWhereTheirPlansHaveThem) {
  DrivingFleet fleet;
  fleet.inflation = 0.1;
  fleet.add_on_line(1.0, 9.0);
  const Robot down = robot_at({{9.0, 1.7}, std::numbers::pi});
  const Pose end_of_down{{1.0, 1.7}, std::numbers::pi};
  fleet.add(down, {{Type::translate, 0.0, 8.0, down.start, end_of_down}});
  const auto until = [&](double y) {
    fleet.executions[0].measured = Pose{{3.5, y}, 0.0};
    return fleet.advance(2.5, 4.0)[0].committed_until();
  };
  EXPECT_EQ(until(1.0), 4.0);
  EXPECT_EQ(until(1.04), 4.0) << "nearer than planned by no more than it is off its path";
  EXPECT_LT(until(1.09), 2.0) << "half of its inflation is kept";
  EXPECT_GT(until(1.09), 0.5);
}

/// A moving robot cannot stop at once. If it is already too near to another robot, it keeps half of the
/// distance. So that robots do not creep up to each other, it keeps all of a gap of a quarter of both
/// margins.
TEST(AdvancedFleet, RobotsThatAreTooNearStopHalfWayUnlessLittleIsLeft) {
  const std::vector<std::pair<double, double>> cases{{0.1, 0.05}, {0.06, 0.02}, {0.04, 0.0}, {0.01, 0.0}};
  for (const auto& [gap, drives] : cases) {
    DrivingFleet convoy = convoy_of(2);
    convoy.executions[0].hold = 30.0;
    convoy.robots[1].start.position.x() -= gap;
    convoy.executions[1].actions[0].from = convoy.robots[1].start;
    convoy.executions[1].actions[0].t_end = 4.0 + gap;
    convoy.inflation = 0.08;
    const auto next = convoy.advance(1.0, 1.0);
    EXPECT_NEAR(next[1].committed_until(), drives, 1e-6) << gap;
  }
}

TEST(AdvancedFleet, CommitmentsToOneHorizonStayWhole) {
  const auto next = crossing().advance(1.0, 1.0);
  for (const Robot& robot : next) EXPECT_EQ(robot.committed_until(), 1.0);
}

TEST(AdvancedFleet, AWaitStaysCommittedWhereAnotherRobotTouches) {
  DrivingFleet fleet = crossing();
  fleet.executions[0].hold = 30.0;
  const auto next = fleet.advance(2.0);
  EXPECT_EQ(next[0].committed_until(), 30.0);
  EXPECT_NEAR(next[1].committed_until(), 3.5, 1e-6);
}

MovingObstacle walker(MovingObstacle::After after) {
  return {"walker", 0.3, {{2.0, {1.0, 1.0}}, {4.0, {5.0, 1.0}}, {8.0, {5.0, 3.0}}}, after};
}

TEST(AdvancedObstacle, IsCutToWhatIsLeftOfIt) {
  const auto left = advanced(walker(MovingObstacle::After::leaves), 3.0);
  ASSERT_TRUE(left);
  ASSERT_EQ(left->motion.size(), 3U);
  EXPECT_EQ(left->motion[0].t, 0.0);
  EXPECT_EQ(left->motion[0].position.x(), 3.0);
  EXPECT_EQ(left->motion[2].t, 5.0);
  EXPECT_EQ(advanced(walker(MovingObstacle::After::leaves), 4.0)->motion.size(), 2U);
}

TEST(AdvancedObstacle, ThatIsNotThereYetComesLater) {
  const auto left = advanced(walker(MovingObstacle::After::leaves), 1.0);
  ASSERT_TRUE(left);
  ASSERT_EQ(left->motion.size(), 3U);
  EXPECT_EQ(left->motion[0].t, 1.0);
}

TEST(AdvancedObstacle, VanishesOrStays) {
  EXPECT_EQ(advanced(walker(MovingObstacle::After::leaves), 8.0)->motion.size(), 1U);
  EXPECT_FALSE(advanced(walker(MovingObstacle::After::leaves), 8.1));
  const auto stays = advanced(walker(MovingObstacle::After::stays), 9.0);
  ASSERT_TRUE(stays);
  ASSERT_EQ(stays->motion.size(), 1U);
  EXPECT_EQ(stays->motion[0].t, 0.0);
  EXPECT_EQ(stays->motion[0].position.y(), 3.0);
}

TEST(Advance, ARobotWithoutAPlanThatIsServedWhereItStandsDoesNotGrow) {
  Robot waiting = robot();
  waiting.via[0].position = waiting.start.position;
  waiting.via[0].radius_after = 0.9;
  const Robot next = advanced(waiting, {{}, false}, moment(6.0));
  EXPECT_EQ(next.radius, waiting.radius);
  EXPECT_EQ(next.goal_count(), 2U);
  EXPECT_EQ(next.via[0].service, 0.0);
  EXPECT_EQ(next.via[0].radius_after, 0.9);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
