#include "core/model/objective_share.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/support/problem_builder.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::robot_at;
using Objective = PlanOptions::Objective;

/// Its only goal is due at 10 s and has a service of 5 s. So it is late if its cost exceeds 15 s.
Robot heavy_and_due() {
  Robot robot = robot_at(1.0, 1.0).to(5.0, 1.0);
  robot.weight = 3.0;
  robot.goal->service = 5.0;
  robot.goal->due = 10.0;
  return robot;
}

Trajectory of_cost(double cost) {
  Trajectory trajectory;
  trajectory.cost = cost;
  return trajectory;
}

TEST(ObjectiveShare, IsTheCostTimesTheWeight) {
  const Robot robot = heavy_and_due();
  EXPECT_DOUBLE_EQ(share_of(itinerary_of(robot), Objective::flowtime, of_cost(12.0)), 36.0);
  EXPECT_DOUBLE_EQ(least_share(itinerary_of(robot), Objective::flowtime, 12.0), 36.0);
  EXPECT_DOUBLE_EQ(cost_with_share(itinerary_of(robot), Objective::flowtime, 36.0), 12.0);
}

TEST(ObjectiveShare, OfTardinessCountsDelaysAndHardlyAnyCost) {
  const Robot robot = heavy_and_due();
  EXPECT_NEAR(share_of(itinerary_of(robot), Objective::tardiness, of_cost(17.0)), 6.0, 0.01);
  EXPECT_NEAR(share_of(itinerary_of(robot), Objective::tardiness, of_cost(15.0)), 0.0, 0.01);
  EXPECT_LT(share_of(itinerary_of(robot), Objective::tardiness, of_cost(12.0)),
            share_of(itinerary_of(robot), Objective::tardiness, of_cost(15.0)))
      << "both are in time, so the cost decides";
}

TEST(ObjectiveShare, OfTardinessCountsTheGoalsOnTheWay) {
  Robot robot = heavy_and_due();
  robot.via = {Goal{{3.0, 1.0}, std::nullopt}};
  robot.via[0].due = 1.0;
  Trajectory trajectory = of_cost(12.0);
  trajectory.visits = {{0, 3.0, 3.0}};
  EXPECT_NEAR(share_of(itinerary_of(robot), Objective::tardiness, trajectory), 3.0 * 2.0, 0.01);
}

TEST(ObjectiveShare, OfAPlanThatStopsCountsTheEstimates) {
  const Robot robot = heavy_and_due();
  Trajectory trajectory = of_cost(30.0);
  trajectory.stops_at = 20.0;
  trajectory.estimated_visits = {{0, 25.0, 30.0}};
  EXPECT_NEAR(share_of(itinerary_of(robot), Objective::tardiness, trajectory), 3.0 * 15.0, 0.01);
}

TEST(ObjectiveShare, ACostHasNoLessThanItsShare) {
  for (const Objective objective : {Objective::flowtime, Objective::makespan, Objective::tardiness}) {
    for (const double due : {-20.0, 0.0, 10.0, 1000.0}) {
      Robot robot = heavy_and_due();
      robot.goal->due = due;
      for (const double cost : {0.5, 14.0, 15.0, 16.0, 500.0}) {
        const double share = least_share(itinerary_of(robot), objective, cost);
        EXPECT_NEAR(cost_with_share(itinerary_of(robot), objective, share), cost, 1e-6) << due;
        EXPECT_NEAR(share_of(itinerary_of(robot), objective, of_cost(cost)), share, 1e-9) << due;
      }
    }
  }
}

TEST(ObjectiveValue, IsOfAllRobotsWithAWay) {
  std::vector<Robot> robots{heavy_and_due(), heavy_and_due(), heavy_and_due()};
  robots[1].weight = 0.5;
  Plan plan;
  plan.plans = {{0, 18.0, {}}, {1, 40.0, {}}, {2, 50.0, {}}};
  plan.plans[0].visits = {{0, 13.0, kForever}};
  plan.plans[1].estimated_cost = 60.0;
  plan.plans[1].estimated_visits = {{0, 30.0, 35.0}};
  plan.plans[2].estimated_cost = kForever;
  plan.plans[2].estimated_visits = {{0, kForever, kForever}};
  EXPECT_DOUBLE_EQ(objective_value(plan, robots, Objective::flowtime), 3.0 * 18.0 + 0.5 * 60.0);
  EXPECT_DOUBLE_EQ(objective_value(plan, robots, Objective::makespan), 60.0);
  EXPECT_DOUBLE_EQ(objective_value(plan, robots, Objective::tardiness), 3.0 * 3.0 + 0.5 * 20.0);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
