// Fleets that are planned up to a horizon, round after round. Every plan is valid and can be executed as it
// is. In open maps, every robot arrives in the end.

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "core/model/itinerary.h"
#include "core/model/loads.h"
#include "core/plan/planner.h"
#include "core/verify/verify.h"
#include "tests/support/expect_replanned.h"
#include "tests/support/mazes.h"
#include "tests/support/moments.h"
#include "tests/support/moving_fleet.h"
#include "tests/support/random_problem.h"
#include "tests/support/summary.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::Dice;
using support::FleetRequest;

constexpr int kMaxRounds = 120;

/// Whether two plans are the same to the last digit.
bool same_plans(const Plan& a, const Plan& b) {
  return std::equal(a.plans.begin(), a.plans.end(), b.plans.begin(), b.plans.end(),
                    [](const RobotPlan& one, const RobotPlan& other) {
                      return one.cost == other.cost && one.estimated_cost == other.estimated_cost &&
                             std::equal(one.actions.begin(), one.actions.end(), other.actions.begin(),
                                        other.actions.end(), support::same);
                    });
}

/// The robot at a time of its plan, in this pose, with its goals from this number on.
Robot later(Robot robot, double t, const Pose& pose, std::size_t goal) {
  robot.start = pose;
  robot.committed.clear();
  robot.previous.reset();
  const auto served = static_cast<std::ptrdiff_t>(std::min(goal, robot.via.size()));
  robot.via.erase(robot.via.begin(), robot.via.begin() + served);
  for (Goal& via : robot.via) via.not_before = std::max(0.0, via.not_before - t);
  robot.goal->not_before = std::max(0.0, robot.goal->not_before - t);
  return robot;
}

/// What a robot has left to do, alone on the map, seconds.
std::optional<double> time_left(const Problem& problem, const PlanOptions& options, const Robot& robot) {
  FleetRequest alone{problem.grid(), {robot}, {}, options, {}};
  alone.options.horizon.reset();
  alone.options.mode = PlanOptions::Mode::first;
  const auto made = support::problem_of(alone);
  if (!made) return std::nullopt;
  const Plan plan = core::plan(*made, alone.options, StopCondition::never());
  return plan.plans.empty() ? std::nullopt : std::optional(plan.plans[0].cost);
}

/// Whether all robots have a plan if it may be as long as it has to be.
bool can_all_arrive(const Problem& problem, PlanOptions options) {
  options.horizon.reset();
  options.mode = PlanOptions::Mode::first;
  return core::plan(problem, options, StopCondition::never()).unplanned.empty();
}

/// A robot is stuck only in two cases. It has as much left to do where its plan stops as where it begins, or
/// it is one of several robots that cannot all arrive.
void expect_stuck_rightly(const Problem& problem, const RobotPlan& plan, const PlanOptions& options) {
  const Robot& robot = problem.robots()[plan.robot];
  const bool has_company = problem.robots().size() > 1 || !problem.obstacles().empty();
  EXPECT_TRUE(has_company) << robot.id;
  if (changes_radius(robot)) return;
  const Itinerary itinerary = itinerary_of(robot);
  const auto before = time_left(problem, options,
                                later(robot, itinerary.t_begin, robot.committed_end(), itinerary.first_goal));
  const auto after =
      time_left(problem, options, later(robot, plan.cost, plan.actions.back().to, plan.visits.size()));
  // Plans of lone robots differ a little from estimates.
  if (!before || !after) return;
  const bool gains_nothing = *after >= *before * 0.9 - 0.1;
  EXPECT_TRUE(gains_nothing || !can_all_arrive(problem, options)) << robot.id;
}

/// Estimates follow each other in time, each goal has one or is visited, and the last one is the cost.
void expect_estimates(const Problem& problem, const RobotPlan& plan, const PlanOptions& options) {
  EXPECT_EQ(plan.estimated_cost.has_value(), !plan.estimated_visits.empty());
  EXPECT_LE(plan.blocked_by.empty() ? 0 : 1, plan.is_stuck ? 1 : 0);
  if (!plan.estimated_cost) {
    EXPECT_FALSE(plan.is_stuck);
    return;
  }
  const Robot& robot = problem.robots()[plan.robot];
  EXPECT_GE(plan.cost, *options.horizon);
  double t = plan.cost;
  std::size_t goal = plan.visits.size();
  for (const Visit& visit : plan.estimated_visits) {
    EXPECT_EQ(visit.goal, goal++);
    EXPECT_GE(visit.t_arrive, t);
    t = visit.t_leave;
    EXPECT_GE(visit.t_leave, std::max(visit.t_arrive, robot.goal_at(visit.goal).not_before));
  }
  EXPECT_EQ(goal, robot.goal_count());
  if (*plan.estimated_cost == kForever) {
    EXPECT_TRUE(plan.is_stuck);
    EXPECT_EQ(t, kForever);
    return;
  }
  EXPECT_NEAR(t, *plan.estimated_cost, 1e-6);
  if (plan.is_stuck) expect_stuck_rightly(problem, plan, options);
}

void expect_valid(const Problem& problem, const Plan& plan, const PlanOptions& options) {
  const auto report = check_plan(problem, options, plan, StopCondition::never());
  ASSERT_TRUE(report);
  EXPECT_TRUE(report->valid()) << support::text(*report);
  Objectives estimated;
  for (const RobotPlan& robot : plan.plans) {
    const double cost = robot.estimated_cost.value_or(robot.cost);
    expect_estimates(problem, robot, options);
    EXPECT_LE(robot.lower_bound, robot.cost);
    if (cost < kForever) estimated = including(estimated, cost);
  }
  ASSERT_TRUE(plan.estimated);
  EXPECT_EQ(plan.estimated->flowtime, estimated.flowtime);
  EXPECT_EQ(plan.estimated->makespan, estimated.makespan);
}

/// The robots `t` seconds later, each committed for `commit` seconds.
void advance(FleetRequest& request, const Plan& plan, double t, double commit) {
  for (const RobotPlan& robot : plan.plans) {
    request.robots[robot.robot] =
        support::robot_at_moment(std::move(request.robots[robot.robot]), robot, t, commit);
  }
  for (const Unplanned& robot : plan.unplanned) {
    request.robots[robot.robot] = support::robot_at_moment(std::move(request.robots[robot.robot]), t);
  }
}

/// An open hall with robots of one size. Some visit a place before their goal.
FleetRequest open_hall(Dice& dice, int count) {
  FleetRequest request{OccupancyGrid(12 + dice.below(10), 12 + dice.below(10), 1.0), {}, {}, {}, {}};
  const auto place = [&](auto&& is_taken) {
    while (true) {
      const Position p(dice.below(request.grid.columns()) + 0.5, dice.below(request.grid.rows()) + 0.5);
      if (!is_taken(p)) return p;
    }
  };
  for (int i = 0; i < count; ++i) {
    Robot robot;
    robot.id = std::to_string(i);
    robot.radius = 0.4;
    robot.linear_speed = 1.0;
    robot.angular_speed = 2.0;
    const auto is_start = [&](const Position& p) {
      return std::any_of(request.robots.begin(), request.robots.end(),
                         [&](const Robot& other) { return (other.start.position - p).norm() < 1.0; });
    };
    robot.start = {place(is_start), 0.0};
    // Nobody has to visit the place where another robot rests.
    std::vector<Position> goals;
    for (const Robot& other : request.robots) {
      for (std::size_t k = 0; k < other.goal_count(); ++k) goals.push_back(other.goal_at(k).position);
    }
    const auto is_goal = [&](const Position& p) {
      return std::any_of(goals.begin(), goals.end(),
                         [&](const Position& other) { return (other - p).norm() < 1.0; });
    };
    robot.goal = Goal{place(is_goal), std::nullopt, 1.0};
    if (dice.chance(0.3)) robot.via = {Goal{place(is_goal), std::nullopt, dice.between(0.0, 3.0)}};
    request.robots.push_back(std::move(robot));
  }
  return request;
}

class HorizonOfRandomFleet : public testing::TestWithParam<int> {};

TEST_P(HorizonOfRandomFleet, LetsEverybodyArriveInTheEndInAnOpenHall) {
  const int seed = GetParam();
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  Dice dice(static_cast<std::uint64_t>(seed));
  FleetRequest request = open_hall(dice, 2 + dice.below(20));
  request.options.horizon = dice.between(4.0, 12.0);
  request.options.start_safe_interval = 0.0;
  const double period = *request.options.horizon * dice.between(0.2, 0.6);
  const bool keeps_previous = dice.chance(0.5);
  bool all_arrived = false;
  for (int round = 0; round < kMaxRounds && !all_arrived; ++round) {
    const auto problem = support::problem_of(request);
    ASSERT_TRUE(problem) << "round " << round;
    const Plan plan = core::plan(*problem, request.options, StopCondition::never());
    expect_valid(*problem, plan, request.options);
    if (testing::Test::HasFailure()) return;
    EXPECT_TRUE(plan.unplanned.empty()) << "round " << round;
    if (round == 0) {
      EXPECT_TRUE(same_plans(plan, core::plan(*problem, request.options, StopCondition::never())));
    }
    all_arrived = std::all_of(plan.plans.begin(), plan.plans.end(), [&](const RobotPlan& robot) {
      return !robot.estimated_cost && robot.cost <= period;
    });
    advance(request, plan, period, 0.3);
    if (keeps_previous) continue;
    for (Robot& robot : request.robots) robot.previous.reset();
  }
  EXPECT_TRUE(all_arrived);
}

TEST_P(HorizonOfRandomFleet, SaysOnlyOfRobotsThatGainNothingThatTheyAreStuck) {
  const int seed = GetParam();
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  Dice dice(static_cast<std::uint64_t>(seed) + 2000);
  FleetRequest request = support::random_request(dice);
  if (dice.chance(0.3)) support::add_loads(dice, request);
  request.options.horizon = dice.between(0.5, 20.0);
  for (int round = 0; round < 3; ++round) {
    const auto problem = support::problem_of(request);
    if (!problem) return;  // robots amid a collision
    const Plan plan = core::plan(*problem, request.options, StopCondition::never());
    expect_valid(*problem, plan, request.options);
    if (testing::Test::HasFailure()) return;
    request = support::moment_of(dice, request, plan, dice.between(0.0, *request.options.horizon));
    for (Robot& robot : request.robots) robot.previous.reset();
  }
}

TEST_P(HorizonOfRandomFleet, EveryPlanIsValidOnAnyMap) {
  const int seed = GetParam();
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  Dice dice(static_cast<std::uint64_t>(seed) + 1000);
  const Problem first = support::random_problem(dice, 1 + dice.below(14));
  FleetRequest request{first.grid(), first.robots(), {}, support::random_options(dice, first), {}};
  request.options.horizon = dice.between(0.5, 20.0);
  if (dice.chance(0.4)) {
    request.options.mode = PlanOptions::Mode::anytime;
    request.options.max_iterations = 20;
  }
  for (int round = 0; round < 3; ++round) {
    const auto problem = support::problem_of(request);
    ASSERT_TRUE(problem) << "round " << round;
    const StopCondition budget(StopCondition::Clock::now() + std::chrono::seconds(1));
    const Plan plan = core::plan(*problem, request.options, budget);
    expect_valid(*problem, plan, request.options);
    if (testing::Test::HasFailure()) return;
    advance(request, plan, 0.4 * *request.options.horizon, 0.0);
  }
}

/// In corridors for one, robots have to go back a long way for others, beyond any horizon.
TEST_P(HorizonOfRandomFleet, LetsEverybodyArriveInMazes) {
  constexpr double kPeriod = 5.0;
  constexpr int kMaxRoundsInMazes = 40;
  Dice dice(static_cast<std::uint64_t>(GetParam()) + 3000);
  const support::Maze maze =
      support::solvable_maze(dice, 2 + static_cast<std::size_t>(dice.below(4)), dice.chance(0.5));
  SCOPED_TRACE(testing::Message() << "seed " << GetParam() << support::drawing_of(maze));
  FleetRequest request{
      support::map_of(maze, dice.chance(0.5) ? 1 : 20), support::robots_of(maze), {}, {}, {}};
  for (Robot& robot : request.robots) robot.id = std::to_string(&robot - request.robots.data());
  request.options.horizon = 20.0;
  if (dice.chance(0.5)) request.options.replan = PlanOptions::Replan::where_needed;
  bool all_arrived = false;
  for (int round = 0; round < kMaxRoundsInMazes && !all_arrived; ++round) {
    const auto problem = support::problem_of(request);
    ASSERT_TRUE(problem) << "round " << round;
    const Plan plan = core::plan(*problem, request.options, StopCondition::never());
    expect_valid(*problem, plan, request.options);
    EXPECT_TRUE(plan.unplanned.empty()) << "round " << round;
    if (testing::Test::HasFailure()) return;
    advance(request, plan, kPeriod, 0.0);
    all_arrived = true;
    for (Robot& robot : request.robots) {
      const bool has_arrived = is_same_position(robot.start.position, robot.goal->position);
      robot.goal_age = has_arrived ? 0.0 : robot.goal_age + kPeriod;
      all_arrived = all_arrived && has_arrived;
    }
  }
  EXPECT_TRUE(all_arrived);
}

/// Two robots that have to change places in a corridor, and a robot that is not in their way.
TEST(Horizon, NamesRobotsThatCannotAllArrive) {
  for (const auto replan : {PlanOptions::Replan::all, PlanOptions::Replan::where_needed}) {
    std::vector<Robot> robots{support::robot_at(2.5, 0.5).to(27.5, 0.5),
                              support::robot_at(27.5, 0.5).to(2.5, 0.5),
                              support::robot_at(2.5, 2.5).to(9.5, 2.5)};
    for (Robot& robot : robots) robot.id = std::to_string(&robot - robots.data());
    FleetRequest request{
        support::ascii_map({std::string(30, '.'), std::string(30, '#'), std::string(30, '.')}),
        robots,
        {},
        {},
        {}};
    request.options.horizon = 20.0;
    request.options.replan = replan;
    int named = 0;
    for (int round = 0; round < 30; ++round) {
      const auto problem = support::problem_of(request);
      ASSERT_TRUE(problem);
      const Plan plan = core::plan(*problem, request.options, StopCondition::never());
      expect_valid(*problem, plan, request.options);
      bool is_any_stuck = false;
      for (const RobotPlan& robot : plan.plans) {
        if (!robot.is_stuck) continue;
        is_any_stuck = true;
        EXPECT_NE(robot.robot, 2U);
        EXPECT_EQ(robot.blocked_by, RobotList({1U - robot.robot})) << "round " << round;
      }
      if (is_any_stuck) ++named;
      EXPECT_TRUE(is_any_stuck || round < 10) << "round " << round;
      advance(request, plan, 5.0, 0.0);
      for (Robot& robot : request.robots) {
        const bool has_arrived = is_same_position(robot.start.position, robot.goal->position);
        robot.goal_age = has_arrived ? 0.0 : robot.goal_age + 5.0;
      }
    }
    EXPECT_GT(named, 20);
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, HorizonOfRandomFleet, testing::Range(0, 60));

}  // namespace TEST_FILE
}  // namespace fleetplan::core
