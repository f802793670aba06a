#include "core/reservation/reservation_table.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/model/trajectory.h"
#include "tests/core/support/disks.h"

namespace fleetplan::core {
namespace TEST_FILE {

constexpr double kRadius = 0.5;  // metres, of all robots

/// On a map of 20 m x 20 m.
ReservationTable table_of(std::size_t robots) {
  return {20.0, 20.0, 1.0, disks_of(std::vector<double>(robots, kRadius))};
}

std::vector<SizedSegment> segments(const Trajectory& trajectory) {
  return sized(timed_segments(trajectory), kRadius);
}

std::vector<SizedSegment> drive(const Position& from, const Position& to, double t_start, double t_end) {
  return segments({from, {{{{from, to}, t_start, t_end}}}, t_end});
}

std::vector<SizedSegment> stand(const Position& at) { return segments({at, {}, 0.0}); }

using Robots = std::vector<std::size_t>;

TEST(ReservationTable, AllowsEverythingIfEmpty) {
  const ReservationTable table = table_of(1);
  const auto safe = table.safe_intervals({0, kRadius}, {5, 5});
  ASSERT_EQ(safe.size(), 1u);
  EXPECT_EQ(safe[0].begin, 0.0);
  EXPECT_EQ(safe[0].end, kForever);
  EXPECT_EQ(table.earliest_departure({0, kRadius}, {{1, 1}, {9, 9}}, 8.0, 3.0, kForever), 3.0);
  EXPECT_TRUE(table.robots_hit(0, stand({5, 5})).empty());
}

TEST(ReservationTable, PassingRobotSplitsSafeInterval) {
  ReservationTable table = table_of(2);
  table.reserve(1, drive({0.5, 5}, {19.5, 5}, 2.0, 21.0));  // at x = 5 when t = 6.5
  const auto safe = table.safe_intervals({0, kRadius}, {5, 5});
  ASSERT_EQ(safe.size(), 2u);
  EXPECT_EQ(safe[0].begin, 0.0);
  EXPECT_NEAR(safe[0].end, 5.5, 1e-8);
  EXPECT_NEAR(safe[1].begin, 7.5, 1e-8);
  EXPECT_EQ(safe[1].end, kForever);
  EXPECT_EQ(table.safe_intervals({0, kRadius}, {5, 6}).size(), 1u) << "in contact beside the path";
}

TEST(ReservationTable, HasNoSafeIntervalWhereRobotStands) {
  ReservationTable table = table_of(2);
  table.reserve(1, stand({5, 5}));
  EXPECT_TRUE(table.safe_intervals({0, kRadius}, {5.9, 5}).empty());
  EXPECT_EQ(table.safe_intervals({0, kRadius}, {6, 5}).size(), 1u) << "in contact";
}

TEST(ReservationTable, CountsTheRadiusOfTheFootprintAndThatOfTheSegment) {
  ReservationTable table(20.0, 20.0, 1.0, disks_of({0.5, 0.5}, 0.2));
  table.reserve(1, sized(timed_segments({{5, 5}, {}, 0.0}), 0.2));  // it keeps others 0.4 m away
  EXPECT_TRUE(table.safe_intervals({0, 0.5}, {6.09, 5}).empty());
  EXPECT_EQ(table.safe_intervals({0, 0.5}, {6.11, 5}).size(), 1u);
  EXPECT_TRUE(table.safe_intervals({0, 0.3}, {5.89, 5}).empty());
  EXPECT_EQ(table.safe_intervals({0, 0.3}, {5.91, 5}).size(), 1u);
}

TEST(ReservationTable, JoinsUnsafeIntervalsOfNeighbouringSegments) {
  ReservationTable table = table_of(2);
  const Position middle(5, 5);
  table.reserve(1,
                segments({{1, 5}, {{{{{1, 5}, middle}, 0.0, 4.0}}, {{{middle, {5, 9}}, 6.0, 10.0}}}, 10.0}));
  const auto safe = table.safe_intervals({0, kRadius}, middle);
  ASSERT_EQ(safe.size(), 2u);
  EXPECT_NEAR(safe[0].end, 3.0, 1e-8);
  EXPECT_NEAR(safe[1].begin, 7.0, 1e-8);
}

TEST(ReservationTable, DelaysDepartureUntilRobotsJustTouch) {
  ReservationTable table = table_of(2);
  table.reserve(1, drive({10, 0.5}, {10, 19.5}, 0.0, 19.0));  // crosses y = 10 at t = 9.5
  const Segment path{{2, 10}, {18, 10}};                      // x = 10 after 8 s
  const auto departure = table.earliest_departure({0, kRadius}, path, 16.0, 1.0, kForever);
  ASSERT_TRUE(departure);
  EXPECT_NEAR(*departure, 1.5 + std::sqrt(2.0), 1e-8);
  EXPECT_EQ(table.earliest_departure({0, kRadius}, path, 16.0, 0.0, kForever), 0.0) << "ahead of it";
  EXPECT_FALSE(table.earliest_departure({0, kRadius}, path, 16.0, 1.0, 2.9)) << "too late";
}

TEST(ReservationTable, FindsNoDepartureThroughRobotThatStays) {
  ReservationTable table = table_of(2);
  table.reserve(1, drive({10, 2}, {10, 10}, 5.0, 13.0));  // and stays
  const Segment path{{2, 10}, {18, 10}};
  EXPECT_TRUE(table.earliest_departure({0, kRadius}, path, 16.0, 0.0, kForever)) << "before it comes";
  EXPECT_FALSE(table.earliest_departure({0, kRadius}, path, 16.0, 5.5, kForever));
}

TEST(ReservationTable, ReturnsRobotsHitByTrajectory) {
  ReservationTable table = table_of(4);
  table.reserve(1, stand({5, 5}));
  table.reserve(2, drive({10, 1}, {10, 9}, 0.0, 8.0));  // at y = 5 when t = 4
  table.reserve(3, stand({15, 6}));
  EXPECT_EQ(table.robots_hit(0, drive({1, 5}, {18, 5}, 0.0, 17.0)), (Robots{1}));
  EXPECT_EQ(table.robots_hit(0, drive({1, 5}, {18, 5}, 0.0, 7.0)), (Robots{1, 2}));
  EXPECT_EQ(table.robots_hit(0, drive({1, 5}, {18, 5.1}, 0.0, 17.0)), (Robots{1, 3}));
  EXPECT_EQ(table.robots_hit(0, stand({10, 9.9})), (Robots{2})) << "it stays there in the end";
  EXPECT_TRUE(table.robots_hit(2, stand({10, 9.9})).empty()) << "a robot does not hit itself";
}

TEST(ReservationTable, DoesNotReportRobotsThatAreOnlyTouched) {
  ReservationTable table = table_of(2);
  table.reserve(1, drive({2.1, 3.3}, {17.9, 16.7}, 1.0, 25.7));
  int delayed = 0;
  for (int k = 0; k < 200; ++k) {
    const Segment path{{10.0 + 0.017 * k, 2.0}, {9.3 - 0.013 * k, 18.0}};
    const auto departure = table.earliest_departure({0, kRadius}, path, 16.3, 0.05 * k, kForever);
    ASSERT_TRUE(departure);
    if (*departure == 0.05 * k) continue;
    ++delayed;
    const SizedSegment move{{path, *departure, *departure + 16.3}, kRadius};
    ASSERT_EQ(table.robots_hit(0, {move}), Robots{}) << k;
    const SizedSegment sooner{{path, *departure - 1e-6, *departure + 16.3 - 1e-6}, kRadius};
    ASSERT_EQ(table.robots_hit(0, {sooner}), Robots{1}) << k;
  }
  EXPECT_GT(delayed, 50);
}

TEST(ReservationTable, RemoveUndoesCommit) {
  ReservationTable table = table_of(3);
  table.reserve(1, drive({0.5, 5}, {19.5, 5}, 2.0, 21.0));
  table.reserve(2, stand({5, 5}));
  table.remove(2);
  table.remove(2);  // no effect
  EXPECT_EQ(table.safe_intervals({0, kRadius}, {5, 5}).size(), 2u);
  table.remove(1);
  EXPECT_EQ(table.safe_intervals({0, kRadius}, {5, 5}).size(), 1u);
  table.reserve(1, stand({7, 7}));
  EXPECT_TRUE(table.safe_intervals({0, kRadius}, {7, 7}).empty());
}

TEST(ReservationTable, FiniteReservationEndsOnTime) {
  ReservationTable table = table_of(2);
  table.reserve(1, {{{{{5, 5}, {5, 5}}, 0.0, 3.0}, kRadius}});
  const auto safe = table.safe_intervals({0, kRadius}, {5, 5});
  ASSERT_EQ(safe.size(), 1u);
  EXPECT_EQ(safe[0].begin, 3.0);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
