// Random fleets with limited acceleration. The independent checker accepts every plan. An integration in
// small steps, which knows only accelerations and the speeds of profiles, arrives where the plan says and
// overlaps no robot.

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "core/execution/dependencies.h"
#include "core/plan/planner.h"
#include "tests/core/execution/simulation/study.h"
#include "tests/support/expect_bounds.h"
#include "tests/support/expect_safe.h"
#include "tests/support/moving_fleet.h"
#include "tests/support/random_zones.h"
#include "tests/support/sanitized.h"
#include "tests/support/summary.h"

namespace fleetplan::core {
namespace TEST_FILE {

constexpr int kRuns = support::kSanitized ? 60 : 200;
constexpr double kStep = 1e-3;       // seconds, of the integration
constexpr double kPositions = 1e-3;  // metres, in which the integration and the plan agree

StopCondition generous_budget() {
  return StopCondition(StopCondition::Clock::now() + std::chrono::seconds(2));
}

/// The same robots, most of them with limits.
Problem with_inertia(support::Dice& dice, const Problem& problem) {
  std::vector<Robot> robots = problem.robots();
  for (Robot& robot : robots) {
    const double scale = robot.linear_speed;  // of the map's cells
    if (dice.chance(0.8)) {
      robot.linear_acceleration = scale * std::pow(10.0, dice.between(-1.0, 1.0));
      robot.linear_deceleration =
          dice.chance(0.5) ? robot.linear_acceleration : scale * std::pow(10.0, dice.between(-1.0, 1.0));
    }
    if (dice.chance(0.5)) robot.angular_acceleration = std::pow(10.0, dice.between(-1.0, 2.0));
    robot.may_reverse = dice.chance(0.2);
    if (!robot.goal || dice.chance(0.6)) continue;
    support::add_goals(dice, problem.grid(), robot);
    support::change_speeds(dice, robot);
  }
  ProblemConditions conditions;
  conditions.zones = problem.zones();
  auto made =
      Problem::create(problem.map(), std::move(robots), std::move(conditions), StopCondition::never());
  return std::move(std::get<Problem>(made));
}

Problem random_inertial_problem(support::Dice& dice, int seed) {
  const int count = 1 + dice.below(12);
  if (seed % 3 != 0) return with_inertia(dice, support::random_problem(dice, count));
  return with_inertia(
      dice, support::random_problem_with_zones(dice, count, {Zone::Type::speed, Zone::Type::one_way}));
}

/// A robot that is driven step by step along the actions of its plan.
class Driver {
 public:
  Driver(const Robot& robot, const RobotPlan& plan)
      : robot_(robot),
        visits_(plan.visits),
        actions_(plan.actions),
        acceleration_(robot.linear_acceleration),
        deceleration_(robot.linear_deceleration),
        here_(robot.start.position) {}

  /// Goes on for one step. Returns the position.
  Position step() {
    const double until = t_ + kStep;
    while (index_ < actions_.size() && t_ < until) {
      const Action& action = actions_[index_];
      take_loads(action.t_start);
      const double dt = std::min(until, action.t_end) - t_;
      if (action.type == Action::Type::translate)
        here_ += dt * speed(action, t_ + 0.5 * dt) * direction(action);
      t_ += dt;
      if (t_ >= action.t_end) {
        EXPECT_LT((here_ - action.to.position).norm(), kPositions)
            << "robot " << robot_.id << ", action " << index_;
        here_ = action.to.position;
        ++index_;
      }
    }
    t_ = until;
    return here_;
  }

 private:
  /// What it has loaded before an action.
  void take_loads(double t) {
    for (; served_ < visits_.size() && visits_[served_].t_leave <= t + kStep; ++served_) {
      const Goal& goal = robot_.goal_at(visits_[served_].goal);
      acceleration_ = goal.linear_acceleration_after.value_or(acceleration_);
      deceleration_ =
          goal.linear_deceleration_after.value_or(goal.linear_acceleration_after.value_or(deceleration_));
    }
  }
  static Position direction(const Action& action) {
    return (action.to.position - action.from.position).normalized();
  }
  double speed(const Action& action, double t) const {
    if (!action.profile)
      return (action.to.position - action.from.position).norm() / (action.t_end - action.t_start);
    const double gained = action.profile->start + acceleration_ * (t - action.t_start);
    const double to_lose = action.profile->end + deceleration_ * (action.t_end - t);
    return std::min({action.profile->cruise, gained, to_lose});
  }

  const Robot& robot_;
  const std::vector<Visit>& visits_;
  const std::vector<Action>& actions_;
  double acceleration_;  // metres per second squared, with its load
  double deceleration_;
  std::size_t served_ = 0;  // goals
  std::size_t index_ = 0;
  double t_ = 0.0;
  Position here_;
};

/// Executes all plans and compares all disks after every hundredth step.
void expect_execution_without_overlap(const Problem& problem, const Plan& plan) {
  std::vector<Driver> drivers;
  std::vector<std::size_t> robots;
  std::vector<Position> places;
  double end = 0.0;
  for (const RobotPlan& robot : plan.plans) {
    drivers.emplace_back(problem.robots()[robot.robot], robot);
    robots.push_back(robot.robot);
    if (!robot.actions.empty()) end = std::max(end, robot.actions.back().t_end);
  }
  places.resize(drivers.size());
  const auto steps = static_cast<int>(std::min(end, 60.0) / kStep);
  for (int k = 0; k <= steps; ++k) {
    for (std::size_t i = 0; i < drivers.size(); ++i) places[i] = drivers[i].step();
    if (k % 20 != 0) continue;
    for (std::size_t i = 0; i < places.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const double kept = problem.robots()[robots[i]].radius + problem.robots()[robots[j]].radius;
        ASSERT_GT((places[i] - places[j]).norm(), kept - 2.0 * kPositions) << "t = " << k * kStep;
      }
    }
  }
}

void expect_profiles(const Problem& problem, const Plan& plan) {
  for (const RobotPlan& robot : plan.plans) {
    const Robot& driven = problem.robots()[robot.robot];
    for (const Action& action : robot.actions) {
      const bool limited = action.type == Action::Type::translate ? driven.linear_inertia().is_limited
                           : action.type == Action::Type::rotate  ? driven.angular_inertia().is_limited
                                                                  : false;
      EXPECT_EQ(action.profile.has_value(), limited);
    }
  }
}

class FleetWithInertia : public testing::TestWithParam<int> {};

TEST_P(FleetWithInertia, GetsPlansThatCanBeExecuted) {
  const int seed = GetParam();
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  support::Dice dice(static_cast<std::uint64_t>(seed));
  const Problem problem = random_inertial_problem(dice, seed);
  PlanOptions options = support::random_options(dice, problem);
  if (dice.chance(0.2)) options.interval_margin = dice.between(0.0, 0.5);

  const Plan plan = core::plan(problem, options, generous_budget());

  support::expect_safe(problem, plan, options);
  support::expect_bounded(plan);
  expect_profiles(problem, plan);
  expect_execution_without_overlap(problem, plan);
}

TEST_P(FleetWithInertia, GetsTheSamePlanTwice) {
  const int seed = GetParam();
  if (seed % 11 != 0) return;  // an eleventh of the seeds suffices
  support::Dice dice(static_cast<std::uint64_t>(seed));
  const Problem problem = random_inertial_problem(dice, seed);
  const PlanOptions options = support::random_options(dice, problem);

  const Plan first = core::plan(problem, options, generous_budget());
  const Plan second = core::plan(problem, options, generous_budget());

  if (first.deterministic && second.deterministic) {
    EXPECT_EQ(support::exact_text(first), support::exact_text(second));
  }
}

/// Each robot makes between a third and all of its speed, stops now and then, and begins moves late.
Disturbance late_robots() {
  Disturbance disturbance;
  disturbance.speed = {0.3, 1.0};
  disturbance.turn = {0.5, 1.0};
  disturbance.stops = {200.0, 2.0};
  disturbance.start_delay = {0.0, 0.3};
  return disturbance;
}

/// Robots that are late brake at gates, stand and start again. The same integration executes their motion: no
/// robots overlap, and all arrive.
TEST_P(FleetWithInertia, IsExecutedByDependenciesWithinItsLimits) {
  const int seed = GetParam();
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  support::Dice dice(static_cast<std::uint64_t>(seed) + 5000);
  const Problem problem = random_inertial_problem(dice, seed);
  PlanOptions options;
  options.interval_margin = 0.6;
  const Plan plan = core::plan(problem, options, generous_budget());
  const DependencyRules rules{std::vector<double>(problem.robots().size(), 0.0), 0.1, 1e-6};
  const auto dependencies = make_dependencies(problem.robots(), plan.plans, rules, StopCondition::never());
  SimulatedFleet fleet =
      simulated(problem.grid(), problem.robots(), plan.plans, ExecutionPolicy::dependencies);
  std::vector<std::size_t> plan_of(problem.robots().size(), 0);
  for (std::size_t k = 0; k < plan.plans.size(); ++k) plan_of[plan.plans[k].robot] = k;
  for (Dependency dependency : dependencies->list) {
    dependency.gate.robot = plan_of[dependency.gate.robot];
    dependency.until.robot = plan_of[dependency.until.robot];
    fleet.execution.dependencies.push_back(dependency);
  }
  const SimulationSettings settings{late_robots(), 1, static_cast<std::uint64_t>(seed)};

  const auto trace = trace_run(fleet, settings, 0, 1'000'000, StopCondition::never());
  const auto run = Simulator::make(fleet, settings, StopCondition::never())->run(0, StopCondition::never());

  Plan executed = plan;
  for (std::size_t k = 0; k < executed.plans.size(); ++k) {
    RobotPlan& late = executed.plans[k];
    late.actions = trace->actions[k];
    late.visits = visits_of(problem.robots()[late.robot], late.actions);
  }
  for (const RobotPlan& robot : executed.plans) {
    double speed = 0.0;
    for (const Action& action : robot.actions) {
      const double start = action.profile ? action.profile->start : 0.0;
      if (action.type != Action::Type::translate || action.profile) {
        EXPECT_NEAR(start, speed, 1e-5);
      }
      speed = action.profile ? action.profile->end : 0.0;
    }
    EXPECT_NEAR(speed, 0.0, 1e-5);
  }
  if (!dependencies->tight.empty()) return;  // there the clock has to be kept
  EXPECT_TRUE(run->stuck.empty());
  EXPECT_FALSE(run->collisions.first.has_value());
  expect_execution_without_overlap(problem, executed);
}

int first_seed() {
  const char* const given = std::getenv("FLEETPLAN_FIRST_SEED");
  return given != nullptr ? std::atoi(given) : 0;
}

INSTANTIATE_TEST_SUITE_P(Seeds, FleetWithInertia, testing::Range(first_seed(), first_seed() + kRuns));

}  // namespace TEST_FILE
}  // namespace fleetplan::core
