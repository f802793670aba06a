#include "core/lns/neighbourhood.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/core/support/planning.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::robot_at;
using testing::ElementsAre;
using testing::SizeIs;
using testing::UnorderedElementsAre;

/// Robot 0 passes around robot 1, which stands on its straight path. Robot 2 passes near robot 0's goal.
/// Robot 3 is far from all others, and robot 4 is parked.
struct Hall : Planning {
  Hall()
      : Planning(
            OccupancyGrid(21, 21, 1.0),
            {robot_at(0.5, 2.5).to(8.5, 2.5), robot_at(4.5, 2.5).to(4.5, 2.5),
             robot_at(8.5, 0.5).to(10.5, 2.5), robot_at(18.5, 20.5).to(20.5, 20.5), robot_at(0.5, 20.5)}) {
    reservations.follow(0, through({{0.5, 2.5}, {4.5, 4.5}, {8.5, 2.5}}));
    reservations.follow(1, through({{4.5, 2.5}}));
    reservations.follow(2, through({{8.5, 0.5}, {10.5, 2.5}}));
    reservations.follow(3, through({{18.5, 20.5}, {20.5, 20.5}}));
    reservations.stay_in_place(4);
  }

  std::vector<std::size_t> select(std::size_t first, Neighbourhood kind, std::size_t size) {
    return NeighbourhoodSelection(state, movers(), never).select(first, kind, size, random);
  }
};

TEST(NeighbourhoodSelection, OfSizeOneIsTheFirstRobot) {
  Hall p;
  for (std::size_t kind = 0; kind < kNeighbourhoods; ++kind) {
    EXPECT_THAT(p.select(2, static_cast<Neighbourhood>(kind), 1), ElementsAre(2));
  }
}

TEST(NeighbourhoodSelection, ContainsConflictingRobots) {
  Hall p;
  EXPECT_THAT(p.select(0, Neighbourhood::conflicting, 4), ElementsAre(0, 1));
  EXPECT_THAT(p.select(3, Neighbourhood::conflicting, 4), ElementsAre(3)) << "no robot conflicts with it";
}

TEST(NeighbourhoodSelection, ContainsRobotsNearbyAtSomeTime) {
  Hall p;
  EXPECT_THAT(p.select(0, Neighbourhood::nearest, 3), UnorderedElementsAre(0, 1, 2)) << "robot 3 is far away";
}

TEST(NeighbourhoodSelection, ContainsRobotsThatPassTheGoal) {
  Hall p;
  EXPECT_THAT(p.select(0, Neighbourhood::at_goal, 2), ElementsAre(0, 2));
}

TEST(NeighbourhoodSelection, ContainsNoRobotTwice) {
  Hall p;
  EXPECT_THAT(p.select(0, Neighbourhood::random, 16), UnorderedElementsAre(0, 1, 2, 3));
  EXPECT_THAT(p.select(0, Neighbourhood::nearest, 16), UnorderedElementsAre(0, 1, 2, 3));
  EXPECT_THAT(p.select(0, Neighbourhood::random, 2), SizeIs(2));
}

using support::exact_text;
using support::plans_of;

constexpr double kUp = 1.5707963267948966;

/// Robot 1 crosses the path of robot 0, which waits longer than necessary; no robot conflicts with robot 2.
struct Crossing : Planning {
  Crossing()
      : Planning(OccupancyGrid(9, 9, 1.0),
                 {robot_at(0.5, 4.5).to(8.5, 4.5), robot_at(4.5, 0.5, kUp).to(4.5, 8.5),
                  robot_at(8.5, 8.5, -kUp).to(8.5, 7.5)}),
        bounds(instance, movers(), std::vector<double>(instance.size(), kForever), never) {
    reservations.follow(0, through({{0.5, 4.5}, {8.5, 4.5}}, 6.0));
    reservations.follow(1, through({{4.5, 0.5}, {4.5, 8.5}}, 1.0));
    reservations.follow(2, through({{8.5, 8.5}, {8.5, 7.5}}));
  }

  NeighbourhoodResult plan_again(const std::vector<std::size_t>& robots,
                                 const NeighbourhoodOptions& options = {}) {
    return plan_neighbourhood(state, robots, bounds, options, random, never);
  }
  double sum() const {
    double sum = 0.0;
    for (const RobotPlan& plan : plans_of(reservations)) sum += plan.cost;
    return sum;
  }

  void apply(Change change) {
    for (const Change::Part& part : change.parts) reservations.remove(part.robot);
    for (Change::Part& part : change.parts) reservations.follow(part.robot, std::move(part.trajectory));
  }

  TautPathBounds bounds;
};

TEST(PlanNeighbourhood, MakesOneRobotCheaper) {
  Crossing p;
  const double before = p.sum();
  NeighbourhoodResult result = p.plan_again({0});
  ASSERT_TRUE(result.change);
  EXPECT_GT(result.effort, static_cast<double>(result.expansions)) << "more than the expansions";
  ASSERT_EQ(result.change->parts.size(), 1U);
  const double gain = result.change->gain;
  EXPECT_EQ(p.sum(), before) << "the state is unchanged";
  p.apply(std::move(*result.change));
  EXPECT_NEAR(p.sum(), before - gain, 1e-9);
  support::expect_safe(p.reservations);
}

TEST(PlanNeighbourhood, ChangesOnlyConflictingRobots) {
  Crossing p;
  NeighbourhoodResult result = p.plan_again({0, 1, 2});
  ASSERT_TRUE(result.change);
  for (const Change::Part& part : result.change->parts)
    EXPECT_NE(part.robot, 2U) << "no robot conflicts with it";
  const double before = p.sum();
  const double gain = result.change->gain;
  p.apply(std::move(*result.change));
  EXPECT_NEAR(p.sum(), before - gain, 1e-9);
  support::expect_safe(p.reservations);
}

TEST(PlanNeighbourhood, FindsNoChangeForARobotAtItsLowerBound) {
  Crossing p;
  EXPECT_FALSE(p.plan_again({2, 0, 1}).change);
}

TEST(PlanNeighbourhood, RejectsAGainBelowTheRequiredShare) {
  Crossing p;
  NeighbourhoodOptions options;
  options.min_gain_share = 0.8;
  EXPECT_TRUE(p.plan_again({0}, options).change);
  options.min_gain_share = 0.99;  // robot 1 prevents it
  EXPECT_FALSE(p.plan_again({0}, options).change);
}

TEST(PlanNeighbourhood, AcceptsALossUpToTheLimit) {
  // Where corridors cross, the slow robot loses little behind the fast one, which would lose much behind it.
  Planning p(support::ascii_map({"####.####",  //
                                 "####.####",  //
                                 "####.####",  //
                                 "####.####",  //
                                 ".........",  //
                                 "####.####",  //
                                 "####.####",  //
                                 "####.####",  //
                                 "####.####"}),
             {robot_at(3.2, 4.5).speeds(0.25, 1.5).to(8.5, 4.5), robot_at(4.5, 0.5, kUp).to(4.5, 8.5)});
  const TautPathBounds bounds(p.instance, p.movers(), std::vector<double>(2, kForever), p.never);
  p.reservations.follow(1, p.state.plan_alone(1, p.never));
  p.reservations.follow(0, *p.state.plan(0, kExact, p.never).trajectory);
  NeighbourhoodOptions options;
  options.min_gain_share = 0.9;
  EXPECT_FALSE(plan_neighbourhood(p.state, {0, 1}, bounds, options, p.random, p.never).change);
  options.max_loss = 10.0;
  const NeighbourhoodResult result = plan_neighbourhood(p.state, {0, 1}, bounds, options, p.random, p.never);
  ASSERT_TRUE(result.change);
  EXPECT_LT(result.change->gain, 0.0);
  EXPECT_GT(result.change->gain, -10.0);
}

TEST(PlanNeighbourhood, KeepsAllCostsBelowTheLimit) {
  Crossing p;
  NeighbourhoodOptions options;
  options.gain = NeighbourhoodOptions::Gain::first;
  options.cost_limit = 9.2;
  const NeighbourhoodResult result = p.plan_again({0, 1}, options);
  ASSERT_TRUE(result.change);
  for (const Change::Part& part : result.change->parts) EXPECT_LT(part.trajectory.cost, 9.2);
  options.cost_limit = 8.0;  // the lower bound of robot 0
  EXPECT_FALSE(p.plan_again({0, 1}, options).change);
}

TEST(PlanNeighbourhood, SmoothsTheFirstRobotOnly) {
  Crossing p;
  NeighbourhoodOptions options;
  options.settings = std::nullopt;
  NeighbourhoodResult result = p.plan_again({0, 1}, options);
  ASSERT_TRUE(result.change) << "its wait is longer than necessary";
  EXPECT_EQ(result.expansions, 0);
  ASSERT_EQ(result.change->parts.size(), 1U);
  EXPECT_EQ(result.change->parts.front().robot, 0U);
  const double before = p.sum();
  const double gain = result.change->gain;
  p.apply(std::move(*result.change));
  EXPECT_NEAR(p.sum(), before - gain, 1e-9);
  support::expect_safe(p.reservations);
}

TEST(PlanNeighbourhood, LeavesTheStateUnchanged) {
  Crossing p;
  const auto text = [&] {
    Plan plan;
    plan.plans = plans_of(p.reservations);
    return exact_text(plan);
  };
  const std::string before = text();
  p.plan_again({0, 1, 2});
  plan_neighbourhood(p.state, {0, 1, 2}, p.bounds, {}, p.random, met());
  EXPECT_EQ(text(), before);
  EXPECT_EQ(p.reservations.conflicting_robots(2, through({{4.5, 0.5}, {4.5, 8.5}}, 1.0)),
            std::vector<std::size_t>{1})
      << "reservations as well";
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
