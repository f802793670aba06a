#include "core/geometry/disk_motion.h"

#include <gtest/gtest.h>

#include <cmath>

namespace fleetplan::core {
namespace TEST_FILE {

MovingDisk wait(double x, double y, double t_start, double t_end) {
  return MovingDisk(TimedSegment{{{x, y}, {x, y}}, t_start, t_end});
}

MovingDisk move(const Position& from, const Position& to, double t_start, double t_end) {
  return MovingDisk(TimedSegment{{from, to}, t_start, t_end});
}

TEST(MovingDisk, FollowsItsSegment) {
  const MovingDisk disk = move({1, 2}, {5, 0}, 10, 12);
  EXPECT_EQ(disk.at(10), Position(1, 2));
  EXPECT_EQ(disk.at(11), Position(3, 1));
  EXPECT_EQ(disk.at(12), Position(5, 0));
  EXPECT_EQ(wait(1, 2, 3, kForever).at(1e6), Position(1, 2));
}

TEST(Collide, AllowsPassingInContact) {
  const MovingDisk still = wait(0, 1, 0, kForever);
  EXPECT_FALSE(collide(move({-3, 0}, {3, 0}, 0, 6), still, 1.0));
  EXPECT_TRUE(collide(move({-3, 0}, {3, 0}, 0, 6), still, 1.0 + 1e-9));
}

TEST(Collide, AllowsEndingInContact) {
  const MovingDisk still = wait(4, 0, 0, kForever);
  EXPECT_FALSE(collide(move({0, 0}, {3, 0}, 0, 3), still, 1.0));
  EXPECT_TRUE(collide(move({0, 0}, {3.000001, 0}, 0, 3), still, 1.0));
}

TEST(Collide, AllowsStartingInContactAndLeaving) {
  const MovingDisk still = wait(-1, 0, 0, kForever);
  EXPECT_FALSE(collide(move({0, 0}, {3, 0}, 0, 3), still, 1.0));
  EXPECT_FALSE(collide(move({0, 0}, {0, 3}, 0, 3), still, 1.0));
  EXPECT_TRUE(collide(move({0, 0}, {-0.1, 3}, 0, 3), still, 1.0));
}

TEST(Collide, AllowsMovingSideBySideInContact) {
  EXPECT_FALSE(collide(move({0, 0}, {3, 0}, 0, 3), move({0, 1}, {3, 1}, 0, 3), 1.0));
  EXPECT_TRUE(collide(move({0, 0}, {3, 0}, 0, 3), move({0, 0.999}, {3, 0.999}, 0, 3), 1.0));
}

TEST(Collide, RequiresOverlapInTime) {
  const MovingDisk passing = move({0, 0}, {3, 0}, 0, 3);
  EXPECT_FALSE(collide(passing, wait(1, 0, 3.5, kForever), 1.0));
  EXPECT_FALSE(collide(passing, wait(1, 0, 3.0, kForever), 1.0));
  EXPECT_TRUE(collide(passing, wait(2.5, 0, 3.0, kForever), 1.0)) << "at the instant when one segment ends";
}

TEST(Collide, DetectsHeadOnCollision) {
  const MovingDisk left = move({0, 0}, {10, 0}, 0, 10);
  EXPECT_TRUE(collide(left, move({10, 0}, {0, 0}, 0, 10), 1.0));
  EXPECT_FALSE(collide(left, move({10, 1}, {0, 1}, 0, 10), 1.0));
}

TEST(UnsafeInterval, OfPassingDiskContainsTimesWithinReach) {
  const UnsafeInterval unsafe = unsafe_interval({5, 0}, move({0, 0}, {10, 0}, 2, 7), 1.0);
  EXPECT_DOUBLE_EQ(unsafe.begin, 4.0);
  EXPECT_DOUBLE_EQ(unsafe.end, 5.0);
}

TEST(UnsafeInterval, IsClippedToSegment) {
  const UnsafeInterval unsafe = unsafe_interval({0, 0}, move({0, 0}, {0.25, 0}, 2, 3), 1.0);
  EXPECT_EQ(unsafe.begin, 2.0);
  EXPECT_EQ(unsafe.end, 3.0);
}

TEST(UnsafeInterval, OfWaitingDiskIsWholeWaitOrEmpty) {
  const UnsafeInterval near = unsafe_interval({0.5, 0}, wait(0, 0, 2, kForever), 1.0);
  EXPECT_EQ(near.begin, 2.0);
  EXPECT_EQ(near.end, kForever);
  EXPECT_TRUE(unsafe_interval({1.0, 0}, wait(0, 0, 2, kForever), 1.0).empty()) << "touching";
  EXPECT_TRUE(unsafe_interval({0.0, 0}, wait(0, 0, 2, 2), 1.0).empty()) << "a wait of no length";
}

TEST(UnsafeInterval, IsEmptyIfDiskOnlyTouches) {
  EXPECT_TRUE(unsafe_interval({5, 1}, move({0, 0}, {10, 0}, 0, 10), 1.0).empty());
  EXPECT_TRUE(unsafe_interval({11, 0}, move({0, 0}, {10, 0}, 0, 10), 1.0).empty());
}

TEST(ForbiddenDepartures, OfCrossingPathsMatchClosedForm) {
  // My disk crosses (0, 0) two seconds after its departure, the other at t = 5; both at 1 m/s, at a right
  // angle.
  const MovingDisk other = move({0, -5}, {0, 5}, 0, 10);
  const UnsafeInterval forbidden = forbidden_departures({-2, 0}, {1, 0}, 4.0, other, 1.0);
  EXPECT_NEAR(forbidden.begin, 3.0 - std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(forbidden.end, 3.0 + std::sqrt(2.0), 1e-12);
}

TEST(ForbiddenDepartures, OntoDiskThatStaysHaveNoEnd) {
  const UnsafeInterval forbidden = forbidden_departures({-3, 0}, {1, 0}, 6.0, wait(0, 0, 10, kForever), 1.0);
  EXPECT_NEAR(forbidden.begin, 6.0, 1e-12) << "past it just in time";
  EXPECT_EQ(forbidden.end, kForever);
}

TEST(ForbiddenDepartures, AreEmptyIfDisksOnlyTouch) {
  EXPECT_TRUE(forbidden_departures({-3, 1}, {1, 0}, 6.0, wait(0, 0, 0, kForever), 1.0).empty());
  EXPECT_TRUE(forbidden_departures({-3, 0}, {1, 0}, 2.0, wait(0, 0, 0, kForever), 1.0).empty());
  EXPECT_TRUE(forbidden_departures({-3, 1}, {1, 0}, 6.0, move({9, 0}, {-9, 0}, 0, 18), 1.0).empty());
}

TEST(ForbiddenDepartures, OfEqualVelocitiesKeepDistance) {
  // Both go from x = 0 to x = 5 at 1 m/s; a metre apart is a second apart.
  const UnsafeInterval forbidden =
      forbidden_departures({0, 0}, {1, 0}, 5.0, move({0, 0}, {5, 0}, 10, 15), 1.0);
  EXPECT_NEAR(forbidden.begin, 9.0, 1e-12);
  EXPECT_NEAR(forbidden.end, 11.0, 1e-12);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
