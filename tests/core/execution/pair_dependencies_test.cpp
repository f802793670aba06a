#include "core/execution/pair_dependencies.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "tests/support/plan_builder.h"
#include "tests/support/random_problem.h"
#include "tests/support/step_limit.h"

namespace fleetplan::core {
namespace TEST_FILE {

Segment line(double x0, double y0, double x1, double y1) { return {{x0, y0}, {x1, y1}}; }

TEST(ConflictRegion, OfACrossingIsAnEllipse) {
  const ConflictRegion region(line(0, 0, 4, 0), line(2, -2, 2, 2), 1.0);
  const auto second = region.second_beyond(0.0);
  ASSERT_TRUE(second);
  EXPECT_NEAR(second->least, 0.25, 1e-12);
  EXPECT_NEAR(second->most, 0.75, 1e-12);
  // Beyond the centre only half a metre is left to its border.
  const auto beyond = region.second_beyond(0.5 + 0.5 / 4.0);
  ASSERT_TRUE(beyond);
  EXPECT_NEAR(beyond->least, 0.5 - std::sqrt(0.75) / 4.0, 1e-12);
  EXPECT_FALSE(region.second_beyond(0.75));
  const auto first = region.first_up_to(0.5 - 0.5 / 4.0);
  ASSERT_TRUE(first);
  EXPECT_NEAR(first->most, 0.5 + std::sqrt(0.75) / 4.0, 1e-12);
  EXPECT_FALSE(region.first_up_to(0.25));
}

TEST(ConflictRegion, OfRobotsThatFollowEachOtherIsAStrip) {
  const ConflictRegion region(line(0, 0, 10, 0), line(0, 0, 10, 0), 1.0);
  EXPECT_NEAR(region.second_beyond(0.5)->least, 0.4, 1e-12);
  EXPECT_NEAR(region.first_up_to(0.5)->most, 0.6, 1e-12);
  EXPECT_EQ(region.first_up_to(1.0)->most, 1.0);
  // Head on.
  const ConflictRegion opposite(line(0, 0, 10, 0), line(10, 0, 0, 0), 1.0);
  EXPECT_NEAR(opposite.second_beyond(0.5)->most, 0.6, 1e-12);
  EXPECT_NEAR(opposite.second_beyond(0.0)->least, 0.0, 1e-12);
}

TEST(ConflictRegion, OfARobotThatStandsIsABand) {
  const ConflictRegion region(line(5, 0, 5, 0), line(0, 0, 10, 0), 1.0);
  EXPECT_NEAR(region.second_beyond(0.3)->least, 0.4, 1e-12);
  EXPECT_EQ(region.first_up_to(0.5)->most, 1.0);
  EXPECT_FALSE(region.first_up_to(0.39));
}

TEST(ConflictRegion, IsEmptyForLinesThatOnlyTouch) {
  const ConflictRegion region(line(0, 0, 10, 0), line(0, 1, 10, 1), 1.0);
  EXPECT_FALSE(region.second_beyond(0.0));
  EXPECT_FALSE(region.first_up_to(1.0));
  EXPECT_TRUE(ConflictRegion(line(0, 0, 10, 0), line(0, 1, 10, 1), 1.0 + 1e-9).second_beyond(0.0));
}

/// Compares both ranges with the ranges of a fine raster of shares.
TEST(ConflictRegion, HasTheRangesOfARaster) {
  constexpr int kSteps = 100;
  for (int seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    support::Dice dice(static_cast<std::uint64_t>(seed));
    const auto place = [&] { return Position(dice.between(0, 5), dice.between(0, 5)); };
    Segment a{place(), place()};
    Segment b{place(), place()};
    if (dice.chance(0.2)) b = {b.from, b.from + 0.7 * (a.to - a.from)};
    if (dice.chance(0.1)) a.to = a.from;
    const double distance = dice.between(0.2, 2.0);
    const double from = dice.between(-0.2, 1.0);
    const double to = dice.between(0.0, 1.2);
    double least = 2.0;
    double most = -1.0;
    for (int i = 0; i <= kSteps; ++i) {
      for (int k = 0; k <= kSteps; ++k) {
        const double u = static_cast<double>(i) / kSteps;
        const double v = static_cast<double>(k) / kSteps;
        const Position apart = a.from + u * (a.to - a.from) - b.from - v * (b.to - b.from);
        if (apart.norm() >= distance) continue;
        if (u >= from) least = std::min(least, v);
        if (v <= to) most = std::max(most, u);
      }
    }
    const ConflictRegion region(a, b, distance);
    const auto second = region.second_beyond(from);
    const auto first = region.first_up_to(to);
    if (least <= 1.0) {
      ASSERT_TRUE(second);
      EXPECT_LE(second->least, least + 1e-12);
      // It is no less than necessary: there is a point of the region's border.
      const Position at = b.from + second->least * (b.to - b.from);
      EXPECT_LE(nearest_shares({a.from + std::max(0.0, from) * (a.to - a.from), a.to}, {at, at}).distance,
                distance + 1e-9);
    }
    if (most >= 0.0) {
      ASSERT_TRUE(first);
      EXPECT_GE(first->most, most - 1e-12);
      const Position at = a.from + first->most * (a.to - a.from);
      EXPECT_LE(nearest_shares({at, at}, {b.from, b.from + std::min(1.0, to) * (b.to - b.from)}).distance,
                distance + 1e-9);
    }
    const NearestShares nearest = nearest_shares(a, b);
    const Position apart =
        a.from + nearest.at.first * (a.to - a.from) - b.from - nearest.at.second * (b.to - b.from);
    EXPECT_NEAR(apart.norm(), nearest.distance, 1e-12);
    if (least <= 1.0 && from <= 0.0) {
      EXPECT_LT(nearest.distance, distance);
    }
  }
}

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
    support::StepLimit limit(steps);
    EXPECT_FALSE(
        staircase_of(regions, Pace(plan.actions), Pace(later.actions), kSlack, support::counted(limit)));
    EXPECT_LE(limit.late(), 2);
  }
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
