// Robots that need some way to stop: what they are committed to, and which robots cannot avoid each other.

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "core/advance/advance.h"
#include "core/advance/timeline.h"
#include "tests/core/advance/driving_fleet.h"

namespace fleetplan::core {
namespace TEST_FILE {

using Type = Action::Type;

TEST(StopDistance, NoCommitmentEndsSooner) {
  DrivingFleet line;
  line.add_on_line(1.0, 9.0, 0.5);
  for (const auto& [commit, until] : {std::pair{0.0, 0.5}, {0.3, 0.5}, {0.8, 0.8}}) {
    const Robot next = line.advance(2.0, commit)[0];
    EXPECT_DOUBLE_EQ(next.committed_until(), until);
    EXPECT_DOUBLE_EQ(next.committed_end().position.x(), 3.0 + until);
    ASSERT_EQ(next.previous->size(), 2U);
    EXPECT_DOUBLE_EQ(next.previous->at(1).t_start, until);
  }
}

TEST(StopDistance, ARobotStopsWhereItsPlanStopsIt) {
  DrivingFleet line;
  line.add_on_line(1.0, 9.0, 0.5);
  EXPECT_DOUBLE_EQ(line.advance(7.75, 0.0)[0].committed_until(), 0.25);
}

TEST(StopDistance, OneThatIsAboutToSetOutNeedNot) {
  DrivingFleet line;
  line.add_on_line(1.0, 9.0, 0.5);
  EXPECT_TRUE(line.advance(0.0, 0.0)[0].committed.empty());
  line.robots[0].committed = {line.executions[0].actions[0]};  // it was under way
  EXPECT_DOUBLE_EQ(line.advance(0.0, 0.0)[0].committed_until(), 0.5);
}

TEST(StopDistance, ARobotKnowsWhetherItDrives) {
  DrivingFleet line;
  line.add_on_line(1.0, 9.0, 0.5);
  const auto committed_until = [&](double progress, double speed) {
    line.executions[0].reported = ReportedState{{0, progress}, {}, {}};
    line.executions[0].speed = speed;
    return line.advance(2.0, 0.0)[0].committed_until();
  };
  EXPECT_DOUBLE_EQ(committed_until(0.25, 0.9), 0.5);
  EXPECT_DOUBLE_EQ(committed_until(0.25, -0.1), 0.5) << "backwards";
  EXPECT_EQ(committed_until(0.25, 0.0), 0.0) << "it has been stopped on its way";
  EXPECT_DOUBLE_EQ(committed_until(0.0, 0.1), 0.5) << "it has just set out";
  EXPECT_EQ(committed_until(0.0, 0.0), 0.0);
  EXPECT_EQ(committed_until(1.0, 0.9), 0.0) << "it has arrived";
}

TEST(StopDistance, OneThatStandsIsInNobodysWay) {
  DrivingFleet line;
  line.add_on_line(1.0, 9.0, 2.0);
  line.add_on_line(4.0, 4.0, 0.0);
  EXPECT_EQ(line.collisions(2.0, 0.0).size(), 1U);
  line.executions[0].reported = ReportedState{{0, 0.25}, {}, {}};
  line.executions[0].speed = 0.0;
  EXPECT_TRUE(line.collisions(2.0, 0.0).empty());
}

TEST(StopDistance, TranslationsThatGoOnAreOne) {
  DrivingFleet line;
  line.add_on_line(1.0, 9.0, 0.5);
  const Pose border = at_x(3.2);
  line.executions[0].actions = {{Type::translate, 0.0, 2.2, at_x(1.0), border},
                                {Type::translate, 2.2, 3.2, border, at_x(3.7)},
                                {Type::translate, 3.2, 4.2, at_x(3.7), at_x(9.0)}};
  const Robot next = line.advance(2.0, 0.0)[0];
  EXPECT_DOUBLE_EQ(next.committed_end().position.x(), 3.5);
  EXPECT_DOUBLE_EQ(next.committed_until(), 0.8);
  EXPECT_DOUBLE_EQ(line.advance(2.2, 0.0)[0].committed_end().position.x(), 3.7) << "on the border";
  line.executions[0].actions[1].t_start = 2.7;  // it stands there
  EXPECT_DOUBLE_EQ(line.advance(2.0, 0.0)[0].committed_end().position.x(), 3.2);
}

TEST(StopDistance, AnEarlyRobotDrivesOnWhereItsPlanHasNoStop) {
  DrivingFleet line;
  line.add_on_line(1.0, 9.0, 0.5);
  const Pose border = at_x(3.2);
  line.executions[0].actions = {{Type::translate, 0.0, 2.2, at_x(1.0), border},
                                {Type::translate, 2.2, 3.2, border, at_x(4.2)},
                                {Type::rotate, 3.2, 4.2, at_x(4.2), at_x(4.2, 1.0)}};
  line.executions[0].reported = ReportedState{{0, 2.0 / 2.2}, {}, {}};  // at 3 m, a second early
  const Robot next = line.advance(1.0, 0.0)[0];
  EXPECT_DOUBLE_EQ(next.committed_end().position.x(), 3.5);
  EXPECT_NEAR(next.committed_until(), 0.5, 1e-9);
  const auto& rest = *next.previous;
  const auto wait =
      std::find_if(rest.begin(), rest.end(), [](const Action& action) { return action.type == Type::wait; });
  ASSERT_NE(wait, rest.end());
  EXPECT_DOUBLE_EQ(wait->from.position.x(), 4.2) << "after the line";
  EXPECT_NEAR(wait->t_end, 2.2, 1e-9) << "it turns when it was to turn";
}

TEST(StopDistance, AHoldBeginsWhereTheRobotStands) {
  DrivingFleet line;
  line.add_on_line(1.0, 9.0, 0.5);
  line.executions[0].hold = 30.0;
  const Robot next = line.advance(2.0, 1.0)[0];
  ASSERT_EQ(next.committed.size(), 2U);
  EXPECT_DOUBLE_EQ(next.committed[0].to.position.x(), 3.5);
  EXPECT_EQ(next.committed[1].type, Type::wait);
  EXPECT_EQ(next.committed[1].t_end, 30.0);
  EXPECT_DOUBLE_EQ(next.previous->at(2).t_end, 30.0 + 5.5);
  line.executions[0].hold = 0.2;
  EXPECT_DOUBLE_EQ(line.advance(2.0, 0.0)[0].committed_until(), 0.5) << "it cannot stop so soon";
}

TEST(StopDistance, ALateRobotDrivesOnFromWhereItIs) {
  DrivingFleet line;
  line.add_on_line(1.0, 9.0, 0.5);
  line.executions[0].measured = at_x(2.5);
  EXPECT_DOUBLE_EQ(line.advance(2.0, 0.0)[0].committed_end().position.x(), 3.0);
  line.executions[0].measured = Pose{{2.5, 1.5}, 0.0};  // beside its path
  EXPECT_TRUE(line.advance(2.0, 0.0)[0].committed.empty());
}

TEST(StopDistance, OneThatStandsOrTurnsHasNothingToDo) {
  DrivingFleet line;
  line.add_on_line(1.0, 1.0, 0.5);
  line.executions[0].actions = {{Type::wait, 0.0, 4.0, at_x(1.0), at_x(1.0)},
                                {Type::rotate, 4.0, 5.0, at_x(1.0), at_x(1.0, 1.0)}};
  for (const double at : {1.0, 4.5, 9.0}) EXPECT_TRUE(line.advance(at, 0.0)[0].committed.empty());
}

TEST(StopDistance, OneThatCanStopDoesBeforeOneThatCannot) {
  DrivingFleet line;
  line.add_on_line(1.0, 9.0, 2.0);
  line.add_on_line(9.0, 1.0, 0.1);
  // At 3 m and 7 m after two seconds, and 3.5 m apart. The first one drives to 5 m.
  const auto next = line.advance(2.0, 3.0);
  EXPECT_DOUBLE_EQ(next[0].committed_until(), 2.0);
  EXPECT_NEAR(next[1].committed_until(), 1.5, 1e-6);
  EXPECT_TRUE(line.collisions(2.0, 3.0).empty());
}

TEST(StopDistance, MarginsGiveWayButNotDisks) {
  DrivingFleet line;
  line.add_on_line(1.0, 9.0, 1.0);
  line.add_on_line(4.6, 4.6, 0.0);
  line.inflation = 0.1;
  EXPECT_DOUBLE_EQ(line.advance(2.0, 3.0)[0].committed_until(), 1.0);
  EXPECT_TRUE(line.collisions(2.0, 3.0).empty()) << "it stands before the other one, within its inflation";
}

TEST(StopDistance, TwoThatCannotStopAreNamedAndTheirCommitmentsEndWhereTheyTouch) {
  DrivingFleet line;
  line.add_on_line(1.0, 9.0, 2.0);
  line.add_on_line(7.0, 1.0, 2.0);
  // At 3 m and 5 m, 1.5 m apart.
  for (const Robot& next : line.advance(2.0, 1.0)) EXPECT_NEAR(next.committed_until(), 0.75, 1e-6);
  const auto collisions = line.collisions(2.0, 1.0);
  ASSERT_EQ(collisions.size(), 1U);
  EXPECT_EQ(collisions[0].first, 0U);
  EXPECT_EQ(collisions[0].second, 1U);
  EXPECT_NEAR(collisions[0].t, 0.75, 1e-6);
}

TEST(StopDistance, OneBehindStopsBeforeThoseThatCollide) {
  DrivingFleet line;
  line.add_on_line(1.0, 9.0, 2.0);
  line.add_on_line(7.0, 1.0, 2.0);
  line.add_on_line(0.3, 8.0, 0.2);
  EXPECT_EQ(line.collisions(2.0, 1.0).size(), 1U);
  // At 2.3 m; the first one ends at 3.75 m.
  const double until = line.advance(2.0, 3.0)[2].committed_until();
  EXPECT_LE(until, 3.75 - 0.5 - 2.3 + 1e-6);
  EXPECT_GE(until, 0.2 - 1e-6) << "it cannot stop sooner";
}

TEST(StopDistance, OneThatCannotStopBeforeARobotWithoutCommitmentIsNamedWithIt) {
  DrivingFleet line;
  line.add_on_line(0.0, 9.0, 2.7);
  line.add_on_line(3.0, 9.0, 1.0);
  line.add_on_line(5.4, 5.4, 0.0);
  // At 2 m and 5 m. The second one overlaps the third, and is not committed, but would drive to 6 m.
  const auto next = line.advance(2.0, 0.0);
  EXPECT_DOUBLE_EQ(next[0].committed_end().position.x(), 4.7);
  EXPECT_TRUE(next[1].committed.empty());
  const auto collisions = line.collisions(2.0, 0.0);
  ASSERT_EQ(collisions.size(), 2U);
  EXPECT_EQ(std::pair(collisions[0].first, collisions[0].second), std::pair(std::size_t{0}, std::size_t{1}));
  EXPECT_NEAR(collisions[0].t, 2.5, 1e-5);
  EXPECT_EQ(collisions[1].t, 0.0);
}

TEST(StopDistance, ACommitmentTowardsOneThatMayLeaveStays) {
  DrivingFleet line;
  line.add_on_line(1.0, 9.0, 2.0);
  line.add_on_line(4.5, 4.5, 0.0);
  const auto next = line.advance(2.0, 0.0);
  EXPECT_DOUBLE_EQ(next[0].committed_until(), 2.0);
  const auto collisions = line.collisions(2.0, 0.0);
  ASSERT_EQ(collisions.size(), 1U);
  EXPECT_NEAR(collisions[0].t, 1.0, 1e-6);
  line.robots[1].goal.reset();
  EXPECT_NEAR(line.advance(2.0, 0.0)[0].committed_until(), 1.0, 1e-6) << "one without a goal never leaves";
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
