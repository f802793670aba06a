// Weights of robots and goals that are due: improvement never makes the objective worse, and the answer's
// value is what the visits say.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "core/model/objective_share.h"
#include "tests/support/plan_checked.h"
#include "tests/support/random_problem.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::Dice;
using Objective = PlanOptions::Objective;

Goal due_at(Goal goal, Dice& dice) {
  if (dice.chance(0.3)) goal.service = dice.between(0.0, 5.0);
  if (dice.chance(0.2)) goal.not_before = dice.between(0.0, 10.0);
  if (dice.chance(0.7)) goal.due = goal.not_before + dice.between(goal.not_before > 0.0 ? 0.0 : -10.0, 20.0);
  return goal;
}

/// A random problem with weights and goals that are due, some of them on the way.
std::optional<Problem> urgent_problem(Dice& dice) {
  OccupancyGrid grid = support::random_map(dice);
  std::vector<Robot> robots = support::random_robots(dice, grid, 8);
  if (robots.empty()) return std::nullopt;
  for (Robot& robot : robots) {
    if (dice.chance(0.6)) robot.weight = std::pow(10.0, dice.between(-3.0, 3.0));
    if (!robot.goal) continue;
    robot.goal = due_at(*robot.goal, dice);
    if (dice.chance(0.3)) robot.via = {due_at(Goal{robot.start.position, std::nullopt}, dice)};
  }
  auto problem = Problem::create(std::move(grid), std::move(robots), StopCondition::never());
  auto* valid = std::get_if<Problem>(&problem);
  return valid != nullptr ? std::optional<Problem>(std::move(*valid)) : std::nullopt;
}

double value_by_visits(const Plan& plan, const Problem& problem, Objective objective) {
  double sum = 0.0;
  for (const RobotPlan& one : plan.plans) {
    const Robot& robot = problem.robots()[one.robot];
    if (objective == Objective::flowtime) sum += robot.weight * one.cost;
    for (const Visit& visit : one.visits) {
      const auto& due = robot.goal_at(visit.goal).due;
      if (objective == Objective::tardiness && due) {
        sum += robot.weight * std::max(0.0, visit.t_arrive - *due);
      }
    }
  }
  return sum;
}

class Urgency : public testing::TestWithParam<Objective> {};

TEST_P(Urgency, ImprovementNeverMakesTheObjectiveWorse) {
  int improved = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Dice dice(seed);
    const auto problem = urgent_problem(dice);
    if (!problem) continue;
    PlanOptions options = support::random_options(dice, *problem);
    options.objective = GetParam();
    options.mode = PlanOptions::Mode::first;
    const Plan first = support::plan_checked(*problem, options);
    options.mode = PlanOptions::Mode::anytime;
    options.max_iterations = 30;
    const Plan better = support::plan_checked(*problem, options);
    if (first.plans.size() != better.plans.size()) continue;  // the mode changes when robots are ejected
    const double before = objective_value(first, problem->robots(), options.objective);
    const double after = objective_value(better, problem->robots(), options.objective);
    EXPECT_NEAR(after, value_by_visits(better, *problem, options.objective), 1e-6 * (1.0 + after));
    // Costs decide where delays are equal, up to a ten thousandth of what they gain.
    const double slack = options.objective == Objective::tardiness
                             ? 1e-4 * std::abs(value_by_visits(first, *problem, Objective::flowtime) -
                                               value_by_visits(better, *problem, Objective::flowtime))
                             : 0.0;
    if (better.search.attempts == first.search.attempts) {
      EXPECT_LE(after, before + slack + 1e-6);
    }
    if (after < before - 1e-6) ++improved;
  }
  EXPECT_GT(improved, 0);
}

INSTANTIATE_TEST_SUITE_P(Objectives, Urgency, testing::Values(Objective::flowtime, Objective::tardiness));

}  // namespace TEST_FILE
}  // namespace fleetplan::core
