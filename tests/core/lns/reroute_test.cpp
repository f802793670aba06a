#include "core/lns/reroute.h"

#include <gtest/gtest.h>

#include "tests/core/support/planning.h"

namespace fleetplan::core {
namespace {

using support::exact_text;
using support::plans_of;
using support::robot_at;

constexpr double kUp = 1.5707963267948966;

/// Robot 1 crosses the way of robot 0, which waits for it longer than it must; nobody meets robot 2.
struct Crossing : Planning {
  Crossing()
      : Planning(OccupancyGrid(9, 9, 1.0),
                 {robot_at(0.5, 4.5).to(8.5, 4.5), robot_at(4.5, 0.5, kUp).to(4.5, 8.5),
                  robot_at(8.5, 8.5, -kUp).to(8.5, 7.5)}),
        bounds(instance, movers(), std::vector<double>(instance.size(), kForever), never) {
    state.follow(0, through({{0.5, 4.5}, {8.5, 4.5}}, 6.0));
    state.follow(1, through({{4.5, 0.5}, {4.5, 8.5}}, 1.0));
    state.follow(2, through({{8.5, 8.5}, {8.5, 7.5}}));
  }

  Rerouting reroute_all(const std::vector<std::size_t>& robots, const Aim& aim = {}) {
    return reroute(state, robots, bounds, aim, never);
  }
  double sum() const {
    double sum = 0.0;
    for (const RobotPlan& plan : plans_of(state)) sum += plan.cost;
    return sum;
  }

  void apply(Change change) {
    for (const Change::Part& part : change.parts) state.remove(part.robot);
    for (Change::Part& part : change.parts) state.follow(part.robot, std::move(part.trajectory));
  }

  TautBounds bounds;
};

TEST(Reroute, MakesOneRobotCheaper) {
  Crossing p;
  const double before = p.sum();
  Rerouting rerouting = p.reroute_all({0});
  ASSERT_TRUE(rerouting.change);
  EXPECT_EQ(rerouting.searches, 1);
  ASSERT_EQ(rerouting.change->parts.size(), 1U);
  const double gain = rerouting.change->gain;
  EXPECT_EQ(p.sum(), before) << "nothing has changed so far";
  p.apply(std::move(*rerouting.change));
  EXPECT_NEAR(p.sum(), before - gain, 1e-9);
  support::expect_safe(p.state);
}

TEST(Reroute, LeavesEverybodyElseAlone) {
  Crossing p;
  Rerouting rerouting = p.reroute_all({0, 1, 2});
  ASSERT_TRUE(rerouting.change);
  for (const Change::Part& part : rerouting.change->parts) EXPECT_NE(part.robot, 2U) << "it is hit by nobody";
  const double before = p.sum();
  const double gain = rerouting.change->gain;
  p.apply(std::move(*rerouting.change));
  EXPECT_NEAR(p.sum(), before - gain, 1e-9);
  support::expect_safe(p.state);
}

TEST(Reroute, GainsNothingForARobotAtItsBest) {
  Crossing p;
  EXPECT_FALSE(p.reroute_all({2, 0, 1}).change);
}

TEST(Reroute, MakesNoChangeThatFallsShortOfTheAmbition) {
  Crossing p;
  Aim aim;
  aim.ambition = 0.8;
  EXPECT_TRUE(p.reroute_all({0}, aim).change);
  aim.ambition = 0.99;  // robot 1 is in the way
  EXPECT_FALSE(p.reroute_all({0}, aim).change);
}

TEST(Reroute, KeepsEverybodyBelowTheCeiling) {
  Crossing p;
  Aim aim;
  aim.gain = Aim::Gain::first;
  aim.ceiling = 9.2;
  const Rerouting rerouting = p.reroute_all({0, 1}, aim);
  ASSERT_TRUE(rerouting.change);
  for (const Change::Part& part : rerouting.change->parts) EXPECT_LT(part.trajectory.cost, 9.2);
  aim.ceiling = 8.0;  // what robot 0 costs at least
  EXPECT_FALSE(p.reroute_all({0, 1}, aim).change);
}

TEST(Reroute, LeavesTheStateAsItWas) {
  Crossing p;
  const auto text = [&] {
    Plan plan;
    plan.plans = plans_of(p.state);
    return exact_text(plan);
  };
  const std::string before = text();
  p.reroute_all({0, 1, 2});
  reroute(p.state, {0, 1, 2}, p.bounds, {}, met());
  EXPECT_EQ(text(), before);
  EXPECT_EQ(p.state.conflicting_robots(2, through({{4.5, 0.5}, {4.5, 8.5}}, 1.0)),
            std::vector<std::size_t>{1})
      << "reservations as well";
}

}  // namespace
}  // namespace fleetplan::core
