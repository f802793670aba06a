#include "core/execution/staircase.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <string>

#include "tests/support/plan_builder.h"
#include "tests/support/step_limit.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::PlanBuilder;

constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr double kSlack = 0.1;

/// A plan of so many legs of a random length, and how far apart in time two such plans are.
RobotPlan random_plan(std::mt19937& random, std::size_t legs, double later) {
  const Robot robot{"a", 0.5, 1.0, 2.0, {{0, 0}, 0.0}, {}};
  std::uniform_real_distribution<double> length(0.1, 5.0);
  PlanBuilder builder(0, robot);
  builder.wait(later);
  double x = 0.0;
  for (std::size_t k = 1; k < legs; ++k) builder.translate_to(x += length(random), 0);
  return builder.build();
}

Segment random_segment(std::mt19937& random) {
  std::uniform_real_distribution<double> at(0.0, 3.0);
  return {{at(random), at(random)}, {at(random), at(random)}};
}

/// Regions of stretches of the first robot and later ones of the second robot.
std::vector<PassedRegion> random_regions(std::mt19937& random, std::size_t legs) {
  std::vector<PassedRegion> regions;
  for (int k = 0; k < 60; ++k) {
    const double first = static_cast<double>(random() % legs);
    const double second = std::min(first + static_cast<double>(random() % 4), static_cast<double>(legs - 1));
    const ConflictRegion shares(random_segment(random), random_segment(random), 1.0);
    regions.push_back({shares, {first, 1.0}, {second, 1.0}});
  }
  return regions;
}

/// The staircase by its definition: every step looks at every region.
std::vector<Step> slow_staircase(const std::vector<PassedRegion>& regions, const Pace& first,
                                 const Pace& second) {
  const auto gate_after = [&](double u) {
    double least = kNever;
    for (const PassedRegion& region : regions) least = std::min(least, region.second_after(u));
    return least;
  };
  const auto needed_until = [&](double v) {
    double most = 0.0;
    for (const PassedRegion& region : regions) most = std::max(most, region.first_before(v));
    return most;
  };
  std::vector<Step> steps;
  for (double gate = gate_after(-1.0); gate < kNever;) {
    const double t = second.time_at(gate);
    double reached = first.progress_at(t - kSlack);
    double next = gate_after(reached);
    const double step = second.progress_at(t + 0.5 * kSlack);
    if (next < step) {
      reached = first.progress_at(t - 0.5 * kSlack);
      next = gate_after(reached);
    }
    next = std::max(next, step);
    const double until = std::min(reached, needed_until(next));
    if (until > 0.0) steps.push_back({gate, until});
    gate = next > gate ? next : kNever;
  }
  return steps;
}

TEST(Staircase, HasTheStepsThatAllRegionsGive) {
  std::size_t steps = 0;
  for (unsigned seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    const std::size_t legs = 20;
    const RobotPlan first_plan = random_plan(random, legs, 0.0);
    const RobotPlan second_plan = random_plan(random, legs, 5.0);
    const Pace first(first_plan.actions);
    const Pace second(second_plan.actions);
    const auto regions = random_regions(random, legs);
    const auto found = staircase_of(regions, first, second, kSlack, StopCondition::never());
    const std::vector<Step> expected = slow_staircase(regions, first, second);
    ASSERT_EQ(found->steps.size(), expected.size());
    for (std::size_t k = 0; k < expected.size(); ++k) {
      EXPECT_EQ(found->steps[k].gate, expected[k].gate);
      EXPECT_EQ(found->steps[k].until, expected[k].until);
    }
    steps += expected.size();
  }
  EXPECT_GT(steps, 1000U);
}

TEST(Staircase, IsNothingSoonAfterItsStop) {
  std::mt19937 random(1);
  const RobotPlan plan = random_plan(random, 200, 0.0);
  const RobotPlan later = random_plan(random, 200, 5.0);
  const auto regions = random_regions(random, 200);
  for (const std::int64_t steps : {0, 1, 7}) {
    const support::StepLimit limit(steps);
    EXPECT_FALSE(staircase_of(regions, Pace(plan.actions), Pace(later.actions), kSlack, support::counted()));
    EXPECT_LE(limit.late(), 2);
  }
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
