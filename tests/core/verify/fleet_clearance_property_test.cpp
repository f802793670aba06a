// The closed form against positions sampled in small steps, on random plans.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <tuple>

#include "core/verify/pairs/fleet_clearance.h"
#include "tests/core/verify/random_fleet.h"
#include "tests/core/verify/scene.h"
#include "tests/support/plain_check.h"
#include "tests/support/sanitized.h"

namespace fleetplan::core {
namespace TEST_FILE {

constexpr unsigned kFirstSeed = 20190901;
constexpr double kStep = 0.01;             // seconds
constexpr double kMaxRelativeSpeed = 4.0;  // metres per second, of one robot relative to another
constexpr double kRounding = 1e-12;        // metres

FleetClearance clearance_of(const RandomFleet& fleet, double tolerance) {
  std::vector<const RobotPlan*> plan_of(fleet.robots.size(), nullptr);
  for (const RobotPlan& plan : fleet.plans) plan_of[plan.robot] = &plan;
  std::vector<std::vector<Leg>> legs;
  std::vector<double> radii;
  for (std::size_t k = 0; k < fleet.robots.size(); ++k) {
    legs.push_back(execute(fleet.robots[k], plan_of[k]));
    radii.push_back(fleet.robots[k].radius);
  }
  return *fleet_clearance(legs, {radii, radii}, std::vector(radii.size(), tolerance), kMaxCollisions,
                          StopCondition::never());
}

/// The number of overlaps at `t`, each extended by `margin` seconds on both sides.
int overlaps_at(const FleetClearance& clearance, double t, double margin) {
  return static_cast<int>(std::count_if(
      clearance.overlaps.begin(), clearance.overlaps.end(),
      [&](const Overlap& overlap) { return overlap.t_begin - margin <= t && t <= overlap.t_end + margin; }));
}

TEST(FleetClearanceProperty, OverlapsAgreeWithSamples) {
  for (unsigned seed = kFirstSeed; seed < kFirstSeed + 150; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    const RandomFleet fleet = random_fleet(random, 2, 4.0, 8);
    const FleetClearance clearance = clearance_of(fleet, kTolerance);
    const double contact = fleet.robots[0].radius + fleet.robots[1].radius;
    double least = 1e9;
    for (double t = 0.0; t < fleet.makespan + 1.0; t += kStep) {
      const double distance = (sampled_position(fleet, 1, t) - sampled_position(fleet, 0, t)).norm();
      least = std::min(least, distance);
      if (distance < contact - 2.0 * kTolerance) {
        ASSERT_EQ(overlaps_at(clearance, t, 1e-9), 1) << t;
      }
      if (distance > contact) {
        ASSERT_EQ(overlaps_at(clearance, t, -1e-9), 0) << t;
      }
    }
    EXPECT_GE(least - contact, *clearance.least - kRounding);
    EXPECT_LE(least - contact, *clearance.least + kMaxRelativeSpeed * kStep);
    for (const Overlap& overlap : clearance.overlaps) {
      const double distance =
          (sampled_position(fleet, 1, overlap.t_deepest) - sampled_position(fleet, 0, overlap.t_deepest))
              .norm();
      EXPECT_NEAR(distance, overlap.distance, 2e-9);
      EXPECT_LE(overlap.t_begin, overlap.t_deepest);
      EXPECT_LE(overlap.t_deepest, overlap.t_end);
    }
  }
}

TEST(FleetClearanceProperty, LeastGapAgreesWithSamplesOfAllPairs) {
  for (unsigned seed = kFirstSeed; seed < kFirstSeed + (support::kSanitized ? 2 : 6); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    const RandomFleet fleet =
        random_fleet(random, 30, 300.0, 3);  // so sparse that most of them never collide
    const FleetClearance clearance = clearance_of(fleet, kTolerance);
    double least = 1e9;
    for (double t = 0.0; t < fleet.makespan + 1.0; t += 5 * kStep) {
      std::vector<Position> positions;
      for (std::size_t k = 0; k < fleet.robots.size(); ++k)
        positions.push_back(sampled_position(fleet, k, t));
      for (std::size_t a = 0; a < positions.size(); ++a) {
        for (std::size_t b = a + 1; b < positions.size(); ++b) {
          const double contact = fleet.robots[a].radius + fleet.robots[b].radius;
          least = std::min(least, (positions[b] - positions[a]).norm() - contact);
        }
      }
    }
    EXPECT_GE(least, *clearance.least - kRounding);
    EXPECT_LE(least, *clearance.least + kMaxRelativeSpeed * 5 * kStep);
  }
}

TEST(FleetClearanceProperty, FleetAgreesWithItsPairs) {
  for (unsigned seed = kFirstSeed; seed < kFirstSeed + 10; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    const RandomFleet fleet = random_fleet(random, 30, 15.0, 8);
    const FleetClearance together = clearance_of(fleet, kTolerance);
    std::size_t overlaps = 0;
    double least = 1e9;
    for (std::size_t a = 0; a < fleet.robots.size(); ++a) {
      for (std::size_t b = a + 1; b < fleet.robots.size(); ++b) {
        RandomFleet pair{{fleet.robots[a], fleet.robots[b]}, {}, 0.0};
        for (RobotPlan plan : fleet.plans) {
          if (plan.robot != a && plan.robot != b) continue;
          plan.robot = plan.robot == a ? 0 : 1;
          pair.plans.push_back(plan);
        }
        const FleetClearance alone = clearance_of(pair, kTolerance);
        overlaps += alone.overlaps.size();
        least = std::min(least, *alone.least);
      }
    }
    EXPECT_GT(overlaps, 0U);
    EXPECT_EQ(together.overlaps.size(), overlaps);
    EXPECT_NEAR(*together.least, least, kRounding);
  }
}

TEST(FleetClearanceProperty, DoesNotDependOnTheOrderOfRobots) {
  for (unsigned seed = kFirstSeed; seed < kFirstSeed + 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    const RandomFleet fleet = random_fleet(random, 20, 12.0, 6);
    RandomFleet reversed = fleet;
    std::reverse(reversed.robots.begin(), reversed.robots.end());
    for (RobotPlan& plan : reversed.plans) plan.robot = fleet.robots.size() - 1 - plan.robot;
    const VerifyReport one =
        *verify(open_map(12, 12), fleet.robots, fleet.plans, kTolerance, StopCondition::never());
    const VerifyReport other =
        *verify(open_map(12, 12), reversed.robots, reversed.plans, kTolerance, StopCondition::never());
    EXPECT_EQ(*one.min_clearance, *other.min_clearance);
    ASSERT_EQ(one.violations.size(), other.violations.size());
    const auto by_detail = [](const Violation& a, const Violation& b) {
      return std::tie(a.t, a.kind, a.distance, a.detail) < std::tie(b.t, b.kind, b.distance, b.detail);
    };
    std::vector<Violation> left = one.violations;
    std::vector<Violation> right = other.violations;
    std::sort(left.begin(), left.end(), by_detail);
    std::sort(right.begin(), right.end(), by_detail);
    for (std::size_t k = 0; k < left.size(); ++k) {
      EXPECT_EQ(left[k].t, right[k].t);
      EXPECT_EQ(left[k].distance, right[k].distance);
      EXPECT_EQ(left[k].detail, right[k].detail);
      std::vector<std::size_t> renamed;
      for (const std::size_t robot : right[k].robots) renamed.push_back(fleet.robots.size() - 1 - robot);
      std::sort(renamed.begin(), renamed.end());
      EXPECT_EQ(left[k].robots, renamed);
    }
  }
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
