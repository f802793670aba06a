#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "core/plan/planner.h"
#include "tests/support/expect_safe.h"
#include "tests/support/problem_builder.h"
#include "tests/support/random_problem.h"
#include "tests/support/recorder.h"
#include "tests/support/summary.h"
#include "tests/support/threaded_executor.h"

namespace fleetplan::core {
namespace TEST_FILE {

using Objective = PlanOptions::Objective;
using support::robot_at;

/// Sixteen robots on two circles that all cross in the middle of a hall, and a parked robot.
Problem roundabout() {
  std::vector<Robot> robots;
  for (int k = 0; k < 16; ++k) {
    const double angle = (k + 0.5) * 0.125 * std::numbers::pi;
    const double radius = k % 2 == 0 ? 6.0 : 4.5;
    const Position arm = radius * Position(std::cos(angle), std::sin(angle));
    robots.push_back(robot_at(7.0 + arm.x(), 7.0 + arm.y()).to(7.0 - arm.x(), 7.0 - arm.y()));
  }
  robots.push_back(robot_at(7.5, 7.5));
  return support::make_problem(OccupancyGrid(14, 14, 1.0), robots);
}

PlanOptions anytime(std::int64_t iterations, Objective objective = Objective::flowtime) {
  PlanOptions options;
  options.mode = PlanOptions::Mode::anytime;
  options.objective = objective;
  options.max_iterations = iterations;
  options.seed = 3;
  return options;
}

void expect_same_plan_on_threads(const Problem& problem, const PlanOptions& options) {
  support::ThreadedExecutor executor(4);
  support::Recorder recorder;
  const Plan together = plan(problem, options, StopCondition::never(), executor);
  const std::string text = support::exact_text(together);
  EXPECT_EQ(text, support::exact_text(plan(problem, options, StopCondition::never())));
  EXPECT_EQ(text, support::exact_text(plan(problem, options, StopCondition::never(), executor, &recorder)))
      << "with an observer";
  support::expect_safe(problem, together);
}

TEST(CallerThread, RunsEveryTaskOnceInOrder) {
  std::vector<std::size_t> ran;
  CallerThread().run(3, [&](std::size_t k) { ran.push_back(k); });
  EXPECT_EQ(ran, (std::vector<std::size_t>{0, 1, 2}));
}

class PlanInParallel : public testing::TestWithParam<Objective> {};

TEST_P(PlanInParallel, ReturnsTheSamePlanForAnyNumberOfThreads) {
  const Problem problem = roundabout();
  const PlanOptions options = anytime(200, GetParam());
  const Plan alone = plan(problem, options, StopCondition::never());
  EXPECT_GT(alone.search.improvements, 0);
  support::expect_safe(problem, alone);
  for (const std::size_t threads : {1, 2, 8}) {
    support::ThreadedExecutor executor(threads);
    const Plan together = plan(problem, options, StopCondition::never(), executor);
    EXPECT_TRUE(together.deterministic);
    EXPECT_EQ(support::exact_text(together), support::exact_text(alone)) << threads << " threads";
    EXPECT_EQ(together.search.improvements, alone.search.improvements);
    EXPECT_EQ(together.search.expansions, alone.search.expansions);
  }
}

TEST_P(PlanInParallel, ReturnsTheSamePlanForRandomFleets) {
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    support::Dice dice(seed);
    const Problem problem = support::random_problem(dice, 10);
    expect_same_plan_on_threads(problem, anytime(120, GetParam()));
  }
}

/// Long enough for more moves twice, and for the search to stray and to return to its best plan.
TEST_P(PlanInParallel, ReturnsTheSamePlanForSmallFleetsAfterManyIterations) {
  for (std::uint64_t seed = 20; seed < 24; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    support::Dice dice(seed);
    const Problem problem = support::random_problem(dice, 5);
    expect_same_plan_on_threads(problem, anytime(400, GetParam()));
  }
}

TEST_P(PlanInParallel, ReturnsTheSamePlanWithAnObserver) {
  const Problem problem = roundabout();
  const PlanOptions options = anytime(200, GetParam());
  support::Recorder by_one;
  CallerThread callers_thread;
  const Plan alone = plan(problem, options, StopCondition::never(), callers_thread, &by_one);
  EXPECT_EQ(support::exact_text(alone), support::exact_text(plan(problem, options, StopCondition::never())));
  ASSERT_GT(by_one.shown.size(), 1u);
  for (const std::size_t threads : {2, 8}) {
    support::ThreadedExecutor executor(threads);
    support::Recorder by_many;
    const Plan together = plan(problem, options, StopCondition::never(), executor, &by_many);
    EXPECT_EQ(support::exact_text(together), support::exact_text(alone)) << threads << " threads";
    EXPECT_EQ(by_many.reported.size(), by_one.reported.size());
    ASSERT_EQ(by_many.shown.size(), by_one.shown.size());
    for (std::size_t k = 0; k < by_many.shown.size(); ++k) {
      ASSERT_EQ(support::exact_text(by_many.shown[k]), support::exact_text(by_one.shown[k]));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Objectives, PlanInParallel,
                         testing::Values(Objective::flowtime, Objective::makespan));

TEST(PlanOnManyThreads, ReturnsACompleteSafePlanAfterTheDeadline) {
  const Problem problem = roundabout();
  PlanOptions options = anytime(0);
  options.max_iterations.reset();
  support::ThreadedExecutor executor(4);
  const StopCondition stop(StopCondition::Clock::now() + std::chrono::milliseconds(300));
  const Plan together = plan(problem, options, stop, executor);
  EXPECT_TRUE(together.unplanned.empty());
  support::expect_safe(problem, together);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
