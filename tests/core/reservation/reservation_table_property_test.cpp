// The indexed table against plain loops over everything that was committed.

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <set>
#include <vector>

#include "core/geometry/disk_motion.h"
#include "core/geometry/tolerance.h"
#include "core/model/trajectory.h"
#include "core/reservation/reservation_table.h"
#include "tests/core/support/disks.h"
#include "tests/support/random_problem.h"

namespace fleetplan::core {
namespace TEST_FILE {

constexpr double kWidth = 12.0;
constexpr double kHeight = 9.0;
constexpr double kLarge = 6.0;      // metres: the radius of a robot much larger than the others
constexpr double kRounding = 1e-8;  // seconds

/// Robots of many radii, more than the table has classes, some of them with reservations; one of them
/// queries.
class RandomReservations : public testing::TestWithParam<int> {
 protected:
  RandomReservations()
      : dice(static_cast<std::uint64_t>(GetParam())),
        radii(random_radii()),
        table(kWidth, kHeight, 0.5, disks_of(radii)),
        committed(radii.size()) {
    for (std::size_t robot = 1; robot < radii.size(); ++robot) reserve(robot);
    for (std::size_t robot = 1; robot < radii.size(); ++robot) {  // remove some reservations, renew others
      if (dice.chance(0.6)) continue;
      table.remove(robot);
      committed[robot].clear();
      if (dice.chance(0.5)) reserve(robot);
    }
    querying = static_cast<std::size_t>(dice.below(static_cast<int>(radii.size())));
    table.remove(querying);
    committed[querying].clear();
  }

  std::vector<double> random_radii() {
    std::vector<double> random;
    const bool equal = dice.chance(0.2);
    for (int i = 1 + dice.below(16); i >= 0; --i) random.push_back(equal ? 0.4 : dice.between(0.05, 1.2));
    if (dice.chance(0.2))
      random[static_cast<std::size_t>(dice.below(static_cast<int>(random.size())))] = kLarge;
    return random;
  }

  Position place() { return {dice.between(0, kWidth), dice.between(0, kHeight)}; }

  Trajectory random_trajectory() {
    Trajectory trajectory{place(), {}, 0.0};
    double now = 0.0;
    for (int moves = dice.below(7); moves > 0; --moves) {
      const Position from = trajectory.end();
      const Position to = dice.chance(0.3) ? Position(from.x(), dice.between(0, kHeight)) : place();
      if (dice.chance(0.6)) now += dice.between(0.0, 4.0);
      const double arrival = now + (to - from).norm() / dice.between(0.3, 3.0);
      trajectory.moves.push_back({{{from, to}, now, arrival}});
      now = arrival;
    }
    return trajectory;
  }

  void reserve(std::size_t robot) {
    committed[robot] = timed_segments(random_trajectory());
    table.reserve(robot, sized(committed[robot], radii[robot]));
  }

  Footprint footprint() const { return {querying, radii[querying]}; }

  double reach(std::size_t other) const { return radii[querying] + radii[other] - kSearchSlack; }

  /// Merges intervals. Intervals nearer than `gap` belong together.
  static std::vector<UnsafeInterval> merged(std::vector<UnsafeInterval> intervals, double gap) {
    std::sort(intervals.begin(), intervals.end(),
              [](const auto& a, const auto& b) { return a.begin < b.begin; });
    std::vector<UnsafeInterval> result;
    for (const UnsafeInterval& interval : intervals) {
      if (interval.empty()) continue;
      if (!result.empty() && interval.begin <= result.back().end + gap) {
        result.back().end = std::max(result.back().end, interval.end);
      } else {
        result.push_back(interval);
      }
    }
    return result;
  }

  template <class Interval>
  std::vector<UnsafeInterval> over_all_segments(Interval&& interval, double gap) const {
    std::vector<UnsafeInterval> all;
    for (std::size_t other = 0; other < committed.size(); ++other) {
      for (const TimedSegment& segment : committed[other]) {
        all.push_back(interval(MovingDisk(segment), reach(other)));
      }
    }
    return merged(all, gap);
  }

  support::Dice dice;
  std::vector<double> radii;
  ReservationTable table;
  std::vector<std::vector<TimedSegment>> committed;
  std::size_t querying = 0;
};

TEST_P(RandomReservations, SafeIntervalsAreComplementOfUnsafeIntervals) {
  for (int k = 0; k < 40; ++k) {
    SCOPED_TRACE(testing::Message() << "seed " << GetParam() << ", position " << k);
    const Position position = place();
    const auto unsafe = over_all_segments(
        [&](const MovingDisk& disk, double reach) { return unsafe_interval(position, disk, reach); }, 1e-9);
    std::vector<SafeInterval> expected;
    double free_from = 0.0;
    for (const UnsafeInterval& hit : unsafe) {
      if (hit.begin > free_from + 1e-9) expected.push_back({free_from, hit.begin});
      free_from = hit.end;
    }
    if (free_from < kForever) expected.push_back({free_from, kForever});
    const auto safe = table.safe_intervals(footprint(), position);
    ASSERT_EQ(safe.size(), expected.size());
    for (std::size_t i = 0; i < safe.size(); ++i) {
      ASSERT_EQ(safe[i].begin, expected[i].begin);
      ASSERT_EQ(safe[i].end, expected[i].end);
    }
  }
}

TEST_P(RandomReservations, SafeIntervalsFromATimeOnAreThoseOfAllTimes) {
  for (int k = 0; k < 40; ++k) {
    SCOPED_TRACE(testing::Message() << "seed " << GetParam() << ", position " << k);
    const Position position = place();
    const double t_from = dice.between(0, 25);
    const auto ends_before = [&](const SafeInterval& safe) { return safe.end <= t_from; };
    auto all = table.safe_intervals(footprint(), position);
    auto from = table.safe_intervals(footprint(), position, t_from);
    std::erase_if(all, ends_before);
    std::erase_if(from, ends_before);
    ASSERT_EQ(from.size(), all.size());
    for (std::size_t i = 0; i < from.size(); ++i) {
      ASSERT_EQ(std::max(from[i].begin, t_from), std::max(all[i].begin, t_from));
      ASSERT_EQ(from[i].end, all[i].end);
    }
  }
}

/// The first time from `t` on that is in none of the intervals; none if there is none by `t_max`.
std::optional<double> first_free(const std::vector<UnsafeInterval>& forbidden, double t, double t_max) {
  for (const UnsafeInterval& interval : forbidden) {
    if (interval.contains(t)) t = interval.end;
  }
  if (t > t_max || t == kForever) return std::nullopt;
  return t;
}

TEST_P(RandomReservations, EarliestDepartureIsFirstThatNoSegmentForbids) {
  int delayed = 0;
  for (int k = 0; k < 60; ++k) {
    SCOPED_TRACE(testing::Message() << "seed " << GetParam() << ", move " << k);
    const Segment path{place(), dice.chance(0.2) ? Position(place().x(), 4.0) : place()};
    const double duration = path.length() / dice.between(0.3, 3.0);
    const Position velocity = (path.to - path.from) / duration;
    const double t_min = dice.between(0, 15);
    const double t_max = dice.chance(0.3) ? kForever : t_min + dice.between(0, 10);
    const auto interval = [&](const MovingDisk& disk, double reach) {
      return forbidden_departures(path.from, velocity, duration, disk, reach);
    };
    // Neighbouring segments forbid adjacent intervals; their common end is forbidden as well.
    const auto expected = first_free(over_all_segments(interval, 1e-9), t_min, t_max);
    const auto departure = table.earliest_departure(footprint(), path, duration, t_min, t_max);
    ASSERT_EQ(departure.has_value(), expected.has_value());
    if (!departure) continue;
    ASSERT_NEAR(*departure, *expected, kRounding);
    if (*departure > t_min) ++delayed;
  }
  RecordProperty("delayed", delayed);
}

TEST_P(RandomReservations, RobotsHitAreThoseWithCollidingSegment) {
  for (int k = 0; k < 60; ++k) {
    SCOPED_TRACE(testing::Message() << "seed " << GetParam() << ", trajectory " << k);
    const auto segments = timed_segments(random_trajectory());
    std::set<std::size_t> expected;
    for (const TimedSegment& segment : segments) {
      for (std::size_t other = 0; other < committed.size(); ++other) {
        for (const TimedSegment& theirs : committed[other]) {
          if (collide(MovingDisk(segment), MovingDisk(theirs), reach(other))) expected.insert(other);
        }
      }
    }
    const auto hit = table.robots_hit(querying, sized(segments, radii[querying]));
    ASSERT_EQ(hit, std::vector<std::size_t>(expected.begin(), expected.end()));
  }
}

TEST_P(RandomReservations, CommitAndRemoveChangeNothing) {
  std::vector<std::pair<Position, std::vector<SafeInterval>>> before;
  for (int k = 0; k < 40; ++k) {
    const Position position = place();
    before.emplace_back(position, table.safe_intervals(footprint(), position));
  }
  for (int round = 0; round < 3; ++round) {
    table.reserve(querying, sized(timed_segments(random_trajectory()), radii[querying]));
    table.remove(querying);
  }
  for (const auto& [position, intervals] : before) {
    const auto after = table.safe_intervals(footprint(), position);
    ASSERT_EQ(after.size(), intervals.size()) << "seed " << GetParam();
    for (std::size_t i = 0; i < after.size(); ++i) {
      ASSERT_EQ(after[i].begin, intervals[i].begin);
      ASSERT_EQ(after[i].end, intervals[i].end);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomReservations, testing::Range(0, 60));

}  // namespace TEST_FILE
}  // namespace fleetplan::core
