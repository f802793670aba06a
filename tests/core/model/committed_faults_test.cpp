// Faults of committed motion in Problem::create.

#include <gtest/gtest.h>

#include <numbers>
#include <utility>
#include <variant>
#include <vector>

#include "core/model/problem.h"
#include "tests/support/ascii_map.h"
#include "tests/support/problem_builder.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::robot_at;
using Kind = ProblemFault::Kind;

constexpr double kPi = std::numbers::pi;

OccupancyGrid hall() {
  return support::ascii_map({"..........",  //
                             "..........",  //
                             "......#...",  //
                             "..........",  //
                             ".........."});
}

std::vector<ProblemFault> faults_of(std::vector<Robot> robots, ProblemConditions conditions = {}) {
  auto made = Problem::create(hall(), std::move(robots), std::move(conditions), StopCondition::never());
  if (auto* faults = std::get_if<ProblemFaults>(&made)) return faults->listed;
  return {};
}

void expect_collision(const std::vector<ProblemFault>& faults, std::size_t robot, std::size_t other, double t,
                      double gap) {
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_EQ(static_cast<int>(faults[0].kind), static_cast<int>(Kind::committed_collision));
  EXPECT_EQ(faults[0].robot, robot);
  EXPECT_EQ(faults[0].other, other);
  EXPECT_NEAR(faults[0].t, t, 1e-5);
  EXPECT_NEAR(faults[0].gap, gap, 1e-5);
}

/// A robot that is invalid, as its geometry is at fault.
Robot invalid(Robot robot) {
  robot.invalid = true;
  return robot;
}

TEST(CommittedFaults, TwoCommittedMotionsThatMeet) {
  expect_collision(faults_of({robot_at(1.5, 0.5).to(9.5, 4.5).drives(8.5, 0.5),
                              robot_at(8.5, 0.5, kPi).to(0.5, 4.5).drives(1.5, 0.5)}),
                   1, 0, (7.0 - 0.8) / 2.0, -0.8);
}

TEST(CommittedFaults, AreComparedWhileBothLast) {
  const Robot early = robot_at(1.5, 0.5).to(1.5, 4.5).drives(4.5, 0.5);  // until t = 3, then it may leave
  EXPECT_TRUE(faults_of({early, robot_at(9.5, 0.5, kPi).to(9.5, 4.5).drives(4.5, 0.5)}).empty());
  Robot parked = early;
  parked.goal.reset();
  expect_collision(faults_of({parked, robot_at(9.5, 0.5, kPi).to(9.5, 4.5).drives(4.5, 0.5)}), 1, 0, 4.2,
                   -0.8);
}

TEST(CommittedFaults, AMotionOverAParkedRobotButNotOverOneThatMayLeave) {
  const Robot passing = robot_at(0.5, 0.5).to(9.5, 4.5).drives(8.5, 0.5);
  expect_collision(faults_of({passing, robot_at(4.5, 0.5)}), 0, 1, 3.2, -0.8);
  EXPECT_TRUE(faults_of({passing, robot_at(4.5, 0.5).to(4.5, 4.5)}).empty());
  expect_collision(faults_of({passing, invalid(robot_at(4.5, 0.5).to(4.5, 4.5))}), 0, 1, 3.2, -0.8);
}

TEST(CommittedFaults, ContactIsAllowed) {
  EXPECT_TRUE(faults_of({robot_at(0.5, 0.5).to(9.5, 4.5).drives(8.5, 0.5), robot_at(4.5, 1.3)}).empty());
}

TEST(CommittedFaults, ALoadThatIsPickedUpWhereACommitmentEnds) {
  const auto loads_at = [](Robot robot, double x, double y) {
    robot.via = {Goal{{x, y}, {}, 0.0, 0.0, 0.45}};
    return robot;
  };
  const Robot loading = loads_at(robot_at(1.5, 0.5).to(9.5, 4.5).drives(4.5, 0.5), 4.5, 0.5);
  expect_collision(faults_of({loading, robot_at(4.5, 1.32)}), 0, 1, 3.0, -0.03);
  EXPECT_TRUE(faults_of({loading, robot_at(4.5, 1.36)}).empty()) << "there is room for the load";
  const Robot leaving = robot_at(4.5, 1.32).to(0.5, 3.5).waits(2.5);
  EXPECT_TRUE(faults_of({loading, leaving}).empty()) << "it may leave before";
  expect_collision(faults_of({loading, robot_at(4.5, 1.32).to(0.5, 3.5).waits(3.5)}), 1, 0, 3.0, -0.03);
  const Robot both = loads_at(robot_at(4.5, 1.36).to(0.5, 3.5).waits(3.0), 4.5, 1.36);
  expect_collision(faults_of({loading, both}), 1, 0, 3.0, -0.04);
}

TEST(CommittedFaults, AMotionIntoAWallOrOffTheMap) {
  expect_collision(faults_of({robot_at(2.5, 2.5).to(9.5, 4.5).drives(8.5, 2.5)}), 0, 0, 3.1, -0.4);
  const auto off = faults_of({robot_at(7.5, 0.5).to(9.5, 4.5).drives(9.9, 0.5)});
  expect_collision(off, 0, 0, 2.1, -0.3);
}

TEST(CommittedFaults, OfInvalidRobotsAreLeftOut) {
  EXPECT_TRUE(
      faults_of({invalid(robot_at(2.5, 2.5).to(9.5, 4.5).drives(8.5, 2.5)), robot_at(4.5, 2.5)}).empty());
}

TEST(CommittedFaults, StartsThatMayOverlapPartWithoutComingNearer) {
  ProblemConditions conditions;
  conditions.pair_overlap = 0.1;
  const Robot left = robot_at(4.0, 0.5, kPi).to(0.5, 4.5);
  const Robot right = robot_at(4.75, 0.5).to(9.5, 4.5).drives(8.5, 0.5);
  Robot parting = left;
  parting.committed = Robot(robot_at(4.0, 0.5, kPi).drives(1.5, 0.5)).committed;
  EXPECT_TRUE(faults_of({parting, right}, conditions).empty());
  Robot following = left;
  following.committed = Robot(robot_at(4.0, 0.5, 0.0).speeds(2.0, 1.0).drives(8.0, 0.5)).committed;
  following.start.theta = 0.0;
  const auto faults = faults_of({following, right}, conditions);
  ASSERT_EQ(faults.size(), 1u) << "it comes nearer at once";
  EXPECT_EQ(static_cast<int>(faults[0].kind), static_cast<int>(Kind::committed_collision));
  EXPECT_NEAR(faults[0].t, 0.0, 1e-5);
}

TEST(CommittedFaults, AStartThatMayOverlapAWallLeavesIt) {
  ProblemConditions conditions;
  conditions.wall_overlap = 0.1;
  const Robot leaving = robot_at(5.65, 2.5, kPi).to(0.5, 2.5).drives(2.5, 2.5);  // 0.05 m in the wall
  EXPECT_TRUE(faults_of({leaving}, conditions).empty());
  EXPECT_FALSE(faults_of({leaving}).empty());
  const Robot entering = robot_at(5.65, 2.5, 0.0).to(0.5, 2.5).drives(5.7, 2.5);
  EXPECT_EQ(faults_of({entering}, conditions).size(), 1u);
}

TEST(CommittedFaults, ACommitmentMayEndInAWallAsGoalsMay) {
  ProblemConditions conditions;
  conditions.wall_overlap_at_goal = 0.1;
  const Robot entering = robot_at(2.5, 2.5).to(5.65, 2.5).drives(5.65, 2.5);  // 0.05 m in the wall
  EXPECT_TRUE(faults_of({entering}, conditions).empty());
  Robot leaves_again = robot_at(2.5, 2.5).to(0.5, 2.5).drives(5.65, 2.5);
  EXPECT_TRUE(faults_of({leaves_again}, conditions).empty());
  EXPECT_EQ(faults_of({leaves_again}).size(), 1u);
  conditions.wall_overlap_at_goal = 0.04;
  EXPECT_EQ(faults_of({leaves_again}, conditions).size(), 1u);
}

TEST(CommittedFaults, ALastGoalMayOverlapAWall) {
  ProblemConditions conditions;
  conditions.wall_overlap_at_goal = 0.1;
  EXPECT_TRUE(faults_of({robot_at(2.5, 2.5).to(5.65, 2.5)}, conditions).empty());
  EXPECT_EQ(faults_of({robot_at(2.5, 2.5).to(5.75, 2.5)}, conditions).size(), 1u);
  Robot passes = robot_at(2.5, 2.5).to(0.5, 2.5);
  passes.via = {Goal{{5.65, 2.5}, {}}};
  EXPECT_EQ(faults_of({passes}, conditions).size(), 1u) << "it does not stay there";
  Robot yields = robot_at(2.5, 2.5).to(5.65, 2.5);
  yields.let_yield();
  EXPECT_EQ(faults_of({yields}, conditions).size(), 1u);
}

TEST(CommittedFaults, AGoalOfASequenceInAWallHasItsNumber) {
  Robot robot = robot_at(0.5, 0.5).to(9.5, 4.5);
  robot.via = {Goal{{2.5, 2.5}, {}}, Goal{{6.5, 2.5}, {}}};
  const auto faults = faults_of({robot});
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_EQ(static_cast<int>(faults[0].kind), static_cast<int>(Kind::goal_in_obstacle));
  EXPECT_EQ(faults[0].goal, 1u);
  Robot last = robot_at(0.5, 0.5).to(6.5, 2.5);
  last.via = {Goal{{2.5, 2.5}, {}}};
  EXPECT_EQ(faults_of({last}).at(0).goal, 1u);
}

TEST(CommittedFaults, OnlyLastGoalsMustNotOverlap) {
  Robot a = robot_at(0.5, 0.5).to(9.5, 4.5);
  a.via = {Goal{{2.5, 4.5}, {}}};
  Robot b = robot_at(4.5, 0.5).to(0.5, 4.5);
  b.via = {Goal{{2.5, 4.5}, {}}, Goal{{9.5, 4.5}, {}}};
  EXPECT_TRUE(faults_of({a, b}).empty());
}

TEST(CommittedFaults, OfThousandsOfRobotsAreFoundUnderTheStopCondition) {
  std::vector<Robot> robots;
  for (int i = 0; i < 200; ++i) {
    Robot robot = robot_at(0.5 + 0.04 * i, 0.5).radius(0.01).to(0.5 + 0.04 * i, 4.5);
    robot.committed = Robot(robot_at(0.5 + 0.04 * i, 0.5).drives(9.5, 4.5)).committed;
    robots.push_back(robot);
  }
  std::stop_source source;
  source.request_stop();
  const StopCondition met(StopCondition::Clock::time_point::max(), source.get_token());
  auto made = Problem::create(hall(), robots, {}, met);
  ASSERT_TRUE(std::holds_alternative<ProblemFaults>(made));
  EXPECT_FALSE(std::get<ProblemFaults>(made).finished);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
