// The progress and the plans that a planner reports to an observer.

#include "core/model/progress.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/plan/planner.h"
#include "tests/core/support/planning.h"
#include "tests/support/expect_bounds.h"
#include "tests/support/random_problem.h"
#include "tests/support/recorder.h"
#include "tests/support/summary.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::Recorder;
using support::robot_at;
using Reordering = PlanOptions::Reordering;

Plan observed_plan(const Problem& problem, const PlanOptions& options, Recorder& recorder,
                   const StopCondition& stop = StopCondition::never()) {
  CallerThread executor;
  return plan(problem, options, stop, executor, &recorder);
}

/// Ten robots that all cross in the middle of a hall, and a parked one in a corner.
Problem roundabout() {
  std::vector<Robot> robots{robot_at(0.5, 0.5)};
  for (int k = 0; k < 10; ++k) {
    const double angle = (k + 0.5) * 0.2 * std::numbers::pi;
    const Position arm = 4.0 * Position(std::cos(angle), std::sin(angle));
    robots.push_back(robot_at(5.0 + arm.x(), 5.0 + arm.y()).to(5.0 - arm.x(), 5.0 - arm.y()));
  }
  return support::make_problem(OccupancyGrid(10, 10, 1.0), robots);
}

/// Robots 0 and 1 block each other permanently; robot 2 has a free path.
Problem corridor_and_hall() {
  return support::make_problem(support::ascii_map({".........",  //
                                                   "#########",  //
                                                   "........."}),
                               {robot_at(0.5, 0.5).to(5.5, 0.5), robot_at(3.5, 0.5).to(1.5, 0.5),
                                robot_at(0.5, 2.5).to(8.5, 2.5), robot_at(8.5, 0.5)});
}

PlanOptions anytime(std::int64_t iterations) {
  PlanOptions options;
  options.mode = PlanOptions::Mode::anytime;
  options.max_iterations = iterations;
  return options;
}

void expect_ends_as(const Plan& plan, const Recorder& recorder) {
  ASSERT_FALSE(recorder.reported.empty());
  const Progress& last = recorder.reported.back();
  EXPECT_EQ(last.planned, plan.plans.size());
  EXPECT_EQ(last.attempts, plan.search.attempts);
  ASSERT_TRUE(last.best);
  EXPECT_EQ(last.best->flowtime, plan.objectives.flowtime);
  EXPECT_EQ(last.best->makespan, plan.objectives.makespan);
}

TEST(Progress, CountsRobotsOneByOneWhereNoneFails) {
  std::vector<Robot> robots{robot_at(0.5, 0.5)};
  for (double y = 1.5; y < 9.0; y += 1.0) robots.push_back(robot_at(0.5, y).to(8.5, y));
  Recorder recorder;
  const Plan plan =
      observed_plan(support::make_problem(OccupancyGrid(9, 9, 1.0), std::move(robots)), {}, recorder);
  std::vector<std::size_t> planned;
  for (const Progress& progress : recorder.reported) {
    if (planned.empty() || planned.back() != progress.planned) planned.push_back(progress.planned);
    EXPECT_EQ(progress.attempts, 1);
  }
  EXPECT_EQ(planned, (std::vector<std::size_t>{1, 2, 3, 4, 5, 6, 7, 8, 9}))
      << "the parked robot is counted from the start";
  EXPECT_FALSE(recorder.reported.front().best);
  EXPECT_TRUE(recorder.shown.empty()) << "the first solution is the answer";
  expect_ends_as(plan, recorder);
}

TEST(Progress, EndsWithTheNumbersOfThePlanForEveryReordering) {
  for (const auto reordering : {Reordering::raise_failed, Reordering::random, Reordering::none}) {
    SCOPED_TRACE(static_cast<int>(reordering));
    PlanOptions options;
    options.reordering = reordering;
    Recorder crossing;
    expect_ends_as(observed_plan(roundabout(), options, crossing), crossing);
    Recorder partial;
    const Plan plan = observed_plan(corridor_and_hall(), options, partial);
    EXPECT_EQ(plan.unplanned.size(), 1u);
    expect_ends_as(plan, partial);
  }
}

TEST(Progress, CountsAttemptsOneByOneAndReportsFewerPlannedRobots) {
  PlanOptions options;
  options.reordering = Reordering::random;
  Recorder recorder;
  const Plan plan = observed_plan(corridor_and_hall(), options, recorder);
  ASSERT_GT(plan.search.attempts, 1);
  bool decreased = false;
  for (std::size_t k = 1; k < recorder.reported.size(); ++k) {
    const Progress& before = recorder.reported[k - 1];
    const Progress& now = recorder.reported[k];
    EXPECT_GE(now.attempts, before.attempts);
    EXPECT_LE(now.attempts, before.attempts + 1);
    decreased = decreased || now.planned < before.planned;
  }
  EXPECT_TRUE(decreased);
}

TEST(Progress, HasDecreasingObjectivesAndShowsEveryBetterPlan) {
  const Problem problem = roundabout();
  Recorder recorder;
  const Plan plan = observed_plan(problem, anytime(200), recorder);
  ASSERT_GT(plan.search.improvements, 2);
  double best = kForever;
  for (const Progress& progress : recorder.reported) {
    if (!progress.best) continue;
    EXPECT_LE(progress.best->flowtime, best);
    best = progress.best->flowtime;
  }
  EXPECT_LT(best,
            std::find_if(recorder.reported.begin(), recorder.reported.end(), [](const Progress& progress) {
              return progress.best.has_value();
            })->best->flowtime);
  expect_ends_as(plan, recorder);

  ASSERT_GT(recorder.shown.size(), 2u);
  EXPECT_EQ(recorder.shown.front().search.improvements, 0) << "the first solution";
  for (std::size_t k = 0; k < recorder.shown.size(); ++k) {
    const Plan& shown = recorder.shown[k];
    support::expect_safe(problem, shown);
    EXPECT_EQ(shown.plans.size(), 11u);
    EXPECT_FALSE(shown.deterministic);
    EXPECT_EQ(shown.search.attempts, plan.search.attempts);
    EXPECT_LE(shown.search.expansions, plan.search.expansions);
    support::expect_bounded(shown);
    for (std::size_t i = 0; i < shown.plans.size(); ++i) {
      EXPECT_NEAR(shown.plans[i].lower_bound, plan.plans[i].lower_bound, 1e-9) << "robot " << i;
    }
    if (k == 0) continue;
    EXPECT_LT(shown.objectives.flowtime, recorder.shown[k - 1].objectives.flowtime);
    EXPECT_GT(shown.search.improvements, recorder.shown[k - 1].search.improvements);
  }
}

TEST(Progress, ShowsNoPlanUnlessRequested) {
  Recorder recorder(false);
  EXPECT_GT(observed_plan(roundabout(), anytime(100), recorder).search.improvements, 0);
  EXPECT_TRUE(recorder.shown.empty());
}

TEST(Progress, ShowsPartialPlansWithTheirUnplannedRobots) {
  Recorder recorder;
  PlanOptions options = anytime(20);
  options.smoothing = false;  // nothing would be left to improve
  const Plan plan = observed_plan(corridor_and_hall(), options, recorder);
  ASSERT_FALSE(recorder.shown.empty());
  ASSERT_EQ(recorder.shown.front().unplanned.size(), 1u);
  EXPECT_EQ(recorder.shown.front().unplanned.front().robot, plan.unplanned.front().robot);
}

TEST(Progress, IsReportedWhenStoppedBeforePlanning) {
  Recorder recorder;
  const Plan plan = observed_plan(roundabout(), anytime(100), recorder, met());
  EXPECT_EQ(plan.plans.size(), 1u);
  EXPECT_TRUE(recorder.shown.empty());
  expect_ends_as(plan, recorder);
}

TEST(Progress, DoesNotChangeThePlan) {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    support::Dice dice(seed);
    const Problem problem = support::random_problem(dice, 6);
    PlanOptions options = support::random_options(dice, problem);
    options.max_iterations = 20;
    Recorder recorder;
    const Plan alone = plan(problem, options, StopCondition::never());
    const Plan observed = observed_plan(problem, options, recorder);
    ASSERT_EQ(support::exact_text(observed), support::exact_text(alone));
    EXPECT_EQ(observed.deterministic, alone.deterministic);
    EXPECT_EQ(observed.search.attempts, alone.search.attempts);
    EXPECT_EQ(observed.search.expansions, alone.search.expansions);
    EXPECT_EQ(observed.search.improvements, alone.search.improvements);
    expect_ends_as(observed, recorder);
  }
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
