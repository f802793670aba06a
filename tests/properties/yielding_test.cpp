// Random fleets some of whose robots yield: every plan is valid, and no robot moves for nothing.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "core/verify/verify.h"
#include "tests/support/plan_checked.h"
#include "tests/support/random_problem.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::Dice;

/// A random problem with robots that yield, with goals, some of them shared, and without.
std::optional<Problem> yielding_problem(Dice& dice) {
  OccupancyGrid grid = support::random_map(dice);
  std::vector<Robot> robots = support::random_robots(dice, grid, 10);
  if (robots.empty()) return std::nullopt;
  for (Robot& robot : robots) {
    if (robot.goal && dice.chance(0.3)) robot.goal->service = dice.between(0.0, 10.0);
    if (robot.goal && dice.chance(0.3)) robot.goal->radius_after = robot.radius * dice.between(0.5, 1.0);
    if (!dice.chance(0.6)) continue;
    if (dice.chance(0.5)) robot.goal.reset();
    const Robot& other = robots[static_cast<std::size_t>(dice.below(static_cast<int>(robots.size())))];
    const bool shares = robot.goal && other.goal && !other.yields() && other.radius >= robot.radius;
    if (shares && dice.chance(0.5)) robot.goal->position = other.goal->position;
    robot.let_yield();
  }
  auto problem = Problem::create(std::move(grid), std::move(robots), StopCondition::never());
  auto* valid = std::get_if<Problem>(&problem);
  return valid != nullptr ? std::optional<Problem>(std::move(*valid)) : std::nullopt;
}

/// Whether the plan would be valid if this robot did not move.
bool may_stay(const Problem& problem, const PlanOptions& options, const Plan& plan, std::size_t index) {
  std::vector<RobotPlan> plans = plan.plans;
  plans[index].actions.clear();
  plans[index].visits.clear();
  plans[index].cost = 0.0;
  CheckRules rules{plan_tolerances(problem.grid(), problem.robots(), plans)};
  rules.inflation = options.inflation;
  const auto report = verify({problem.grid(), problem.robots(), problem.obstacles(), &problem.zones()}, plans,
                             rules, StopCondition::never());
  return report->valid();
}

TEST(Yielding, EveryPlanIsValidAndNobodyMovesForNothing) {
  int made_way = 0;
  int idle = 0;
  std::vector<std::uint64_t> seeds(250);
  std::iota(seeds.begin(), seeds.end(), 0);
  seeds.push_back(1298);  // a robot that may stay where it is served, in spite of a start delay
  seeds.push_back(1488);  // a robot makes way for a robot that makes way for nothing
  for (const std::uint64_t seed : seeds) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Dice dice(seed);
    const auto problem = yielding_problem(dice);
    if (!problem) continue;
    PlanOptions options = support::random_options(dice, *problem);
    options.inflation = 0.0;
    const Plan plan = support::plan_checked(*problem, options);
    for (const Unplanned& robot : plan.unplanned) {
      EXPECT_FALSE(problem->robots()[robot.robot].is_idle()) << "it need not move, so it has a plan";
    }
    for (std::size_t k = 0; k < plan.plans.size(); ++k) {
      const RobotPlan& one = plan.plans[k];
      if (!problem->robots()[one.robot].is_idle()) continue;
      ++idle;
      if (one.actions.empty()) continue;
      ++made_way;
      EXPECT_FALSE(may_stay(*problem, options, plan, k)) << "robot " << one.robot;
    }
  }
  EXPECT_GT(made_way, 10);
  EXPECT_GT(idle, 10 * made_way / 4);
}

TEST(Yielding, ARobotThatMayYieldCostsNoOtherRobotItsPlan) {
  int more = 0;
  for (std::uint64_t seed = 1000; seed < 1150; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Dice dice(seed);
    OccupancyGrid grid = support::random_map(dice);
    std::vector<Robot> robots = support::random_robots(dice, grid, 8);
    const auto planned = [&](bool yield) {
      std::vector<Robot> fleet = robots;
      for (std::size_t k = 0; k < fleet.size(); k += 2) {
        fleet[k].goal.reset();
        if (yield) fleet[k].let_yield();
      }
      auto made = Problem::create(grid, std::move(fleet), StopCondition::never());
      const auto* problem = std::get_if<Problem>(&made);
      return problem == nullptr ? 0 : support::plan_checked(*problem).plans.size();
    };
    if (robots.empty()) continue;
    const std::size_t parked = planned(false);
    const std::size_t yielding = planned(true);
    EXPECT_GE(yielding, parked);
    if (yielding > parked) ++more;
  }
  EXPECT_GT(more, 5);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
