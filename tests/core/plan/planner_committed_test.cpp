// Plans around committed motion and moving obstacles, and collisions that no plan can avoid.

#include <gtest/gtest.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/explain/unavoidable_collisions.h"
#include "core/model/plan.h"
#include "core/plan/planner.h"
#include "core/verify/verify.h"
#include "tests/core/support/planning.h"
#include "tests/support/ascii_map.h"
#include "tests/support/problem_builder.h"
#include "tests/support/random_problem.h"
#include "tests/support/summary.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::robot_at;
using Reason = Unplanned::Reason;
using Robots = std::vector<std::size_t>;

void expect_valid(const Problem& problem, const Plan& plan) {
  CheckRules rules;
  rules.tolerances = plan_tolerances(problem.grid(), problem.robots(), plan.plans);
  rules.exact_commitments = true;
  rules.exempt = plan.unavoidable;
  const auto report = verify({problem.grid(), problem.robots(), problem.obstacles()}, plan.plans, rules,
                             StopCondition::never());
  ASSERT_TRUE(report);
  EXPECT_TRUE(report->valid()) << support::text(*report);
}

Plan checked_plan(const Problem& problem, const PlanOptions& options = {},
                  const StopCondition& stop = StopCondition::never()) {
  Plan plan = core::plan(problem, options, stop);
  EXPECT_EQ(plan.plans.size() + plan.unplanned.size(), problem.robots().size());
  expect_valid(problem, plan);
  return plan;
}

/// Motion has no start safe interval by default.
PlanOptions in_motion() {
  PlanOptions options;
  options.start_safe_interval = 0.0;
  return options;
}

MovingObstacle person(std::vector<MovingObstacle::Entry> motion,
                      MovingObstacle::After after = MovingObstacle::After::leaves) {
  return {"person", 0.3, std::move(motion), after};
}

Problem with_obstacles(OccupancyGrid grid, std::vector<Robot> robots, std::vector<MovingObstacle> obstacles) {
  ProblemConditions conditions;
  conditions.obstacles = std::move(obstacles);
  return support::make_problem(std::move(grid), std::move(robots), std::move(conditions));
}

const Unplanned* unplanned(const Plan& plan, std::size_t robot) {
  for (const Unplanned& entry : plan.unplanned) {
    if (entry.robot == robot) return &entry;
  }
  return nullptr;
}

void expect_in_the_way(const Plan& plan, std::size_t robot, const Robots& blocked_by) {
  const Unplanned* entry = unplanned(plan, robot);
  ASSERT_NE(entry, nullptr);
  EXPECT_EQ(static_cast<int>(entry->reason), static_cast<int>(Reason::committed_in_the_way)) << entry->detail;
  EXPECT_EQ(entry->blocked_by, blocked_by);
}

TEST(PlannerCommitted, ALoadPickedUpWhereACommitmentEndsMeetsARobotThatCannotLeaveInTime) {
  Robot loading = robot_at(1.5, 4.5).to(8.5, 4.5).drives(4.5, 4.5);
  loading.via = {Goal{{4.5, 4.5}, {}, 0.0, 0.0, 1.2}};
  const Robot slow = robot_at(4.5, 5.9).speeds(0.01, 0.01).to(4.5, 8.5);
  const Problem problem = support::make_problem(OccupancyGrid(10, 10, 1.0), {loading, slow});
  const Plan plan = checked_plan(problem, in_motion());
  ASSERT_EQ(plan.unavoidable.size(), 1u);
  EXPECT_EQ(plan.unavoidable[0].robot, 1u);
  EXPECT_EQ(plan.unavoidable[0].other, 0u);
  EXPECT_NEAR(plan.unavoidable[0].t, 3.0, 1e-9);
  ASSERT_FALSE(plan.unplanned.empty());
  EXPECT_EQ(plan.unplanned.back().reason, Reason::committed_in_the_way);
}

TEST(PlannerCommitted, AnObstacleMayPassWhereALoadIsPickedUpForCertain) {
  Robot loading = robot_at(1.5, 4.5).to(8.5, 4.5).drives(4.5, 4.5);
  loading.via = {Goal{{4.5, 4.5}, {}, 0.0, 0.0, 1.2}};
  ProblemConditions conditions;
  conditions.obstacles = {person({{0.0, {4.5, 5.9}}, {60.0, {4.5, 5.9}}})};
  const Problem problem = support::make_problem(OccupancyGrid(10, 10, 1.0), {loading}, std::move(conditions));
  const Plan plan = checked_plan(problem, in_motion());
  ASSERT_EQ(plan.unavoidable.size(), 1u);
  EXPECT_NEAR(plan.unavoidable[0].t, 3.0, 1e-9);
}

TEST(PlannerCommitted, ARobotLeavesInTimeFromWhereCommittedMotionPasses) {
  const Problem problem = support::make_problem(
      support::ascii_map({".........",  //
                          "........."}),
      {robot_at(4.5, 0.5).to(8.5, 1.5), robot_at(8.5, 0.5, std::numbers::pi).to(0.5, 0.5).drives(0.5, 0.5)});
  const Plan plan = checked_plan(problem, in_motion());
  EXPECT_EQ(plan.plans.size(), 2u);
  EXPECT_TRUE(plan.unavoidable.empty());
}

TEST(PlannerCommitted, ARobotThatCannotLeaveInTimeIsInTheWayAndTheOthersArePlanned) {
  const Problem problem = support::make_problem(
      support::ascii_map({"#########.",  //
                          "..........",  //
                          "#########."}),
      {robot_at(3.5, 1.5).to(6.5, 1.5), robot_at(7.5, 1.5, std::numbers::pi).to(0.5, 1.5).drives(0.5, 1.5),
       robot_at(9.5, 0.5).to(9.5, 2.5)});
  const Plan plan = checked_plan(problem, in_motion());
  ASSERT_EQ(plan.plans.size(), 2u);
  expect_in_the_way(plan, 0, {1});
  ASSERT_EQ(plan.unavoidable.size(), 1u);
  EXPECT_EQ(plan.unavoidable[0].robot, 0u);
  EXPECT_EQ(plan.unavoidable[0].other, std::size_t{1});
  EXPECT_NEAR(plan.unavoidable[0].t, 4.0 - 0.8, 1e-5);
}

TEST(PlannerCommitted, AParkedRobotIsInTheWayOfAnObstacle) {
  const Problem problem =
      with_obstacles(OccupancyGrid(9, 3, 1.0), {robot_at(4.5, 1.5), robot_at(0.5, 0.5).to(8.5, 2.5)},
                     {person({{2.0, {0.5, 1.5}}, {10.0, {8.5, 1.5}}})});
  const Plan plan = checked_plan(problem);
  expect_in_the_way(plan, 0, {});
  EXPECT_EQ(plan.plans.size(), 1u);
  ASSERT_EQ(plan.unavoidable.size(), 1u);
  EXPECT_EQ(plan.unavoidable[0].obstacle, std::size_t{0});
  EXPECT_FALSE(plan.unavoidable[0].other);
  EXPECT_NEAR(plan.unavoidable[0].t, 2.0 + 4.0 - 0.7, 1e-5);
}

TEST(PlannerCommitted, AnObstacleThatAppearsOnTopOfARobot) {
  const Problem problem = with_obstacles(OccupancyGrid(9, 3, 1.0),
                                         {robot_at(4.5, 1.5).to(8.5, 1.5), robot_at(0.5, 0.5).to(0.5, 2.5)},
                                         {person({{0.0, {4.5, 1.5}}}, MovingObstacle::After::stays)});
  const Plan plan = checked_plan(problem);
  expect_in_the_way(plan, 0, {});
  EXPECT_EQ(plan.plans.size(), 1u);
  ASSERT_EQ(plan.unavoidable.size(), 1u);
  EXPECT_EQ(plan.unavoidable[0].t, 0.0);
}

TEST(PlannerCommitted, AnObstacleThatComesBackIsAnotherCollision) {
  const Problem problem = with_obstacles(
      OccupancyGrid(9, 3, 1.0), {robot_at(4.5, 1.5)},
      {person({{0.0, {0.5, 1.5}}, {8.0, {8.5, 1.5}}, {16.0, {0.5, 1.5}}, {17.0, {0.5, 0.5}}})});
  EXPECT_EQ(checked_plan(problem).unavoidable.size(), 2u);
}

TEST(PlannerCommitted, TheUnavoidableCollisionsOfARobotAreLimited) {
  std::vector<MovingObstacle> people;
  for (int k = 0; k < 30; ++k) {
    people.push_back(person({{3.0 * k, {0.5, 1.5}}, {3.0 * k + 8.0, {8.5, 1.5}}}));
  }
  const Problem problem = with_obstacles(OccupancyGrid(9, 3, 1.0), {robot_at(4.5, 1.5)}, people);
  EXPECT_EQ(checked_plan(problem).unavoidable.size(), kMaxUnavoidableOfRobot);
}

TEST(PlannerCommitted, ARobotWhoseCommitmentMeetsAnObstacleIsPlannedAfterIt) {
  const Problem problem =
      with_obstacles(OccupancyGrid(9, 5, 1.0), {robot_at(0.5, 1.5).to(8.5, 4.5).drives(5.5, 1.5)},
                     {person({{0.0, {3.5, 0.5}}, {12.0, {3.5, 4.5}}})});
  const Plan plan = checked_plan(problem);
  EXPECT_EQ(plan.plans.size(), 1u);
  ASSERT_EQ(plan.unavoidable.size(), 1u);
  EXPECT_EQ(plan.unavoidable[0].obstacle, std::size_t{0});
}

TEST(PlannerCommitted, AnUnplannedRobotExecutesItsCommitment) {
  const Problem problem = support::make_problem(
      support::ascii_map({".....#...",  //
                          ".....#...",  //
                          ".....#..."}),
      {robot_at(0.5, 1.5).to(8.5, 1.5).drives(3.5, 1.5), robot_at(3.5, 0.5).to(1.5, 1.5)});
  const Plan plan = checked_plan(problem, in_motion());
  ASSERT_NE(unplanned(plan, 0), nullptr);
  EXPECT_EQ(static_cast<int>(unplanned(plan, 0)->reason), static_cast<int>(Reason::goal_unreachable));
  EXPECT_EQ(plan.plans.size(), 1u) << "the other one gets past it";
}

TEST(PlannerCommitted, AnInvalidRobotStandsAsAnObstacle) {
  Robot wrong = robot_at(4.5, 0.5);
  wrong.invalid = true;
  const Problem problem =
      support::make_problem(OccupancyGrid(9, 3, 1.0), {wrong, robot_at(0.5, 0.5).to(8.5, 0.5)});
  const Plan plan = checked_plan(problem);
  ASSERT_NE(unplanned(plan, 0), nullptr);
  EXPECT_EQ(static_cast<int>(unplanned(plan, 0)->reason), static_cast<int>(Reason::invalid));
  EXPECT_EQ(plan.plans.size(), 1u);
}

TEST(PlannerCommitted, AnInvalidRobotBesideTheMapMeetsAnObstacleThere) {
  Robot wrong = robot_at(-0.8, 1.5);
  wrong.invalid = true;
  const Problem problem =
      with_obstacles(OccupancyGrid(9, 3, 1.0), {wrong}, {person({{0.0, {-0.8, -0.5}}, {4.0, {-0.8, 3.5}}})});
  EXPECT_EQ(checked_plan(problem).unavoidable.size(), 1u);
}

TEST(PlannerCommitted, ACommitmentThatEndsInTheWayOfAPreviousPlan) {
  // Robot 0 comes nearest to robot 1 at the end of its commitment, when robot 1 leaves by its previous plan.
  Robot leaving = robot_at(4.9, 0.5).to(8.5, 0.5);
  const Pose place = leaving.start;
  leaving.committed = {{Action::Type::wait, 0.0, 3.0, place, place}};
  leaving.previous = {leaving.committed[0],
                      {Action::Type::wait, 3.0, 4.0, place, place},
                      {Action::Type::translate, 4.0, 7.6, place, {{8.5, 0.5}, place.theta}}};
  const Problem problem = support::make_problem(OccupancyGrid(9, 3, 1.0),
                                                {robot_at(0.5, 0.5).to(0.5, 2.5).drives(4.5, 0.5), leaving});
  for (const int ms : {0, 1000}) {
    checked_plan(problem, in_motion(),
                 StopCondition(StopCondition::Clock::now() + std::chrono::milliseconds(ms)));
  }
}

TEST(PlannerCommitted, ARobotPassesWhereAnotherOneWillStayBeforeItArrives) {
  // Robot 1 is committed to close the gap at t = 20 and has no way from there to its goal.
  const Problem problem =
      support::make_problem(support::ascii_map({"....#....",  //
                                                ".........",  //
                                                "....#####"}),
                            {robot_at(1.5, 1.5).to(8.5, 1.5).waits(1.0),
                             robot_at(0.5, 0.5).waits(20.0).drives(0.5, 1.5).drives(4.5, 1.5)});
  const Plan plan = checked_plan(problem, in_motion());
  EXPECT_EQ(plan.plans.size(), 2u);
}

TEST(PlannerCommitted, APlanOfABudgetThatIsSpentHasTheUnavoidableCollisions) {
  const Problem problem = with_obstacles(OccupancyGrid(9, 3, 1.0),
                                         {robot_at(4.5, 1.5).to(8.5, 2.5), robot_at(0.5, 0.5).to(0.5, 2.5)},
                                         {person({{0.0, {4.5, 0.5}}, {3.0, {4.5, 2.5}}})});
  const Plan plan = checked_plan(problem, {}, met());
  EXPECT_EQ(plan.unplanned.size(), 2u);
  ASSERT_EQ(plan.unavoidable.size(), 1u);
  EXPECT_EQ(static_cast<int>(plan.unplanned[0].reason), static_cast<int>(Reason::budget_exhausted));
}

/// The actions that begin before `t`: what is under way is executed to its end.
std::vector<Action> committed_at(const RobotPlan& plan, double t) {
  std::vector<Action> committed;
  for (const Action& action : plan.actions) {
    if (action.t_start < t) committed.push_back(action);
  }
  return committed;
}

class CommittedFleet : public testing::TestWithParam<int> {};

TEST_P(CommittedFleet, OfAPlanCutAnywhereIsPlannedAndAccepted) {
  const auto seed = static_cast<std::uint64_t>(GetParam());
  SCOPED_TRACE("seed " + std::to_string(seed));
  support::Dice dice(seed);
  const Problem first = support::random_problem(dice, 12);
  const Plan before = core::plan(first, in_motion(), StopCondition::never());
  std::vector<Robot> robots = first.robots();
  const double t = dice.between(0.0, before.objectives.makespan + 1.0);
  for (const RobotPlan& plan : before.plans) {
    robots[plan.robot].committed = committed_at(plan, dice.chance(0.3) ? 0.5 * t : t);
  }
  auto made = Problem::create(first.grid(), robots, StopCondition::never());
  const auto* problem = std::get_if<Problem>(&made);
  if (problem == nullptr) return;  // cut at different times, commitments may meet
  const Plan plan = checked_plan(*problem, in_motion());
  for (const RobotPlan& robot : plan.plans) {
    EXPECT_GE(robot.actions.size(), robots[robot.robot].committed.size());
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, CommittedFleet, testing::Range(0, 60));

}  // namespace TEST_FILE
}  // namespace fleetplan::core
