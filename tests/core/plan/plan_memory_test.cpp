// Plans of jobs that have little memory.

#include <gtest/gtest.h>

#include <new>
#include <optional>
#include <vector>

#include "core/plan/planner.h"
#include "core/runtime/memory_account.h"
#include "tests/support/expect_safe.h"
#include "tests/support/problem_builder.h"
#include "tests/support/sanitized.h"
#include "tests/support/threaded_executor.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::robot_at;

/// Robots that cross a hall of 120 x 120 cells with pillars from one side to the other, in reverse order.
Problem crossing() {
  OccupancyGrid hall(120, 120, 1.0);
  for (int row = 3; row < 117; row += 4) {
    for (int column = 10; column < 110; column += 3) hall.block({column + row % 3, row});
  }
  std::vector<Robot> robots;
  for (int k = 0; k < 30; ++k) robots.push_back(robot_at(1.5, 4 * k + 1.5).to(118.5, 117.5 - 4 * k));
  return support::make_problem(std::move(hall), robots);
}

PlanOptions anytime() {
  PlanOptions options;
  options.mode = PlanOptions::Mode::anytime;
  options.max_iterations = support::kSanitized ? 4 : 40;
  return options;
}

struct Planned {
  std::optional<Plan> plan;  // none: the memory does not suffice for any
  std::int64_t peak = 0;     // bytes
};

Planned plan_within(std::int64_t bytes, const Problem& problem, const PlanOptions& options,
                    Executor& executor) {
  MemoryAccount account(static_cast<std::size_t>(bytes));
  Planned planned;
  {
    const MemoryScope scope(&account);
    try {
      planned.plan = plan(problem, options, StopCondition(StopCondition::Clock::time_point::max()), executor);
    } catch (const std::bad_alloc&) {
      planned.plan = std::nullopt;
    }
  }
  planned.peak = account.peak();
  return planned;
}

constexpr std::int64_t kPlenty = std::int64_t{1} << 40;

class PlanMemory : public testing::TestWithParam<PlanOptions::Mode> {
 protected:
  PlanOptions options() const { return GetParam() == PlanOptions::Mode::anytime ? anytime() : PlanOptions{}; }
};

TEST_P(PlanMemory, LeavesAPlanAloneThatNeedsLess) {
  const Problem problem = crossing();
  CallerThread executor;
  const Planned free = plan_within(kPlenty, problem, options(), executor);
  const Planned bounded = plan_within(3 * free.peak, problem, options(), executor);
  ASSERT_TRUE(free.plan && bounded.plan);
  EXPECT_TRUE(bounded.plan->deterministic);
  EXPECT_EQ(bounded.plan->unplanned.size(), 0U);
  EXPECT_EQ(bounded.plan->objectives.flowtime, free.plan->objectives.flowtime);
}

TEST_P(PlanMemory, BoundsEveryPlanAndSaysWhatItLacked) {
  const Problem problem = crossing();
  support::ThreadedExecutor executor(3);
  const std::int64_t peak = plan_within(kPlenty, problem, options(), executor).peak;
  int partial = 0;
  const auto shares =
      support::kSanitized ? std::vector{2, 16, 32} : std::vector{2, 3, 4, 6, 8, 12, 16, 24, 32, 64};
  for (const int share : shares) {
    const std::int64_t limit = peak / share;
    const Planned planned = plan_within(limit, problem, options(), executor);
    EXPECT_LE(planned.peak, limit + 4 * MemoryAccount::kBatch) << limit;
    if (!planned.plan) continue;
    support::expect_safe(problem, *planned.plan);
    EXPECT_EQ(planned.plan->plans.size() + planned.plan->unplanned.size(), problem.robots().size());
    if (planned.plan->unplanned.empty()) continue;
    ++partial;
    EXPECT_FALSE(planned.plan->deterministic);
    for (const Unplanned& robot : planned.plan->unplanned) {
      const bool lacks_budget = robot.reason == Unplanned::Reason::budget_exhausted;
      EXPECT_TRUE(!lacks_budget || robot.detail == kMemorySpent) << robot.detail;
    }
  }
  EXPECT_GT(partial, 0);
}

INSTANTIATE_TEST_SUITE_P(Modes, PlanMemory,
                         testing::Values(PlanOptions::Mode::first, PlanOptions::Mode::anytime));

TEST(ImprovementMemory, EndsTheImprovementWithThePlanThatItHas) {
  const Problem problem = crossing();
  CallerThread executor;
  const std::int64_t first = plan_within(kPlenty, problem, {}, executor).peak;
  support::ThreadedExecutor threads(4);
  const Planned planned = plan_within(first * 3 / 2, problem, anytime(), threads);
  ASSERT_TRUE(planned.plan);
  EXPECT_TRUE(planned.plan->unplanned.empty());
  support::expect_safe(problem, *planned.plan);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
