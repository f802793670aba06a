// The closed forms of disk_motion compared with bisection on random encounters.

#include <gtest/gtest.h>

#include <cmath>

#include "core/geometry/disk_motion.h"
#include "tests/core/geometry/random_motion.h"
#include "tests/support/sanitized.h"

namespace fleetplan::core {
namespace TEST_FILE {

constexpr std::uint64_t kSeed = 20261121;
constexpr int kCases = support::kSanitized ? 4000 : 20000;
/// Metres: the error of the bisection.
constexpr double kBisectionError = 1e-9;

class DiskMotionProperty : public testing::Test {
 protected:
  support::Dice dice{kSeed};
};

TEST_F(DiskMotionProperty, CollideAgreesWithBisection) {
  int collisions = 0;
  for (int k = 0; k < kCases; ++k) {
    SCOPED_TRACE(testing::Message() << "seed " << kSeed << ", case " << k);
    const Encounter e = random_encounter(dice);
    const MovingDisk mine = e.departing(e.other.t_start + dice.between(-6, 6));
    const double distance = closest(mine, e.other);
    if (std::abs(distance - e.reach) < kBisectionError) continue;
    ASSERT_EQ(collide(mine, e.other, e.reach), distance < e.reach);
    ASSERT_EQ(collide(e.other, mine, e.reach), distance < e.reach);
    if (distance < e.reach) ++collisions;
  }
  EXPECT_GT(collisions, kCases / 40);
}

TEST_F(DiskMotionProperty, UnsafeIntervalContainsExactlyTimesWithinReach) {
  int hits = 0;
  for (int k = 0; k < kCases; ++k) {
    SCOPED_TRACE(testing::Message() << "seed " << kSeed << ", case " << k);
    const Encounter e = random_encounter(dice);
    const UnsafeInterval unsafe = unsafe_interval(e.from, e.other, e.reach);
    if (!unsafe.empty()) ++hits;
    const double last = std::min(e.other.t_end, e.other.t_start + 20.0);
    for (int i = 0; i <= 50; ++i) {
      const double t = e.other.t_start + (last - e.other.t_start) * i / 50;
      const double distance = (e.other.at(t) - e.from).norm();
      if (unsafe.contains(t)) {
        ASSERT_LT(distance, e.reach + kBisectionError) << "t = " << t;
      }
      const bool inside = t > e.other.t_start && t < e.other.t_end;  // the interval is open
      if (inside && distance < e.reach - kBisectionError) {
        ASSERT_TRUE(unsafe.contains(t)) << "t = " << t;
      }
    }
    if (unsafe.empty()) continue;
    ASSERT_GE(unsafe.begin, e.other.t_start);
    ASSERT_LE(unsafe.end, e.other.t_end);
  }
  EXPECT_GT(hits, kCases / 10);
}

TEST_F(DiskMotionProperty, ForbiddenDeparturesAreExactlyThoseThatCollide) {
  int hits = 0;
  for (int k = 0; k < kCases; ++k) {
    SCOPED_TRACE(testing::Message() << "seed " << kSeed << ", case " << k);
    const Encounter e = random_encounter(dice);
    const UnsafeInterval forbidden = forbidden_departures(e.from, e.velocity, e.duration, e.other, e.reach);
    const auto distance = [&](double t) { return closest(e.departing(t), e.other); };
    const double first = e.other.t_start - e.duration - 1.0;
    const double last = std::min(e.other.t_end, e.other.t_start + 10.0) + 1.0;
    for (int i = 0; i <= 30; ++i) {
      const double t = first + (last - first) * i / 30;
      if (forbidden.contains(t)) {
        ASSERT_LT(distance(t), e.reach + kBisectionError) << "departure " << t;
      } else {
        ASSERT_GE(distance(t), e.reach - kBisectionError) << "departure " << t;
      }
    }
    if (forbidden.empty()) continue;
    ++hits;
    constexpr double kStep = 1e-7;  // seconds; on either side of the ends
    ASSERT_GE(distance(forbidden.begin - kStep), e.reach - kBisectionError);
    if (forbidden.end < kForever) {
      ASSERT_GE(distance(forbidden.end + kStep), e.reach - kBisectionError);
    }
    if (forbidden.end - forbidden.begin < 4.0 * kStep) continue;
    ASSERT_LT(distance(forbidden.begin + kStep), e.reach + kBisectionError);
    if (forbidden.end < kForever) {
      ASSERT_LT(distance(forbidden.end - kStep), e.reach + kBisectionError);
    }
  }
  EXPECT_GT(hits, kCases / 10);
}

/// Departures of the other disk that collide with mine leaving at `t`: the same encounter with roles swapped.
TEST_F(DiskMotionProperty, ForbiddenDeparturesAreSymmetricInTheTwoDisks) {
  for (int k = 0; k < kCases; ++k) {
    SCOPED_TRACE(testing::Message() << "seed " << kSeed << ", case " << k);
    const Encounter e = random_encounter(dice);
    if (e.other.t_end == kForever) continue;
    const UnsafeInterval mine = forbidden_departures(e.from, e.velocity, e.duration, e.other, e.reach);
    const UnsafeInterval others =
        forbidden_departures(e.other.from, e.other.velocity, e.other.t_end - e.other.t_start,
                             e.departing(e.other.t_start), e.reach);
    ASSERT_EQ(mine.empty(), others.empty());
    if (mine.empty()) continue;
    ASSERT_NEAR(mine.begin - e.other.t_start, e.other.t_start - others.end, 1e-7);
    ASSERT_NEAR(mine.end - e.other.t_start, e.other.t_start - others.begin, 1e-7);
  }
}

TEST_F(DiskMotionProperty, MirroringAndTimeShiftPreserveIntervals) {
  const auto mirror = [](const Position& p) { return Position(-p.x(), p.y()); };
  for (int k = 0; k < kCases; ++k) {
    SCOPED_TRACE(testing::Message() << "seed " << kSeed << ", case " << k);
    const Encounter e = random_encounter(dice);
    Encounter m = e;
    m.from = mirror(e.from);
    m.velocity = mirror(e.velocity);
    m.other.from = mirror(e.other.from);
    m.other.velocity = mirror(e.other.velocity);
    const double shift = 64.0;
    m.other.t_start += shift;
    m.other.t_end += shift;
    const auto a = forbidden_departures(e.from, e.velocity, e.duration, e.other, e.reach);
    const auto b = forbidden_departures(m.from, m.velocity, m.duration, m.other, m.reach);
    ASSERT_EQ(a.empty(), b.empty());
    if (!a.empty()) {
      ASSERT_NEAR(a.begin + shift, b.begin, 1e-12);
    }
    if (!a.empty() && a.end < kForever) {
      ASSERT_NEAR(a.end + shift, b.end, 1e-12);
    }
    const auto p = unsafe_interval(e.from, e.other, e.reach);
    const auto q = unsafe_interval(m.from, m.other, m.reach);
    ASSERT_EQ(p.empty(), q.empty());
    if (!p.empty()) {
      ASSERT_NEAR(p.begin + shift, q.begin, 1e-12);
    }
  }
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
