// Obstacles, committed motion, the interval margin and near starts against plain loops and samples.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <vector>

#include "core/geometry/disk_motion.h"
#include "core/geometry/tolerance.h"
#include "core/model/trajectory.h"
#include "core/reservation/fixed_reservations.h"
#include "core/reservation/reservation_table.h"
#include "tests/core/support/disks.h"
#include "tests/core/support/obstacles_hit.h"
#include "tests/support/random_problem.h"

namespace fleetplan::core {
namespace TEST_FILE {

constexpr double kSize = 12.0;
constexpr double kHorizon = 30.0;  // seconds; nothing moves later
constexpr double kNear = 1e-6;     // metres

/// What may be met: a disk that is somewhere at some times.
struct Other {
  std::vector<TimedSegment> segments;
  double reach = 0.0;   // metres, with the robot that queries
  double margin = 0.0;  // seconds

  std::optional<double> distance(const Position& p, double t) const {
    for (const TimedSegment& segment : segments) {
      if (t < segment.t_start || t > segment.t_end) continue;
      return (MovingDisk(segment).at(t) - p).norm();
    }
    return std::nullopt;
  }
};

/// Robot 0 queries. Robots 1 to 3 have committed motion and then stay; robots 4 and 5 follow trajectories.
class RandomFixed : public testing::TestWithParam<int> {
 protected:
  RandomFixed() : dice(static_cast<std::uint64_t>(GetParam())) {
    margin = dice.chance(0.5) ? dice.between(0.1, 2.0) : 0.0;
    std::vector<FixedReservations::Committed> robots{idle({1, 1}, kRadius)};
    for (int i = 1; i <= 5; ++i) robots.push_back(robot(i <= 3));
    fixed = std::make_unique<FixedReservations>(kSize, kSize, robots, obstacles(), nullptr,
                                                StopCondition::never());
    std::vector<LargestDisk> disks;
    for (const auto& each : robots) disks.push_back(each.disk);
    table = std::make_unique<ReservationTable>(kSize, kSize, 0.5, disks, nullptr, fixed.get(), margin);
    for (std::size_t i = 1; i < robots.size(); ++i) {
      reserve(i, robots[i], disks[0].pair_radius + disks[i].pair_radius);
    }
  }

  Position place() { return {dice.between(0, kSize), dice.between(0, kSize)}; }

  Trajectory random_trajectory(const Position& start, double t_begin) {
    Trajectory trajectory{start, {}, 0.0};
    double now = t_begin;
    for (int moves = 1 + dice.below(5); moves > 0 && now < kHorizon - 15.0; --moves) {
      if (dice.chance(0.5)) now += dice.between(0.0, 3.0);
      const Position to = place();
      const double arrival = now + (to - trajectory.end()).norm() / dice.between(0.8, 2.0);
      trajectory.moves.push_back({{{trajectory.end(), to}, now, arrival}});
      now = arrival;
    }
    return trajectory;
  }

  static FixedReservations::Committed idle(const Position& at, double radius) {
    return {{radius, radius + kInflation}, at, at, 0.0, {}, radius, radius};
  }

  FixedReservations::Committed robot(bool is_committed) {
    const Position start = place();
    FixedReservations::Committed random = idle(start, dice.between(0.1, 0.6));
    if (!is_committed) return random;
    random.committed = sized(timed_segments(random_trajectory(start, 0.0)), random.disk.radius);
    random.committed_until = random.committed.back().t_start + dice.between(0.1, 3.0);
    random.committed.back().t_end = random.committed_until;
    random.committed_end = random.committed.back().path.to;
    return random;
  }

  void reserve(std::size_t i, const FixedReservations::Committed& each, double reach) {
    std::vector<TimedSegment> after{
        {{each.committed_end, each.committed_end}, each.committed_until, kForever}};
    if (each.committed.empty()) after = timed_segments(random_trajectory(each.start, 0.0));
    table->reserve(i, sized(after, each.disk.radius));
    others.push_back({{each.committed.begin(), each.committed.end()}, reach, margin});
    others.back().segments.insert(others.back().segments.end(), after.begin(), after.end());
  }

  std::vector<MovingObstacle> obstacles() {
    std::vector<MovingObstacle> all;
    for (int i = dice.below(5); i > 0; --i) {
      MovingObstacle obstacle{"o", dice.between(0.1, 0.7), {}, MovingObstacle::After::leaves};
      if (dice.chance(0.3)) obstacle.after = MovingObstacle::After::stays;
      double t = dice.chance(0.5) ? 0.0 : dice.between(0.0, 8.0);
      Other other{{}, kRadius + obstacle.radius, 0.0};
      for (int k = 1 + dice.below(5); k > 0; --k) {
        const Position p = 1.5 * place() - Position(3, 3);  // also beyond the map
        if (!obstacle.motion.empty()) {
          const auto& last = obstacle.motion.back();
          other.segments.push_back({{last.position, p}, last.t, t});
        }
        obstacle.motion.push_back({t, p});
        t += dice.between(0.01, 6.0);
      }
      const auto& last = obstacle.motion.back();
      const bool stays = obstacle.after == MovingObstacle::After::stays;
      other.segments.push_back({{last.position, last.position}, last.t, stays ? kForever : last.t});
      others.push_back(other);
      all.push_back(obstacle);
    }
    obstacle_count = all.size();
    return all;
  }

  /// How much nearer than allowed the robot is at this time to the nearest disk, metres; negative: farther.
  double overlap(const Position& p, double t) const {
    double most = -kSize;
    for (const Other& other : others) {
      for (int k = -kShifts; k <= kShifts; ++k) {
        const double shifted = t + other.margin * k / kShifts;
        if (shifted < 0.0) continue;
        if (const auto distance = other.distance(p, shifted)) most = std::max(most, other.reach - *distance);
        if (other.margin == 0.0) break;
      }
    }
    return most;
  }

  static constexpr double kRadius = 0.4;  // metres, of the robot that queries
  static constexpr double kInflation = 0.1;
  static constexpr int kShifts = 8;
  static constexpr double kWide = 2e-6;  // seconds; more than the instants of obstacles
  support::Dice dice;
  double margin = 0.0;
  std::vector<Other> others;  // the obstacles come first
  std::size_t obstacle_count = 0;
  std::unique_ptr<FixedReservations> fixed;
  std::unique_ptr<ReservationTable> table;
};

TEST_P(RandomFixed, NothingIsMetInASafeInterval) {
  for (int k = 0; k < 40; ++k) {
    SCOPED_TRACE(testing::Message() << "seed " << GetParam() << ", position " << k);
    const Position position = place();
    const auto safe = table->safe_intervals({0, kRadius}, position);
    for (int i = 0; i < 200; ++i) {
      const double t = dice.between(0.0, kHorizon);
      const auto contains = [&](const SafeInterval& interval) { return interval.contains(t); };
      if (std::none_of(safe.begin(), safe.end(), contains)) continue;
      ASSERT_LT(overlap(position, t), kNear) << "at " << t;
    }
    for (const SafeInterval& interval : safe) {  // closed
      ASSERT_LT(overlap(position, interval.begin), kNear);
      if (interval.end == kForever) continue;
      ASSERT_LT(overlap(position, interval.end), kNear);
    }
  }
}

TEST_P(RandomFixed, SafeIntervalsAreTheComplementOfAllCollisions) {
  for (int k = 0; k < 60; ++k) {
    SCOPED_TRACE(testing::Message() << "seed " << GetParam() << ", position " << k);
    const Position position = place();
    const auto safe = table->safe_intervals({0, kRadius}, position);
    for (int i = 0; i < 50; ++i) {
      const double t = dice.between(0.0, kHorizon);
      bool meets = false;
      for (const Other& other : others) {
        for (const TimedSegment& segment : other.segments) {
          const auto hit = unsafe_interval(position, MovingDisk(segment), other.reach - kSearchSlack);
          meets = meets || (!hit.empty() && hit.begin - other.margin < t && t < hit.end + other.margin);
        }
      }
      const auto contains = [&](const SafeInterval& interval) { return interval.contains(t); };
      const bool is_safe = std::any_of(safe.begin(), safe.end(), contains);
      ASSERT_TRUE(is_safe != meets || overlap(position, t) > -1e-4) << "at " << t;
    }
  }
}

TEST_P(RandomFixed, DeparturesAreFreeAndTheEarliest) {
  int delayed = 0;
  for (int k = 0; k < 60; ++k) {
    SCOPED_TRACE(testing::Message() << "seed " << GetParam() << ", move " << k);
    const Segment path{place(), place()};
    const double duration = path.length() / dice.between(0.8, 2.0);
    const double t_min = dice.between(0.0, 12.0);
    const auto departure = table->earliest_departure({0, kRadius}, path, duration, t_min, kForever);
    const Position velocity = (path.to - path.from) / duration;
    for (int i = 0; departure && i <= 100; ++i) {
      const double s = duration * i / 100.0;
      ASSERT_LT(overlap(path.from + s * velocity, *departure + s), kNear) << s << " s after departure";
    }
    std::vector<UnsafeInterval> forbidden;
    for (const Other& other : others) {
      for (const TimedSegment& segment : other.segments) {
        const auto hit = forbidden_departures(path.from, velocity, duration, MovingDisk(segment),
                                              other.reach - kSearchSlack);
        if (!hit.empty())
          forbidden.push_back({hit.begin - other.margin - kWide, hit.end + other.margin + kWide});
      }
    }
    for (int i = 0; i < 50; ++i) {  // all earlier ones are forbidden
      const double earlier = dice.between(t_min, departure.value_or(kHorizon));
      const auto contains = [&](const UnsafeInterval& interval) { return interval.contains(earlier); };
      if (earlier == departure) continue;
      ASSERT_TRUE(std::any_of(forbidden.begin(), forbidden.end(), contains)) << earlier;
    }
    if (departure && *departure > t_min) ++delayed;
  }
  RecordProperty("delayed", delayed);
}

TEST_P(RandomFixed, ObstaclesHitAreThoseThatAreMet) {
  for (int k = 0; k < 40; ++k) {
    SCOPED_TRACE(testing::Message() << "seed " << GetParam() << ", trajectory " << k);
    const auto segments = timed_segments(random_trajectory(place(), 0.0));
    const auto hit = obstacles_hit(*fixed, 0, sized(segments, kRadius));
    for (std::size_t i = 0; i < obstacle_count; ++i) {
      bool meets = false;
      for (const TimedSegment& mine : segments) {
        for (const TimedSegment& theirs : others[i].segments) {
          meets = meets || collide(MovingDisk(mine), MovingDisk(theirs), others[i].reach - kSearchSlack);
        }
      }
      ASSERT_EQ(std::count(hit.begin(), hit.end(), i), meets ? 1 : 0) << "obstacle " << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomFixed, testing::Range(0, 40));

/// Two robots whose planning disks, and often their bare ones, overlap at the start.
class NearStarts : public testing::TestWithParam<int> {};

TEST_P(NearStarts, DoNotComeNearerWhileBothLeave) {
  support::Dice dice(static_cast<std::uint64_t>(GetParam()));
  for (int k = 0; k < 100; ++k) {
    SCOPED_TRACE(testing::Message() << "seed " << GetParam() << ", pair " << k);
    const auto direction = [&] {
      const double angle = dice.between(-std::numbers::pi, std::numbers::pi);
      return Position(std::cos(angle), std::sin(angle));
    };
    const Position a(6, 6);
    const double apart = dice.between(0.3, 1.0);
    const Position b = a + apart * direction();
    constexpr double kRadius = 0.5;
    const Terminals at_a{a, std::nullopt, kRadius, 0.0, 0.0, 0.0, kRadius};
    const Terminals at_b{b, std::nullopt, kRadius, 0.0, 0.0, 0.0, kRadius};
    const Contacts contacts({at_a, at_b});
    ReservationTable table(kSize, kSize, 1.0, disks_of({kRadius, kRadius}), &contacts);
    const double leaves = dice.between(0.0, 3.0);
    const Segment theirs{b, b + 3.0 * direction()};
    const std::vector<TimedMove> moves{{{theirs, leaves, leaves + 3.0}}};
    table.reserve(1, sized(timed_segments({b, moves, 0.0}), kRadius));
    ASSERT_GE(table.safe_intervals({0, kRadius}, a).front().end, leaves) << "both may stand there";
    const Segment mine{a, a + 3.0 * direction()};
    const auto departure =
        table.earliest_departure({0, kRadius}, mine, 3.0, dice.between(0.0, 3.0), leaves + 1.0);
    if (!departure) continue;
    for (int i = 0; i <= 300; ++i) {
      const double t = *departure + 0.01 * i;
      const double s = std::clamp(t - leaves, 0.0, 3.0);
      const Position other = b + s / 3.0 * (theirs.to - theirs.from);
      const bool arrived = s == 3.0;  // then the whole distance counts
      ASSERT_GT((mine.from + 0.01 * i / 3.0 * (mine.to - mine.from) - other).norm(),
                (arrived ? 1.0 : apart) - kNear)
          << t;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, NearStarts, testing::Range(0, 20));

}  // namespace TEST_FILE
}  // namespace fleetplan::core
