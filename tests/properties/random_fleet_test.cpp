// Random fleets on random maps: the independent checker accepts every plan that the planner returns.

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstddef>
#include <set>

#include "core/plan/planner.h"
#include "core/verify/verify.h"
#include "tests/support/expect_bounds.h"
#include "tests/support/plain_check.h"
#include "tests/support/random_problem.h"
#include "tests/support/summary.h"

namespace fleetplan::core {
namespace TEST_FILE {

/// Metres: the contact tolerance of the service, and the rounding of times and positions.
constexpr double kTolerance = 2e-9;
constexpr int kRuns = 300;

StopCondition generous_budget() {
  return StopCondition(StopCondition::Clock::now() + std::chrono::seconds(2));
}

void expect_every_robot_once(const Problem& problem, const Plan& plan) {
  std::set<std::size_t> seen;
  for (const RobotPlan& robot : plan.plans) EXPECT_TRUE(seen.insert(robot.robot).second);
  for (const Unplanned& robot : plan.unplanned) EXPECT_TRUE(seen.insert(robot.robot).second);
  EXPECT_EQ(seen.size(), problem.robots().size());
}

void expect_waits_before_moves(const Plan& plan, double wait) {
  for (const RobotPlan& robot : plan.plans) {
    for (std::size_t i = 0; i < robot.actions.size(); ++i) {
      if (robot.actions[i].type != Action::Type::translate) continue;
      ASSERT_GT(i, 0u) << "robot " << robot.robot << " moves without a wait";
      const Action& before = robot.actions[i - 1];
      EXPECT_EQ(before.type, Action::Type::wait);
      EXPECT_GE(before.t_end - before.t_start, wait - 1e-9);
    }
  }
}

class RandomFleet : public testing::TestWithParam<int> {};

TEST_P(RandomFleet, EveryReturnedPlanPassesTheChecker) {
  const int seed = GetParam();
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  support::Dice dice(static_cast<std::uint64_t>(seed));
  const Problem problem = support::random_problem(dice, 1 + dice.below(14));
  const PlanOptions options = support::random_options(dice, problem);

  const Plan plan = core::plan(problem, options, generous_budget());

  const VerifyReport report =
      *verify(problem.grid(), problem.robots(), plan.plans, kTolerance, StopCondition::never());
  EXPECT_TRUE(report.valid()) << support::text(report);
  expect_every_robot_once(problem, plan);
  support::expect_bounded(plan);
  if (options.wait_before_move > 0.0) expect_waits_before_moves(plan, options.wait_before_move);
}

TEST_P(RandomFleet, TheSameRequestGivesTheSamePlan) {
  const int seed = GetParam();
  if (seed % 5 != 0) return;  // a fifth of the seeds suffices
  support::Dice dice(static_cast<std::uint64_t>(seed));
  const Problem problem = support::random_problem(dice, 1 + dice.below(14));
  const PlanOptions options = support::random_options(dice, problem);

  const Plan first = core::plan(problem, options, generous_budget());
  const Plan second = core::plan(problem, options, generous_budget());

  if (first.deterministic && second.deterministic) {
    EXPECT_EQ(support::exact_text(first), support::exact_text(second));
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomFleet, testing::Range(0, kRuns));

}  // namespace TEST_FILE
}  // namespace fleetplan::core
