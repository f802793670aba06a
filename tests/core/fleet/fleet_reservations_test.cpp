#include "core/fleet/fleet_reservations.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "tests/core/support/planning.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::robot_at;
using Robots = std::vector<std::size_t>;

struct Hall : CrossedHall {
  /// The robots that conflict with a straight move of 8 s through the middle from t = `departure`.
  Robots crossing_conflicts(double departure = 0.0) const {
    return reservations.conflicting_robots(0, through({{0.5, 2.5}, {8.5, 2.5}}, departure));
  }
};

TEST(FleetReservations, IsEmptyAtFirst) {
  Hall p;
  EXPECT_EQ(p.crossing_conflicts(), Robots{});
  EXPECT_FALSE(p.reservations.trajectory(1));
}

TEST(FleetReservations, ReplacesTheReservationOfARobot) {
  Hall p;
  p.reservations.stay_in_place(1);
  EXPECT_EQ(p.crossing_conflicts(), Robots{1});
  EXPECT_EQ(p.crossing_conflicts(1000.0), Robots{1});
  p.reservations.follow(1, through({{4.5, 2.5}, {4.5, 4.5}}));
  EXPECT_TRUE(p.reservations.trajectory(1));
  EXPECT_EQ(p.crossing_conflicts(), Robots{}) << "robot 1 has left by then";
  p.reservations.follow(1, through({{4.5, 2.5}, {4.5, 4.5}}, 3.0));
  EXPECT_EQ(p.crossing_conflicts(), Robots{1}) << "robot 1 leaves too late";
  p.reservations.reserve_place(1, 3.1);
  EXPECT_FALSE(p.reservations.trajectory(1));
  EXPECT_EQ(p.crossing_conflicts(), Robots{}) << "robot 0 arrives later than that";
  p.reservations.reserve_place(1, 3.3);
  EXPECT_EQ(p.crossing_conflicts(), Robots{1});
  p.reservations.remove(1);
  EXPECT_EQ(p.crossing_conflicts(), Robots{});
}

TEST(FleetReservations, ReservesNothingForZeroSeconds) {
  Hall p;
  p.reservations.stay_in_place(1);
  p.reservations.reserve_place(1, 0.0);
  EXPECT_EQ(p.reservations.conflicting_robots(0, through({{4.5, 2.5}, {5.5, 2.5}})), Robots{});
}

TEST(FleetReservations, FindsRobotsThatCrossAPlace) {
  Hall p;
  p.reservations.follow(0, through({{0.5, 2.5}, {8.5, 2.5}}));
  EXPECT_EQ(p.reservations.robots_crossing_place(1), Robots{0});
  p.reservations.follow(0, through({{0.5, 2.5}, {0.5, 4.5}, {8.5, 4.5}}));
  EXPECT_EQ(p.reservations.robots_crossing_place(1), Robots{});
}

/// Robot 0 may cross the middle of a hall, through which robot 1 is committed to drive from above, from t = 0
/// to t = 3. It ends below the way of robot 0.
struct CommittedHall : Planning {
  CommittedHall()
      : Planning(OccupancyGrid(9, 5, 1.0), {robot_at(0.5, 2.5).to(8.5, 2.5),
                                            robot_at(4.5, 3.5, -kPi / 2).to(0.5, 4.5).drives(4.5, 0.5)}) {}
  static constexpr double kPi = 3.141592653589793;

  Trajectory towards_it() const { return through({{3.5, 2.5}, {4.5, 2.5}, {4.5, 4.5}}); }
};

TEST(FleetReservations, AlwaysReservesCommittedMotion) {
  CommittedHall p;
  const Trajectory early = p.towards_it();
  EXPECT_EQ(p.reservations.robots_committed_against(0, early), Robots{1});
  EXPECT_EQ(p.reservations.conflicting_robots(0, early), Robots{}) << "committed motion does not change";
  p.reservations.stay_in_place(1);
  p.reservations.remove(1);
  EXPECT_EQ(p.reservations.robots_committed_against(0, early), Robots{1});
  EXPECT_EQ(p.reservations.robots_committed_against(1, p.instance.itinerary(1).committed), Robots{});
}

TEST(FleetReservations, ARobotStaysAtItsCommittedEnd) {
  CommittedHall p;
  const Trajectory below = through({{0.5, 0.5}, {8.5, 0.5}}, 10.0);
  EXPECT_EQ(p.reservations.conflicting_robots(0, below), Robots{});
  p.reservations.stay_in_place(1);
  EXPECT_EQ(p.reservations.conflicting_robots(0, below), Robots{1});
  EXPECT_EQ(p.reservations.conflicting_robots(0, through({{4.5, 2.5}, {4.5, 4.5}}, 3.0)), Robots{})
      << "it has left its start for good";
  p.reservations.reserve_place(1, 9.0);
  EXPECT_EQ(p.reservations.conflicting_robots(0, below), Robots{})
      << "until t = 12, and robot 0 arrives after 13";
  p.reservations.reserve_place(1, 11.0);
  EXPECT_EQ(p.reservations.conflicting_robots(0, below), Robots{1});
}

TEST(FleetReservations, FollowsATrajectoryThatBeginsWithCommittedMotion) {
  CommittedHall p;
  Trajectory trajectory = through({{4.5, 3.5}, {4.5, 0.5}, {8.5, 0.5}});
  p.reservations.follow(1, trajectory);
  EXPECT_TRUE(p.reservations.trajectory(1));
  EXPECT_EQ(p.reservations.conflicting_robots(0, through({{4.5, 3.5}, {4.5, 2.5}})), Robots{})
      << "only the committed part";
  EXPECT_EQ(p.reservations.conflicting_robots(0, through({{8.5, 2.5}, {8.5, 0.5}}, 4.0)), Robots{1});
  const auto before = p.reservations.snapshot();
  p.reservations.remove(1);
  p.reservations.restore(before);
  EXPECT_TRUE(p.reservations.trajectory(1));
}

TEST(FleetReservations, SearchesAmongWhatWasSetWithoutTableOnceItResumes) {
  CommittedHall p;
  const Trajectory across = through({{8.5, 2.5}, {8.5, 0.5}}, 4.0);
  const Trajectory below = through({{0.5, 0.5}, {8.5, 0.5}}, 10.0);
  p.reservations.follow(1, through({{4.5, 3.5}, {4.5, 0.5}, {8.5, 0.5}}));
  const FleetReservations::Snapshot following = p.reservations.snapshot();
  p.reservations.stay_in_place(1);
  const FleetReservations::Snapshot staying = p.reservations.snapshot();
  ASSERT_EQ(p.reservations.conflicting_robots(0, across), Robots{});

  p.reservations.set_without_table(following);
  p.reservations.resume();
  EXPECT_EQ(p.reservations.conflicting_robots(0, across), Robots{1});

  p.reservations.set_without_table(staying);
  p.reservations.restore(following);
  EXPECT_EQ(p.reservations.conflicting_robots(0, across), Robots{1});

  p.reservations.set_without_table(staying);
  p.reservations.restore(staying);
  EXPECT_EQ(p.reservations.conflicting_robots(0, across), Robots{});
  EXPECT_EQ(p.reservations.conflicting_robots(0, below), Robots{1});
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
