#include "core/moves/fleet_steps.h"

#include <gtest/gtest.h>

#include "tests/core/support/planning.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::robot_at;

OccupancyGrid hall() {
  return support::ascii_map({"......",  //
                             "......",  //
                             "......"});
}

TEST(FleetSteps, FollowingThemChangesNothingWhenStopped) {
  Planning p(hall(), {robot_at(0.5, 0.5).to(5.5, 0.5), robot_at(5.5, 0.5).to(0.5, 0.5)});
  p.reservations.reserve_place(0, 3.0);
  p.reservations.stay_in_place(1);
  EXPECT_EQ(FleetSteps(p.reservations, p.random, p.progress).follow({0, 1}, {}, met()),
            StepsOutcome::cut_off);
  EXPECT_FALSE(p.reservations.trajectory(0));
  EXPECT_EQ(p.reservations.holds_place_for(0), 3.0);
  EXPECT_EQ(p.reservations.holds_place_for(1), kForever);
}

TEST(FleetSteps, GoRoundRobotsThatStay) {
  Planning p(hall(), {robot_at(0.5, 1.5).to(5.5, 1.5), robot_at(2.5, 1.5), robot_at(3.6, 0.4)});
  p.reservations.stay_in_place(1);
  p.reservations.stay_in_place(2);
  ASSERT_EQ(FleetSteps(p.reservations, p.random, p.progress).follow({0}, {}, p.never),
            StepsOutcome::followed);
  support::expect_safe(p.reservations);
}

/// Two robots change places in a corridor with one bay, through which a third one drives first.
TEST(FleetSteps, LetThoseWhoAreUnderWayPass) {
  Planning p(
      support::ascii_map({"##.##",  //
                          "....."}),
      {robot_at(0.5, 0.5).to(4.5, 0.5), robot_at(4.5, 0.5).to(0.5, 0.5), robot_at(2.5, 1.5).to(3.5, 0.5)});
  const Trajectory through_the_bay = through({{2.5, 1.5}, {2.5, 0.5}, {2.5, 1.5}}, 4.0);
  p.reservations.follow(2, through_the_bay);
  FleetSteps steps(p.reservations, p.random, p.progress);
  EXPECT_NE(steps.follow({0, 1}, {}, p.never), StepsOutcome::followed) << "it comes back into the bay";
  EXPECT_FALSE(p.reservations.trajectory(0));
  ASSERT_TRUE(p.reservations.trajectory(2));
  p.reservations.follow(2, through({{2.5, 1.5}, {2.5, 0.5}, {4.5, 0.5}, {2.5, 0.5}, {2.5, 1.5}}));
  EXPECT_NE(steps.follow({0, 1}, {}, p.never), StepsOutcome::followed) << "it drives into one of them";
  p.reservations.remove(2);
  p.reservations.follow(2, through({{2.5, 1.5}, {2.5, 1.4}, {2.5, 1.5}}, 30.0));
  EXPECT_NE(steps.follow({0, 1}, {}, p.never), StepsOutcome::followed) << "it never leaves the bay";
}

TEST(FleetSteps, WaitForThoseWhoAreUnderWay) {
  Planning p(hall(), {robot_at(0.5, 0.5).to(5.5, 0.5), robot_at(5.5, 2.5).to(0.5, 2.5),
                      robot_at(2.5, 2.5).to(2.5, 1.5)});
  p.reservations.follow(2, through({{2.5, 2.5}, {2.5, 1.5}}, 8.0));
  ASSERT_EQ(FleetSteps(p.reservations, p.random, p.progress).follow({0, 1}, {}, p.never),
            StepsOutcome::followed);
  support::expect_safe(p.reservations);
  EXPECT_GT(p.reservations.trajectory(1)->cost, 9.0);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
