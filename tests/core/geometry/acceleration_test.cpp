// Motion at constant acceleration: profiles of speed, and the kernels of disk_motion against integration in
// small steps. Random cases, and touching, symmetric and degenerate ones.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/geometry/disk_motion.h"
#include "core/geometry/speed_profile.h"
#include "tests/core/geometry/random_motion.h"
#include "tests/support/sanitized.h"

namespace fleetplan::core {
namespace TEST_FILE {

constexpr std::uint64_t kSeed = 20261126;
constexpr int kCases = support::kSanitized ? 400 : 4000;
/// Metres: what the steps of an integration may miss of a least distance.
constexpr double kSampling = 1e-4;

/// Returns the speed, and the length covered, after `t` seconds of a profile, by integration in small steps.
double integrated(const SpeedProfile& profile, const Inertia& inertia, double seconds) {
  const int steps = 20000;
  const double dt = seconds / steps;
  double length = 0.0;
  for (int k = 0; k < steps; ++k) {
    const double t = (k + 0.5) * dt;
    double speed = profile.cruise;
    if (inertia.rise > 0.0) speed = std::min(speed, profile.start + t / inertia.rise);
    if (inertia.fall > 0.0) speed = std::min(speed, profile.end + (seconds - t) / inertia.fall);
    length += speed * dt;
  }
  return length;
}

Inertia random_inertia(support::Dice& dice) {
  double rise = 1.0 / std::pow(10.0, dice.between(-1.5, 2.0));
  double fall = 1.0 / std::pow(10.0, dice.between(-1.5, 2.0));
  if (dice.chance(0.1)) rise = 0.0;
  if (dice.chance(0.1)) fall = 0.0;
  return {rise, fall};
}

TEST(SpeedProfile, IsATrapezoidOrATriangle) {
  const Inertia inertia{1.0, 0.5};  // 1 and 2 m/s^2
  const SpeedProfile far = fastest_profile(10.0, 2.0, inertia);
  EXPECT_EQ(far.cruise, 2.0);
  EXPECT_DOUBLE_EQ(duration(far, 10.0), 10.0 / 2.0 + 0.5 * (2.0 + 1.0));
  const SpeedProfile near = fastest_profile(0.75, 2.0, inertia);
  EXPECT_DOUBLE_EQ(near.cruise, 1.0);
  EXPECT_DOUBLE_EQ(duration(near, 0.75), 1.5);
  EXPECT_DOUBLE_EQ(inertia.time(0.75, 2.0), 1.5);
}

TEST(SpeedProfile, WithoutInertiaIsTheQuotientOfLengthAndSpeed) {
  EXPECT_EQ(Inertia{}.time(0.7, 0.3), 0.7 / 0.3);
  EXPECT_EQ(Inertia{}.time(0.0, 0.3), 0.0);
  EXPECT_EQ(Inertia{}.loss(0.7, 0.3), 0.0);
}

TEST(SpeedProfile, CoversItsLengthInItsTime) {
  support::Dice dice(kSeed);
  for (int k = 0; k < 300; ++k) {
    SCOPED_TRACE(k);
    const Inertia inertia = random_inertia(dice);
    const double length = dice.between(0.01, 10.0);
    const double speed = dice.between(0.1, 3.0);
    const SpeedProfile profile = fastest_profile(length, speed, inertia);
    const double seconds = duration(profile, length);
    ASSERT_NEAR(seconds, inertia.time(length, speed), 1e-12 * (1.0 + seconds));
    ASSERT_NEAR(integrated(profile, inertia, seconds), length, 1e-3 * length);
  }
}

TEST(SpeedProfile, ThroughPartsKeepsTheirLimitsAndIsContinuous) {
  support::Dice dice(kSeed);
  for (int k = 0; k < 1000; ++k) {
    SCOPED_TRACE(k);
    const Inertia inertia = random_inertia(dice);
    std::vector<LimitedPart> parts;
    for (int i = 1 + dice.below(5); i > 0; --i)
      parts.push_back({dice.between(0.01, 4.0), dice.between(0.1, 3.0)});
    const std::vector<SpeedProfile> profiles = fastest_profiles(parts, inertia);
    ASSERT_EQ(profiles.size(), parts.size());
    ASSERT_EQ(profiles.front().start, 0.0);
    ASSERT_EQ(profiles.back().end, 0.0);
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const SpeedProfile& profile = profiles[i];
      if (i > 0) {
        ASSERT_EQ(profile.start, profiles[i - 1].end);
      }
      ASSERT_LE(profile.cruise, parts[i].limit);
      ASSERT_GE(profile.cruise, profile.start);
      ASSERT_GE(profile.cruise, profile.end);
      ASSERT_LE(profile.rise_length() + profile.fall_length(), parts[i].length * (1.0 + 1e-12));
    }
  }
}

TEST(SpeedProfile, PhasesAreContiguousAndChangeSpeedEvenly) {
  support::Dice dice(kSeed);
  for (int k = 0; k < 1000; ++k) {
    SCOPED_TRACE(k);
    const Inertia inertia = random_inertia(dice);
    const Position from(dice.between(-5, 5), dice.between(-5, 5));
    const Position to = from + dice.between(0.01, 6.0) * direction(dice.between(-4, 4));
    const SpeedProfile profile = fastest_profile((to - from).norm(), dice.between(0.1, 3.0), inertia);
    const double t = dice.between(0, 100);
    const TimedSegment move{{from, to}, t, t + duration(profile, (to - from).norm())};
    double now = t;
    Position here = from;
    double speed = inertia.rise > 0.0 ? 0.0 : profile.cruise;
    for (const TimedSegment& phase : phases(move, profile)) {
      ASSERT_EQ(phase.t_start, now);
      ASSERT_EQ(phase.path.from, here);
      const double mean = phase.path.length() / phase.duration();
      ASSERT_NEAR(mean * (1.0 - phase.ramp), speed, 1e-6);
      speed = mean * (1.0 + phase.ramp);
      now = phase.t_end;
      here = phase.path.to;
    }
    ASSERT_EQ(now, move.t_end);
    ASSERT_EQ(here, to);
  }
}

TEST(TimedSegment, BeforeAndAfterATimeGoesWhereItWent) {
  support::Dice dice(kSeed);
  for (int k = 0; k < 1000; ++k) {
    TimedSegment whole{
        {{dice.between(-3, 3), 0.0}, {1.0, dice.between(-3, 3)}}, 2.0, 5.0, dice.between(-1, 1)};
    const double t = dice.between(2.0, 4.9);
    const TimedSegment rest = whole.from_time(t);
    const double later = dice.between(t, 5.0);
    ASSERT_LT((MovingDisk(whole).at(later) - MovingDisk(rest).at(later)).norm(), 1e-12);
    const TimedSegment before = whole.until_time(t);
    const double earlier = dice.between(2.0, t);
    ASSERT_LT((MovingDisk(whole).at(earlier) - MovingDisk(before).at(earlier)).norm(), 1e-12);
  }
}

/// An encounter in which the disks change their speed.
struct Ramps {
  Encounter encounter;
  double ramp;

  MovingDisk departing(double t) const {
    MovingDisk disk = encounter.departing(t);
    disk.ramp = ramp;
    return disk;
  }
};

Ramps random_ramps(support::Dice& dice) {
  const auto ramp = [&] { return dice.chance(0.3) ? dice.below(3) - 1.0 : dice.between(-1.0, 1.0); };
  Ramps made{random_encounter(dice), ramp()};
  if (made.encounter.other.velocity.squaredNorm() > 0.0) made.encounter.other.ramp = ramp();
  return made;
}

/// Two disks, and the times between which both move, if begin <= end.
struct Meeting {
  MovingDisk mine;
  MovingDisk other;
  double reach = 0.0;
  double begin = std::max(mine.t_start, other.t_start);
  double end = std::min(mine.t_end, other.t_end);

  double distance(double t) const { return (mine.at(t) - other.at(t)).norm(); }
};

Meeting random_meeting(support::Dice& dice) {
  const Ramps ramps = random_ramps(dice);
  const MovingDisk& other = ramps.encounter.other;
  return {ramps.departing(other.t_start + dice.between(-6, 6)), other, ramps.encounter.reach};
}

/// The least distance of the centres at many times.
double sampled(const Meeting& meeting) {
  const auto [begin, end] = std::pair(meeting.begin, meeting.end);
  if (begin > end) return kForever;
  double least = kForever;
  double at = begin;
  const auto look = [&](double t) {
    const double distance = meeting.distance(t);
    if (distance < least) at = t;
    least = std::min(least, distance);
  };
  const int steps = 400;
  for (int k = 0; k <= steps; ++k) look(begin + (end - begin) * k / steps);
  const double first = at - (end - begin) / steps;
  for (int k = 0; k <= steps; ++k) {
    look(std::clamp(first + 2.0 * (end - begin) / steps * k / steps, begin, end));
  }
  return least;
}

TEST(Acceleration, CollidesWhereSamplesAreNear) {
  support::Dice dice(kSeed);
  int collisions = 0;
  for (int k = 0; k < kCases; ++k) {
    SCOPED_TRACE(testing::Message() << "seed " << kSeed << ", case " << k);
    const Meeting meeting = random_meeting(dice);
    const auto& [mine, other, reach, begin, end] = meeting;
    const double distance = sampled(meeting);
    const double exact = least_distance(mine, other);
    if (distance == kForever) {
      ASSERT_EQ(exact, kForever);
      continue;
    }
    ASSERT_LE(exact, distance + 1e-12);
    ASSERT_GE(exact, distance - kSampling);
    if (std::abs(exact - reach) < 1e-8) continue;
    ASSERT_EQ(collide(mine, other, reach), exact < reach);
    ASSERT_EQ(collide(other, mine, reach), exact < reach);
    if (exact < reach) ++collisions;
  }
  EXPECT_GT(collisions, kCases / 40);
}

TEST(Acceleration, ForbiddenDeparturesAreExactlyThoseThatCollide) {
  support::Dice dice(kSeed);
  int hits = 0;
  for (int k = 0; k < kCases; ++k) {
    SCOPED_TRACE(testing::Message() << "seed " << kSeed << ", case " << k);
    const Ramps ramps = random_ramps(dice);
    const Encounter& e = ramps.encounter;
    const UnsafeInterval forbidden =
        forbidden_departures(e.from, e.velocity, e.duration, e.other, e.reach, ramps.ramp);
    if (!forbidden.empty()) ++hits;
    const double last = std::min(e.other.t_end, e.other.t_start + 20.0);
    for (int i = 0; i <= 60; ++i) {
      const double t = e.other.t_start - e.duration + (last + e.duration - e.other.t_start) * i / 60;
      const double distance = least_distance(ramps.departing(t), e.other);
      if (distance < e.reach - 1e-8) {
        const bool is_inside = t > e.other.t_start - e.duration && t < last;
        ASSERT_TRUE(!is_inside || forbidden.contains(t)) << "departure " << t;
      }
      const double edge = std::min(std::abs(t - forbidden.begin), std::abs(t - forbidden.end));
      if (!forbidden.empty() && forbidden.contains(t) && edge > 1e-6) {
        ASSERT_LT(distance, e.reach + 1e-8) << "departure " << t;
      }
    }
    if (forbidden.empty() || forbidden.end - forbidden.begin < 1e-9) continue;
    // At its ends nothing collides, up to rounding, and hardly within them something does.
    const double first = e.other.t_start - e.duration;
    for (const auto& [t, within] : {std::pair(forbidden.begin, 1.0), std::pair(forbidden.end, -1.0)}) {
      if (t <= first + 1e-9 || t >= e.other.t_end - 1e-9) continue;
      ASSERT_FALSE(collide(ramps.departing(t), e.other, e.reach - 1e-9)) << "departure " << t;
      const double inside = t + within * (2.0 * kDepartureError + 1e-14 * std::abs(t));
      ASSERT_TRUE(collide(ramps.departing(inside), e.other, e.reach + 1e-9)) << "departure " << t;
    }
  }
  EXPECT_GT(hits, kCases / 10);
}

TEST(Acceleration, OverlapIsFromTheFirstToTheLastTimeWithinReach) {
  support::Dice dice(kSeed);
  int overlaps = 0;
  for (int k = 0; k < kCases; ++k) {
    SCOPED_TRACE(testing::Message() << "seed " << kSeed << ", case " << k);
    const Meeting meeting = random_meeting(dice);
    const auto& [mine, other, reach, begin, end] = meeting;
    const auto found = overlap(mine, other, reach);
    if (begin > end) {
      ASSERT_FALSE(found);
      continue;
    }
    for (int i = 0; i <= 200; ++i) {
      const double t = begin + (end - begin) * i / 200;
      if (meeting.distance(t) < reach - 1e-12) {
        ASSERT_TRUE(found) << "t = " << t;
        ASSERT_GE(t, found->begin - 1e-12);
        ASSERT_LE(t, found->end + 1e-12);
      }
    }
    if (!found) continue;
    ++overlaps;
    for (const double t : {found->begin, found->end}) {
      ASSERT_TRUE(begin <= t && t <= end);
      ASSERT_LT(meeting.distance(t), reach + 1e-9);
      ASSERT_TRUE(t == begin || t == end || meeting.distance(t) > reach - 1e-9) << "t = " << t;
    }
  }
  EXPECT_GT(overlaps, kCases / 40);
}

TEST(Acceleration, ANearestApproachIsAtItsTime) {
  support::Dice dice(kSeed);
  for (int k = 0; k < kCases; ++k) {
    SCOPED_TRACE(testing::Message() << "seed " << kSeed << ", case " << k);
    const Meeting meeting = random_meeting(dice);
    const auto& [mine, other, reach, begin, end] = meeting;
    if (begin > end || (mine.ramp == 0.0 && other.ramp == 0.0)) continue;
    const Approach nearest = nearest_approach(mine, other);
    ASSERT_GE(nearest.t, begin);
    ASSERT_LE(nearest.t, end + 1e-12);
    ASSERT_NEAR(meeting.distance(nearest.t), nearest.distance, 1e-11);
  }
}

/// Both brake to rest side by side: all of the time they are equally near.
TEST(Acceleration, OfTwoThatDoTheSameIsNone) {
  const MovingDisk a({{{0.0, 0.0}, {3.0, 0.0}}, 1.0, 4.0, -1.0});
  const MovingDisk b({{{0.0, 2.0}, {3.0, 2.0}}, 1.0, 4.0, -1.0});
  EXPECT_EQ(nearest_approach(a, b).t, 1.0);
  EXPECT_EQ(nearest_approach(a, b).distance, 2.0);
  EXPECT_FALSE(overlap(a, b, 2.0));
  const auto near = overlap(a, b, 2.5);
  ASSERT_TRUE(near);
  EXPECT_EQ(near->begin, 1.0);
  EXPECT_EQ(near->end, 4.0);
}

TEST(Acceleration, UnsafeIntervalContainsExactlyTimesWithinReach) {
  support::Dice dice(kSeed);
  for (int k = 0; k < kCases; ++k) {
    SCOPED_TRACE(testing::Message() << "seed " << kSeed << ", case " << k);
    const Encounter e = random_ramps(dice).encounter;
    const UnsafeInterval unsafe = unsafe_interval(e.from, e.other, e.reach);
    const double last = std::min(e.other.t_end, e.other.t_start + 20.0);
    for (int i = 1; i < 50; ++i) {
      const double t = e.other.t_start + (last - e.other.t_start) * i / 50;
      const double distance = (e.other.at(t) - e.from).norm();
      if (std::abs(distance - e.reach) > 1e-9) {
        ASSERT_EQ(!unsafe.empty() && unsafe.contains(t), distance < e.reach) << "t = " << t;
      }
    }
  }
}

TEST(Acceleration, OfAlmostNoChangeIsTheClosedForm) {
  support::Dice dice(kSeed);
  for (int k = 0; k < kCases; ++k) {
    SCOPED_TRACE(testing::Message() << "seed " << kSeed << ", case " << k);
    Encounter e = random_encounter(dice);
    const UnsafeInterval closed = forbidden_departures(e.from, e.velocity, e.duration, e.other, e.reach);
    const UnsafeInterval ramped =
        forbidden_departures(e.from, e.velocity, e.duration, e.other, e.reach, 1e-15);
    if (closed.empty() || closed.end - closed.begin < 1e-4) continue;  // paths that only touch
    ASSERT_NEAR(closed.begin, ramped.begin, 1e-6);
    if (closed.end != ramped.end) {
      ASSERT_NEAR(closed.end, ramped.end, 1e-6);
    }
  }
}

MovingDisk from_rest(const Position& from, const Position& to, double t_start, double t_end) {
  return MovingDisk({{from, to}, t_start, t_end, 1.0});
}

TEST(Acceleration, AllowsContact) {
  const MovingDisk still({{{-1, 0}, {-1, 0}}, 0, kForever});
  EXPECT_FALSE(collide(from_rest({0, 0}, {3, 0}, 0, 3), still, 1.0)) << "leaving";
  EXPECT_FALSE(collide(from_rest({0, 0}, {0, 3}, 0, 3), still, 1.0)) << "leaving sideways";
  EXPECT_TRUE(collide(from_rest({0, 0}, {-0.001, 3}, 0, 3), still, 1.0));
  EXPECT_FALSE(collide(from_rest({-4, 1}, {4, 1}, 0, 3), MovingDisk({{{0, 0}, {0, 0}}, 0, kForever}), 1.0))
      << "passing";
  EXPECT_FALSE(collide(from_rest({0, 0}, {3, 0}, 0, 3), from_rest({0, 1}, {3, 1}, 0, 3), 1.0))
      << "side by side";
  EXPECT_TRUE(collide(from_rest({0, 0}, {3, 0}, 0, 3), from_rest({0, 0.999}, {3, 0.999}, 0, 3), 1.0));
}

TEST(Acceleration, OfSymmetricMovesForbidsSymmetricDepartures) {
  // Two moves from rest that cross at right angles, each after the same way.
  const MovingDisk other = from_rest({0, -2}, {0, 2}, 10.0, 14.0);
  const UnsafeInterval forbidden = forbidden_departures({-2, 0}, {1, 0}, 4.0, other, 1.0, 1.0);
  EXPECT_NEAR(forbidden.begin - 10.0, 10.0 - forbidden.end, 1e-8);
  EXPECT_TRUE(forbidden.contains(10.0));
}

TEST(Acceleration, OfAFollowerThatTouchesFromRestForbidsOnlyEarlierDepartures) {
  const MovingDisk first = from_rest({1, 0}, {5, 0}, 0.0, 4.0);
  EXPECT_FALSE(collide(from_rest({0, 0}, {4, 0}, 0.0, 4.0), first, 1.0)) << "at the same time, in contact";
  EXPECT_TRUE(collide(from_rest({0, 0}, {4, 0}, -1e-3, 4.0 - 1e-3), first, 1.0));
  const UnsafeInterval forbidden = forbidden_departures({0, 0}, {1, 0}, 4.0, first, 1.0, 1.0);
  EXPECT_NEAR(forbidden.end, 0.0, 1e-4);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
