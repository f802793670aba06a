#include <gtest/gtest.h>

#include <chrono>

#include "core/plan/planner.h"
#include "tests/core/plan/fleets.h"
#include "tests/core/support/planning.h"
#include "tests/support/ascii_map.h"
#include "tests/support/expect_safe.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::make_problem;
using support::robot_at;
using Mode = PlanOptions::Mode;
using Replan = PlanOptions::Replan;

constexpr std::size_t kRobots = 20;

/// A crowd with plans that hold.
Problem crowd_under_way(std::uint64_t seed, const PlanOptions& options = {}) {
  const Problem problem = crowd(kRobots, seed);
  const Plan plan = core::plan(problem, options, StopCondition::never());
  EXPECT_TRUE(plan.unplanned.empty());
  return make_problem(problem.grid(), with_previous(problem, plan));
}

StopCondition after_milliseconds(int milliseconds) {
  return StopCondition(StopCondition::Clock::now() + std::chrono::milliseconds(milliseconds));
}

TEST(Replanning, ReturnsPreviousPlansThatHoldToTheLastDigit) {
  const Problem problem = crowd_under_way(1);
  const Plan plan = core::plan(problem, {}, StopCondition::never());
  EXPECT_TRUE(plan.unplanned.empty());
  EXPECT_TRUE(plan.deterministic);
  EXPECT_EQ(count_followed(problem, plan), kRobots);
  support::expect_safe(problem, plan);
}

TEST(Replanning, ReturnsPreviousPlansThatHoldEvenIfTheBudgetIsSpent) {
  const Problem problem = crowd_under_way(2);
  for (const Replan replan : {Replan::all, Replan::where_needed}) {
    PlanOptions options;
    options.replan = replan;
    EXPECT_EQ(count_followed(problem, core::plan(problem, options, after_milliseconds(-1))), kRobots);
    options.mode = Mode::anytime;
    const Plan plan = core::plan(problem, options, after_milliseconds(1));
    EXPECT_TRUE(plan.unplanned.empty());
  }
}

TEST(Replanning, ReturnsPreviousPlansWhileTheServiceShutsDown) {
  const Problem problem = crowd_under_way(2);
  EXPECT_EQ(count_followed(problem, core::plan(problem, {}, met())), kRobots);
}

TEST(Replanning, DoesNotKeepAPlanThroughARobotThatStaysAsItsGoalIsBlocked) {
  const OccupancyGrid hall(10, 4, 1.0);
  std::vector<Robot> robots{robot_at(0.5, 1.5).to(9.5, 1.5), robot_at(4.5, 1.5).to(6.5, 3.5),
                            robot_at(6.5, 3.5)};
  robots[0].previous = {{Action::Type::translate, 0.0, 9.0, robots[0].start, {Position(9.5, 1.5), 0.0}}};
  const Problem problem = make_problem(hall, robots);
  for (const int budget_ms : {1000, -1}) {
    const Plan plan = core::plan(problem, {}, after_milliseconds(budget_ms));
    support::expect_safe(problem, plan);
    ASSERT_FALSE(plan.unplanned.empty());
    EXPECT_EQ(plan.unplanned.back().robot, 1u);
  }
}

TEST(Replanning, NamesTheVisitsOfPreviousPlans) {
  const Problem problem = crowd_under_way(3);
  const Plan plan = core::plan(problem, {}, StopCondition::never());
  for (const RobotPlan& robot : plan.plans) {
    ASSERT_EQ(robot.visits.size(), 1u);
    EXPECT_EQ(robot.visits[0].goal, 0u);
    EXPECT_EQ(robot.visits[0].t_leave, kForever);
    EXPECT_LE(robot.visits[0].t_arrive, robot.cost);
  }
}

TEST(Replanning, ImprovesPreviousPlansInModeAnytime) {
  for (const auto objective : {PlanOptions::Objective::flowtime, PlanOptions::Objective::makespan}) {
    const Problem problem = crowd_under_way(4);
    PlanOptions options;
    options.objective = objective;
    const Plan before = core::plan(problem, options, StopCondition::never());
    options.mode = Mode::anytime;
    options.max_iterations = 200;
    const Plan after = core::plan(problem, options, StopCondition::never());
    support::expect_safe(problem, after);
    EXPECT_TRUE(after.unplanned.empty());
    if (objective == PlanOptions::Objective::flowtime) {
      EXPECT_LE(after.objectives.flowtime, before.objectives.flowtime + 1e-9);
    } else {
      EXPECT_LE(after.objectives.makespan, before.objectives.makespan + 1e-9);
    }
    EXPECT_GT(after.search.improvements, 0);
  }
}

TEST(Replanning, WhereNeededLeavesPlansThatHoldAlone) {
  const Problem problem = crowd_under_way(4);
  PlanOptions options;
  options.mode = Mode::anytime;
  options.replan = Replan::where_needed;
  options.max_iterations = 200;
  const Plan plan = core::plan(problem, options, StopCondition::never());
  EXPECT_EQ(count_followed(problem, plan), kRobots);
  EXPECT_TRUE(plan.search.exhausted);
}

/// The crowd, where one robot has another goal and no previous plan.
Problem crowd_with_new_goal(std::uint64_t seed) {
  const Problem before = crowd_under_way(seed);
  std::vector<Robot> robots = before.robots();
  robots[7].goal = Goal{robots[7].start.position, std::nullopt};
  for (int column = 0;; ++column) {
    const Position free = before.grid().center({column, 10});
    const bool is_free = std::none_of(robots.begin(), robots.end(), [&](const Robot& robot) {
      return (robot.goal->position - free).norm() < 0.9;
    });
    if (!is_free) continue;
    robots[7].goal->position = free;
    robots[7].previous.reset();
    return make_problem(before.grid(), robots);
  }
}

TEST(Replanning, PlansARobotWithANewGoalAroundTheOthers) {
  for (std::uint64_t seed = 10; seed < 20; ++seed) {
    const Problem problem = crowd_with_new_goal(seed);
    for (const Mode mode : {Mode::first, Mode::anytime}) {
      PlanOptions options;
      options.mode = mode;
      options.replan = Replan::where_needed;
      options.max_iterations = 50;
      const Plan plan = core::plan(problem, options, StopCondition::never());
      EXPECT_TRUE(plan.unplanned.empty());
      EXPECT_EQ(count_followed(problem, plan), kRobots - 1) << "seed " << seed;
      support::expect_safe(problem, plan);
    }
  }
}

TEST(Replanning, PlansAFewRobotsEvenIfTheBudgetIsSpent) {
  const Problem problem = crowd_with_new_goal(10);
  const Plan plan = core::plan(problem, {}, after_milliseconds(-1));
  support::expect_safe(problem, plan);
  EXPECT_GE(count_followed(problem, plan), kRobots / 2);
}

TEST(Replanning, KeepsWhatIsCertainIfPlanningIsCancelled) {
  const Problem problem = crowd_with_new_goal(10);
  const Plan plan = core::plan(problem, {}, met());
  support::expect_safe(problem, plan);
  EXPECT_EQ(count_followed(problem, plan), plan.plans.size());
  EXPECT_GE(plan.plans.size(), kRobots / 2);
  EXPECT_FALSE(plan.deterministic);
}

/// The crowd, where one robot stands still for 12 s before it goes on.
Problem crowd_with_late_robot(std::uint64_t seed) {
  const Problem before = crowd_under_way(seed);
  std::vector<Robot> robots = before.robots();
  Robot& late = robots[3];
  late.previous = delayed(late, *late.previous, 12.0);
  late.committed = {late.previous->front()};
  return make_problem(before.grid(), robots);
}

TEST(Replanning, PlansAroundALateRobot) {
  for (std::uint64_t seed = 30; seed < 40; ++seed) {
    const Problem problem = crowd_with_late_robot(seed);
    PlanOptions options;
    options.replan = Replan::where_needed;
    options.start_safe_interval = 0.0;
    const Plan plan = core::plan(problem, options, StopCondition::never());
    EXPECT_TRUE(plan.unplanned.empty());
    EXPECT_GE(count_followed(problem, plan), kRobots - 4) << "seed " << seed;
    support::expect_safe(problem, plan);
  }
}

TEST(Replanning, KeepsSequencesOfGoalsWithServices) {
  std::vector<Robot> robots{robot_at(0.5, 0.5).to(8.5, 0.5), robot_at(0.5, 2.5).to(8.5, 2.5)};
  robots[0].via = {{Position(4.5, 0.5), std::nullopt, 2.0, 0.0}, {Position(4.5, 2.5), 0.0, 1.0, 12.0}};
  robots[1].via = {{Position(4.5, 1.5), std::nullopt, 5.0, 0.0}};
  robots[1].goal->service = 2.5;
  const OccupancyGrid grid(10, 4, 1.0);
  const Problem before = make_problem(grid, robots);
  const Plan first = core::plan(before, {}, StopCondition::never());
  ASSERT_TRUE(first.unplanned.empty());
  const Problem problem = make_problem(grid, with_previous(before, first));
  for (const auto& stop : {StopCondition::never(), after_milliseconds(-1)}) {
    const Plan plan = core::plan(problem, {}, stop);
    ASSERT_EQ(count_followed(problem, plan), 2u);
    for (std::size_t i = 0; i < 2; ++i) {
      ASSERT_EQ(plan.plans[i].visits.size(), first.plans[i].visits.size());
      for (std::size_t k = 0; k < plan.plans[i].visits.size(); ++k) {
        EXPECT_EQ(plan.plans[i].visits[k].t_arrive, first.plans[i].visits[k].t_arrive);
        EXPECT_EQ(plan.plans[i].visits[k].t_leave, first.plans[i].visits[k].t_leave);
      }
    }
  }
}

TEST(Replanning, KeepsPlansMadeWithInflationMarginAndAddedWaits) {
  PlanOptions options;
  options.inflation = 0.02;
  options.wait_before_move = 0.5;
  options.interval_margin = 0.5;
  const Problem problem = crowd_under_way(5, options);
  EXPECT_EQ(count_followed(problem, core::plan(problem, options, StopCondition::never())), kRobots);
}

TEST(Replanning, LeavesOutAPlanThroughAMovingObstacle) {
  std::vector<Robot> robots{robot_at(0.5, 1.5).to(8.5, 1.5), robot_at(0.5, 3.5).to(8.5, 3.5)};
  const OccupancyGrid grid(9, 5, 1.0);
  const Problem before = make_problem(grid, robots);
  robots = with_previous(before, core::plan(before, {}, StopCondition::never()));
  MovingObstacle person{"person", 0.3, {{3.0, Position(4.5, 0.5)}, {6.0, Position(4.5, 1.5)}}};
  auto problem = Problem::create(grid, robots, ProblemConditions{{person}}, StopCondition::never());
  ASSERT_TRUE(std::holds_alternative<Problem>(problem));
  const Plan plan = core::plan(std::get<Problem>(problem), {}, StopCondition::never());
  EXPECT_EQ(plan.plans.size(), 2u);
  EXPECT_EQ(count_followed(std::get<Problem>(problem), plan), 1u);
}

TEST(Replanning, MovesARobotThatIsInTheWayOfAnother) {
  // The second robot rests at its goal in the corridor; the first one has to pass.
  std::vector<Robot> robots{robot_at(0.5, 1.5).to(8.5, 1.5), robot_at(4.5, 1.5).to(4.5, 1.5)};
  robots[1].previous = std::vector<Action>{};
  const Problem problem = make_problem(support::ascii_map({"#########",  //
                                                           ".........",  //
                                                           "####.####"}),
                                       robots);
  PlanOptions options;
  options.replan = Replan::where_needed;
  const Plan plan = core::plan(problem, options, StopCondition::never());
  EXPECT_TRUE(plan.unplanned.empty());
  ASSERT_EQ(plan.plans.size(), 2u);
  EXPECT_FALSE(plan.plans[1].actions.empty()) << "it enters the bay and comes back";
  support::expect_safe(problem, plan);
}

TEST(Replanning, KeepsWhatHoldsWhenAnotherRobotHasNoWay) {
  std::vector<Robot> robots{robot_at(0.5, 2.5).to(8.5, 2.5), robot_at(0.5, 0.5).to(4.5, 0.5)};
  const auto map = support::ascii_map({"........#",  //
                                       "########.",  //
                                       "........."});
  robots[1].previous =
      core::plan(make_problem(map, {robots[1]}), {}, StopCondition::never()).plans.at(0).actions;
  robots[0].goal->position = Position(8.5, 1.5);
  const Problem problem = make_problem(map, robots);
  const Plan plan = core::plan(problem, {}, StopCondition::never());
  ASSERT_EQ(plan.plans.size(), 1u);
  EXPECT_EQ(count_followed(problem, plan), 1u);
  EXPECT_EQ(plan.unplanned.at(0).robot, 0u);
}

TEST(Replanning, ChangesAPlanThroughARobotThatHasNoWay) {
  const auto map = support::ascii_map({".........",  //
                                       "#########",  //
                                       ".........",  //
                                       "........."});
  std::vector<Robot> robots{robot_at(0.5, 0.5).to(8.5, 0.5), robot_at(4.5, 0.5).to(4.5, 3.5)};
  robots[0].previous =
      core::plan(make_problem(map, {robots[0]}), {}, StopCondition::never()).plans.at(0).actions;
  const Problem problem = make_problem(map, robots);
  const Plan plan = core::plan(problem, {}, StopCondition::never());
  ASSERT_EQ(plan.plans.size(), 1u);
  EXPECT_EQ(count_followed(problem, plan), 0u) << "it drives around robot 1";
  support::expect_safe(problem, plan);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
