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

TEST(FleetSteps, FollowingThemChangesNothingWhereTheyCannotBe) {
  Planning p(hall(), {robot_at(0.5, 0.5).to(5.5, 0.5), robot_at(0.5, 1.5).to(5.5, 1.5)});
  p.reservations.follow(1, through({{0.5, 1.5}, {5.5, 1.5}}));
  EXPECT_EQ(FleetSteps(p.reservations, p.random, p.progress).follow({0}, {}, p.never), StepsOutcome::none)
      << "another robot is under way";
  EXPECT_FALSE(p.reservations.trajectory(0));
  EXPECT_TRUE(p.reservations.trajectory(1));
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
