#include "core/reservation/fixed_reservations.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/model/trajectory.h"
#include "core/reservation/reservation_table.h"
#include "tests/core/support/disks.h"
#include "tests/core/support/obstacles_hit.h"
#include "tests/core/support/planning.h"

namespace fleetplan::core {
namespace TEST_FILE {

using Indices = std::vector<std::size_t>;

constexpr double kSize = 20.0;
constexpr double kRadius = 0.5;  // metres, of all robots

MovingObstacle obstacle(std::vector<MovingObstacle::Entry> motion,
                        MovingObstacle::After after = MovingObstacle::After::leaves) {
  return {"person", 0.5, std::move(motion), after};
}

std::vector<SizedSegment> drive(const Position& from, const Position& to, double t_start, double t_end) {
  return sized(timed_segments({from, {{{{from, to}, t_start, t_end}}}, t_end}), kRadius);
}

std::vector<SizedSegment> stand(const Position& at) { return sized(timed_segments({at, {}, 0.0}), kRadius); }

FixedReservations::Committed idle(const Position& at) {
  return {{kRadius, kRadius}, at, at, 0.0, {}, kRadius, kRadius};
}

/// Drives straight from one point to the other, with its centre there at `t_end`.
FixedReservations::Committed committed(const Position& from, const Position& to, double t_end) {
  return {{kRadius, kRadius}, from, to, t_end, {{{{from, to}, 0.0, t_end}, kRadius}}, kRadius, kRadius};
}

/// Robots among fixed reservations.
struct Scene {
  Scene(std::vector<FixedReservations::Committed> robots, const std::vector<MovingObstacle>& obstacles,
        double margin = 0.0, double inflation = 0.0)
      : count(robots.size()),
        fixed(kSize, kSize, inflated(std::move(robots), inflation), obstacles, nullptr,
              StopCondition::never()),
        table(kSize, kSize, 1.0, disks_of(std::vector<double>(count, kRadius), inflation), nullptr, &fixed,
              margin) {}

  static std::vector<FixedReservations::Committed> inflated(std::vector<FixedReservations::Committed> robots,
                                                            double inflation) {
    for (FixedReservations::Committed& robot : robots) robot.disk.pair_radius += inflation;
    return robots;
  }

  std::size_t count;
  FixedReservations fixed;
  ReservationTable table;
};

TEST(FixedReservations, AreEmptyWithoutObstaclesAndCommitments) {
  const FixedReservations none(kSize, kSize, {idle({1, 1})}, {}, nullptr, StopCondition::never());
  EXPECT_TRUE(none.empty());
  EXPECT_TRUE(none.known());
  EXPECT_FALSE(Scene({committed({1, 1}, {2, 1}, 1)}, {}).fixed.empty());
  EXPECT_FALSE(Scene({}, {obstacle({{0, {1, 1}}})}).fixed.empty());
}

TEST(FixedReservations, APassingObstacleSplitsTheSafeInterval) {
  const Scene scene({idle({5, 5})}, {obstacle({{2, {0.5, 5}}, {21, {19.5, 5}}})});  // at x = 5 when t = 6.5
  const auto safe = scene.table.safe_intervals({0, kRadius}, {5, 5});
  ASSERT_EQ(safe.size(), 2u);
  EXPECT_NEAR(safe[0].end, 5.5, 1e-5);
  EXPECT_NEAR(safe[1].begin, 7.5, 1e-5);
  EXPECT_EQ(safe[1].end, kForever);
  EXPECT_EQ(scene.table.safe_intervals({0, kRadius}, {5, 6}).size(), 1u) << "in contact beside its way";
}

TEST(FixedReservations, AnObstacleIsAbsentBeforeItsFirstEntryAndAfterItLeaves) {
  const Scene scene({idle({5, 5})}, {obstacle({{4, {5.2, 5}}, {9, {5.2, 5}}})});
  const auto safe = scene.table.safe_intervals({0, kRadius}, {5, 5});
  ASSERT_EQ(safe.size(), 2u);
  EXPECT_LT(safe[0].end, 4.0) << "the instant of appearing is occupied";
  EXPECT_NEAR(safe[0].end, 4.0, 1e-5);
  EXPECT_GT(safe[1].begin, 9.0) << "that of vanishing, too";
  EXPECT_NEAR(safe[1].begin, 9.0, 1e-5);
}

TEST(FixedReservations, AnObstacleOfOneEntryOccupiesItsInstant) {
  const Scene scene({idle({5, 5})}, {obstacle({{4, {10, 5}}})});
  const auto safe = scene.table.safe_intervals({0, kRadius}, {10, 5});
  ASSERT_EQ(safe.size(), 2u);
  EXPECT_LT(safe[0].end, 4.0);
  EXPECT_GT(safe[1].begin, 4.0);
  const auto departure =
      scene.table.earliest_departure({0, kRadius}, {{2, 5}, {18, 5}}, 16.0, 3.0 - 8.5, kForever);
  ASSERT_TRUE(departure);
  EXPECT_EQ(*departure, 3.0 - 8.5) << "it has passed before";
  EXPECT_GT(*scene.table.earliest_departure({0, kRadius}, {{2, 5}, {18, 5}}, 16.0, -4.0, kForever), -3.0);
}

TEST(FixedReservations, AnObstacleThatStaysBlocksForEver) {
  const Scene scene({idle({5, 5})}, {obstacle({{4, {10, 5}}}, MovingObstacle::After::stays)});
  ASSERT_EQ(scene.table.safe_intervals({0, kRadius}, {10, 5}).size(), 1u);
  EXPECT_FALSE(scene.table.earliest_departure({0, kRadius}, {{2, 5}, {18, 5}}, 16.0, 0.0, kForever));
  EXPECT_TRUE(scene.table.earliest_departure({0, kRadius}, {{2, 6}, {18, 6}}, 16.0, 0.0, kForever));
}

TEST(FixedReservations, MovesWaitForObstaclesAndRobots) {
  Scene scene({idle({5, 5}), idle({10, 19})}, {obstacle({{0, {10, 0.5}}, {19, {10, 19.5}}})});
  const Segment path{{2, 10}, {18, 10}};
  const double alone = *scene.table.earliest_departure({0, kRadius}, path, 16.0, 1.0, kForever);
  EXPECT_NEAR(alone, 1.5 + std::sqrt(2.0), 1e-5);
  scene.table.reserve(1, drive({10, 19}, {10, 10}, 0.0, 12.0));
  EXPECT_FALSE(scene.table.earliest_departure({0, kRadius}, path, 16.0, alone, kForever))
      << "then the robot stays there";
  scene.table.ignore(1, true);
  EXPECT_EQ(scene.table.earliest_departure({0, kRadius}, path, 16.0, 1.0, kForever), alone);
}

TEST(FixedReservations, ObstaclesAreNotRobotsHit) {
  const Scene scene({idle({5, 5})}, {obstacle({{0, {10, 0.5}}, {19, {10, 19.5}}}), obstacle({{3, {5, 5}}})});
  EXPECT_TRUE(scene.table.robots_hit(0, stand({5, 5})).empty());
  EXPECT_EQ(obstacles_hit(scene.fixed, 0, stand({5, 5})), Indices{1});
  EXPECT_EQ(obstacles_hit(scene.fixed, 0, drive({2, 10}, {18, 10}, 2.0, 18.0)), Indices{0});
  EXPECT_TRUE(obstacles_hit(scene.fixed, 0, drive({2, 10}, {18, 10}, 5.0, 21.0)).empty());
}

TEST(FixedReservations, InflationIsNotForObstacles) {
  const Scene scene({idle({5, 5})}, {obstacle({{4, {10, 5}}}, MovingObstacle::After::stays)}, 0.0, 0.2);
  EXPECT_EQ(scene.table.safe_intervals({0, kRadius}, {9, 5}).size(), 1u);
  EXPECT_EQ(scene.table.safe_intervals({0, kRadius}, {9, 5})[0].end, kForever);
}

TEST(FixedReservations, CommittedMotionIsAlwaysReservedForOthersOnly) {
  Scene scene({committed({2, 5}, {8, 5}, 6), idle({5, 9})}, {});
  ASSERT_EQ(scene.table.safe_intervals({1, kRadius}, {5, 5}).size(), 2u);
  EXPECT_EQ(scene.table.safe_intervals({0, kRadius}, {5, 5}).size(), 1u) << "not for itself";
  scene.table.ignore(0, true);
  scene.table.remove(0);
  EXPECT_EQ(scene.table.safe_intervals({1, kRadius}, {5, 5}).size(), 2u);
  EXPECT_EQ(scene.table.robots_certainly_hit(1, drive({5, 9}, {5, 1}, 0, 6)), Indices{0});
  EXPECT_TRUE(scene.table.robots_hit(1, drive({5, 9}, {5, 1}, 0, 6)).empty()) << "it cannot be moved";
  EXPECT_TRUE(scene.table.robots_certainly_hit(0, drive({2, 5}, {8, 5}, 0, 6)).empty());
}

TEST(FixedReservations, OnlyWhatFollowsACommitmentCanBeIgnored) {
  Scene scene({committed({2, 5}, {8, 5}, 6), idle({5, 9})}, {});
  EXPECT_NEAR(scene.table.safe_intervals({1, kRadius}, {8, 5})[0].end, 5.0, 1e-8);
  EXPECT_EQ(scene.table.safe_intervals({1, kRadius}, {8, 5}).size(), 2u) << "nothing is planned for it yet";
  scene.table.reserve(0, {{{{{8, 5}, {8, 5}}, 6.0, kForever}, kRadius}});
  EXPECT_EQ(scene.table.safe_intervals({1, kRadius}, {8, 5}).size(), 1u) << "it stays";
  scene.table.ignore(0, true);
  EXPECT_EQ(scene.table.safe_intervals({1, kRadius}, {8, 5}).size(), 2u);
}

TEST(FixedReservations, AreUnknownWhenTheStopConditionIsMetFirst) {
  const std::vector<MovingObstacle> obstacles{obstacle({{4, {10, 5}}})};
  const FixedReservations fixed(kSize, kSize, {idle({5, 5})}, obstacles, nullptr, met());
  EXPECT_FALSE(fixed.known());
  const ReservationTable table(kSize, kSize, 1.0, disks_of({kRadius}), nullptr, &fixed, 0.0);
  EXPECT_TRUE(table.safe_intervals({0, kRadius}, {1, 1}).empty()) << "nothing can be planned";
  EXPECT_FALSE(table.earliest_departure({0, kRadius}, {{1, 1}, {2, 2}}, 2.0, 0.0, kForever));
}

TEST(FixedReservations, ARobotMayStayWhereCommittedMotionPassesWithinTheInflatedDistanceOnly) {
  Scene scene({committed({2, 5}, {18, 5}, 16), idle({10, 6.1})}, {}, 0.0, 0.2);  // 1.1 m, inflated 1.4 m
  const auto safe = scene.table.safe_intervals({1, kRadius}, {10, 6.1});
  ASSERT_EQ(safe.size(), 1u);
  EXPECT_EQ(safe[0].end, kForever);
  EXPECT_EQ(scene.table.safe_intervals({1, kRadius}, {11, 6.1}).size(), 2u) << "not elsewhere";
  EXPECT_GT(*scene.table.earliest_departure({1, kRadius}, {{10, 6.1}, {10, 9}}, 3.0, 7.5, kForever), 8.0);
  EXPECT_TRUE(scene.table.robots_certainly_hit(1, stand({10, 6.1})).empty());
}

TEST(FixedReservations, AMeasuredStartMayOverlapARobotThatDrivesAway) {
  const Scene scene({committed({5.9, 5}, {9, 5}, 4), idle({5, 5})}, {});
  EXPECT_EQ(scene.table.safe_intervals({1, kRadius}, {5, 5}).size(), 1u);
  const Scene nearer({committed({5.9, 5}, {2, 5}, 4), idle({5, 5})}, {});
  EXPECT_LT(nearer.table.safe_intervals({1, kRadius}, {5, 5})[0].end, 1e-6)
      << "but not one that comes nearer";
}

TEST(FixedReservations, TheMarginKeepsRobotsApartInTime) {
  const Scene scene({committed({2, 5}, {18, 5}, 16), idle({10, 9})}, {}, 1.5);  // at x = 10 when t = 8
  const auto safe = scene.table.safe_intervals({1, kRadius}, {10, 5});
  ASSERT_EQ(safe.size(), 2u);
  EXPECT_NEAR(safe[0].end, 7.0 - 1.5, 1e-6);
  EXPECT_NEAR(safe[1].begin, 9.0 + 1.5, 1e-6);
  const Segment across{{10, 9}, {10, 1}};
  EXPECT_NEAR(*scene.table.earliest_departure({1, kRadius}, across, 8.0, 3.0, kForever),
              4.0 + std::sqrt(2.0) + 1.5, 1e-6);
}

TEST(FixedReservations, TheMarginIsNotForObstacles) {
  const Scene scene({idle({10, 9})}, {obstacle({{0, {2, 5}}, {16, {18, 5}}})}, 1.5);
  EXPECT_NEAR(scene.table.safe_intervals({0, kRadius}, {10, 5})[0].end, 7.0, 1e-5);
}

TEST(FixedReservations, ACommitmentMayEndWhereAnotherRobotHasJustPassed) {
  const Scene scene({committed({2, 5}, {18, 5}, 16), committed({10, 15}, {10, 5}, 9.5)}, {}, 1.5);
  const auto safe = scene.table.safe_intervals({1, kRadius}, {10, 5});  // at x = 10 when t = 8
  ASSERT_EQ(safe.size(), 2u);
  EXPECT_NEAR(safe[1].begin, 9.0, 1e-6) << "it stays there without a margin";
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
