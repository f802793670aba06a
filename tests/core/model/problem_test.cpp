#include "core/model/problem.h"

#include <gtest/gtest.h>

#include "tests/support/ascii_map.h"
#include "tests/support/problem_builder.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::robot_at;
using Kind = ProblemFault::Kind;

OccupancyGrid room() {
  return support::ascii_map({".......",  //
                             "...#...",  //
                             ".......",  //
                             "......."});
}

ProblemFaults all_faults_of(OccupancyGrid grid, std::vector<Robot> robots,
                            const StopCondition& stop = StopCondition::never()) {
  auto problem = Problem::create(std::move(grid), std::move(robots), stop);
  if (auto* faults = std::get_if<ProblemFaults>(&problem)) return *faults;
  return {};
}

std::vector<ProblemFault> faults_of(OccupancyGrid grid, std::vector<Robot> robots) {
  return all_faults_of(std::move(grid), std::move(robots)).listed;
}

void expect_fault(const ProblemFault& fault, Kind kind, std::size_t robot, std::size_t other, double gap) {
  EXPECT_EQ(static_cast<int>(fault.kind), static_cast<int>(kind));
  EXPECT_EQ(fault.robot, robot);
  EXPECT_EQ(fault.other, other);
  EXPECT_NEAR(fault.gap, gap, 1e-9);
}

TEST(Problem, KeepsTheMapAndTheRobots) {
  auto created = Problem::create(room(), {robot_at(1, 1, 0.5).to(5, 1), robot_at(6, 3).radius(0.2)},
                                 StopCondition::never());
  const auto* problem = std::get_if<Problem>(&created);
  ASSERT_NE(problem, nullptr);
  EXPECT_EQ(problem->grid().columns(), 7);
  ASSERT_EQ(problem->robots().size(), 2u);
  EXPECT_EQ(problem->robots()[0].start.theta, 0.5);
  EXPECT_EQ(problem->robots()[0].goal->position, Position(5, 1));
  EXPECT_FALSE(problem->robots()[1].goal);
}

TEST(Problem, HasAFaultWhereAStartOverlapsABlockedCell) {
  const auto faults = faults_of(room(), {robot_at(1, 1), robot_at(2.75, 2.5).to(1, 3)});
  ASSERT_EQ(faults.size(), 1u);
  expect_fault(faults[0], Kind::start_in_obstacle, 1, 0, -0.15);
}

TEST(Problem, HasAFaultWhereAStartLeavesTheMap) {
  const auto faults = faults_of(room(), {robot_at(0.1, 1), robot_at(-2.0, 2.0)});
  ASSERT_EQ(faults.size(), 2u);
  expect_fault(faults[0], Kind::start_in_obstacle, 0, 0, -0.3);
  expect_fault(faults[1], Kind::start_in_obstacle, 1, 0, -2.4);
}

TEST(Problem, HasAFaultWhereAGoalOverlapsABlockedCellOrLeavesTheMap) {
  const auto faults = faults_of(room(), {robot_at(1, 1).to(3.5, 2.5), robot_at(5, 1).to(5, 4.0)});
  ASSERT_EQ(faults.size(), 2u);
  expect_fault(faults[0], Kind::goal_in_obstacle, 0, 0, -0.4);
  expect_fault(faults[1], Kind::goal_in_obstacle, 1, 0, -0.4);
}

TEST(Problem, HasAFaultOfTheLaterRobotWhereTwoStartsOverlap) {
  const auto faults = faults_of(room(), {robot_at(1, 1), robot_at(5, 1), robot_at(1.5, 1).radius(0.3)});
  ASSERT_EQ(faults.size(), 1u);
  expect_fault(faults[0], Kind::starts_overlap, 2, 0, -0.2);
}

TEST(Problem, HasAFaultWhereTwoGoalsOverlapButNotForParkedRobots) {
  const auto faults = faults_of(room(), {robot_at(1, 1).to(5, 1), robot_at(1, 3).to(5, 1.5), robot_at(5, 3)});
  ASSERT_EQ(faults.size(), 1u);
  expect_fault(faults[0], Kind::goals_overlap, 1, 0, -0.3);
}

TEST(Problem, ListsAllFaultsInTheOrderOfTheRobots) {
  const auto faults =
      faults_of(room(), {robot_at(0.1, 1).to(3.5, 2.5), robot_at(0.2, 1).to(3.5, 2.5), robot_at(6, 1)});
  std::vector<int> kinds;
  for (const ProblemFault& fault : faults) kinds.push_back(static_cast<int>(fault.kind));
  const std::vector<int> expected{
      static_cast<int>(Kind::start_in_obstacle), static_cast<int>(Kind::goal_in_obstacle),
      static_cast<int>(Kind::start_in_obstacle), static_cast<int>(Kind::goal_in_obstacle),
      static_cast<int>(Kind::starts_overlap),    static_cast<int>(Kind::goals_overlap)};
  EXPECT_EQ(kinds, expected);
  EXPECT_EQ(faults[1].robot, 0u);
  EXPECT_EQ(faults[2].robot, 1u);
}

TEST(Problem, HasNoFaultWhereDisksAndWallsTouch) {
  EXPECT_TRUE(faults_of(room(), {robot_at(0.4, 0.4).to(2.6, 2.5), robot_at(1.2, 0.4).to(2.6, 3.3)}).empty());
  EXPECT_TRUE(faults_of(room(), {robot_at(1, 1), robot_at(1.8 - 4e-7, 1)}).empty()) << "rounded input";
  EXPECT_EQ(faults_of(room(), {robot_at(1, 1), robot_at(1.8 - 6e-7, 1)}).size(), 1u);
  EXPECT_TRUE(faults_of(room(), {robot_at(0.4 - 4e-7, 1)}).empty());
  EXPECT_EQ(faults_of(room(), {robot_at(0.4 - 6e-7, 1)}).size(), 1u);
}

TEST(Problem, HasNoFaultWhereAGoalIsTheStartOfAnotherRobot) {
  EXPECT_TRUE(faults_of(room(), {robot_at(1, 1).to(5, 1), robot_at(5, 1).to(1, 1)}).empty());
}

TEST(Problem, ListsTwentyFaultsAndCountsAll) {
  const std::vector<Robot> heap(2000, robot_at(1, 1));
  const ProblemFaults faults = all_faults_of(room(), heap);
  EXPECT_EQ(faults.listed.size(), 20u);
  EXPECT_EQ(faults.total, 1'999'000u) << "pairs";
  EXPECT_TRUE(faults.finished);
}

TEST(Problem, IsNotMadeWhenTheStopConditionIsMetFirst) {
  const StopCondition met(StopCondition::Clock::now());
  const ProblemFaults faults = all_faults_of(room(), {robot_at(1, 1)}, met);
  EXPECT_FALSE(faults.finished);
  EXPECT_EQ(faults.total, 0u);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
