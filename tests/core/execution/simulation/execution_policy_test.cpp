#include "core/execution/simulation/execution_policy.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>

#include "tests/core/execution/simulation/study.h"
#include "tests/support/step_limit.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::PlanBuilder;

/// Disturbed actions of a plan in which everything takes `factor` times as long.
DisturbedActions slowed(const RobotPlan& plan, double factor) {
  DisturbedActions disturbed;
  for (const Action& action : plan.actions) {
    const bool waits = action.type == Action::Type::wait;
    disturbed.actions.push_back({0.0, waits ? 0.0 : factor * (action.t_end - action.t_start)});
  }
  return disturbed;
}

std::vector<double> ends_of(const PlannedExecution& planned, const std::vector<DisturbedActions>& disturbed) {
  std::vector<double> ends;
  const auto executed = execute_plans(planned, disturbed, StopCondition::never());
  for (const ExecutedProgress& progress : *executed) {
    ends.push_back(progress.arrived ? progress.end() : -1.0);
  }
  return ends;
}

/// A robot that drives 2 m, waits 3 s, and drives on for 4 m: it arrives at 9 s.
struct DriveAndWait {
  std::vector<Robot> robots{robot_at(1, 1)};
  std::vector<RobotPlan> plans{
      PlanBuilder(0, robots[0]).translate_to(3, 1).wait(3.0).translate_to(7, 1).build()};
  OccupancyGrid grid = open_map();

  double end(ExecutionPolicy policy, double factor, double max_delay = 0.0) {
    PlannedExecution planned = simulated(grid, robots, plans, policy).execution;
    planned.max_delay = max_delay;
    return ends_of(planned, {slowed(plans[0], factor)}).front();
  }
};

TEST(ExecutionPolicies, TakeTheirPlannedTimeUndisturbed) {
  DriveAndWait scene;
  EXPECT_DOUBLE_EQ(scene.end(ExecutionPolicy::open_loop, 1.0), 9.0);
  EXPECT_DOUBLE_EQ(scene.end(ExecutionPolicy::absorb_waits, 1.0), 9.0);
  EXPECT_DOUBLE_EQ(scene.end(ExecutionPolicy::clock_stop, 1.0), 9.0);
}

TEST(OpenLoop, KeepsWaitsAtTheirPlannedDuration) {
  EXPECT_DOUBLE_EQ(DriveAndWait().end(ExecutionPolicy::open_loop, 2.0), 2 * 2 + 3 + 2 * 4);
}

TEST(AbsorbWaits, EndsWaitsAtTheirPlannedTime) {
  EXPECT_DOUBLE_EQ(DriveAndWait().end(ExecutionPolicy::absorb_waits, 2.0), 5 + 2 * 4);
}

TEST(AbsorbWaits, SkipsWaitsWhosePlannedTimeHasPassed) {
  EXPECT_DOUBLE_EQ(DriveAndWait().end(ExecutionPolicy::absorb_waits, 4.0), 4 * 2 + 4 * 4);
}

TEST(AbsorbWaits, KeepsServices) {
  DriveAndWait scene;
  scene.robots[0].via = {Goal{Position(3, 1), std::nullopt, 2.0}};
  scene.robots[0].goal = Goal{Position(7, 1), std::nullopt};
  scene.plans[0].actions[1].goal = 0;
  EXPECT_DOUBLE_EQ(scene.end(ExecutionPolicy::absorb_waits, 1.0), 9.0);
  EXPECT_DOUBLE_EQ(scene.end(ExecutionPolicy::absorb_waits, 4.0), 4 * 2 + 2 + 4 * 4);
}

TEST(Dependencies, SkipWaitsThatOnlyGiveWayButNotServicesOrAddedWaits) {
  DriveAndWait scene;
  EXPECT_DOUBLE_EQ(scene.end(ExecutionPolicy::dependencies, 1.0), 6.0);
  scene.robots[0].via = {Goal{Position(3, 1), std::nullopt, 1.0, 4.0}};
  scene.robots[0].goal = Goal{Position(7, 1), std::nullopt};
  scene.plans[0].actions[1].goal = 0;
  EXPECT_DOUBLE_EQ(scene.end(ExecutionPolicy::dependencies, 1.0), 4 + 1 + 4);
  const auto purposes = wait_purposes(scene.robots[0], scene.plans[0].actions, 2.5);
  EXPECT_DOUBLE_EQ(purposes[1].least, 2.5);
  EXPECT_DOUBLE_EQ(purposes[0].least, 0.0);
}

/// Two robots that drive 10 m each.
struct TwoDrivers {
  std::vector<Robot> robots{robot_at(1, 1), robot_at(1, 5)};
  std::vector<RobotPlan> plans{PlanBuilder(0, robots[0]).translate_to(11, 1).build(),
                               PlanBuilder(1, robots[1]).translate_to(11, 5).build()};
  OccupancyGrid grid = open_map();

  std::vector<ExecutedProgress> execute(std::vector<Dependency> dependencies, double first_factor) {
    return *execute(std::move(dependencies), first_factor, StopCondition::never());
  }
  std::optional<std::vector<ExecutedProgress>> execute(std::vector<Dependency> dependencies,
                                                       double first_factor, const StopCondition& stop) {
    PlannedExecution planned = simulated(grid, robots, plans, ExecutionPolicy::dependencies).execution;
    planned.dependencies = std::move(dependencies);
    return execute_plans(planned, {slowed(plans[0], first_factor), slowed(plans[1], 1.0)}, stop);
  }
};

/// However many dependencies there are, the stop condition is asked soon. The same dependency many times
/// counts once.
TEST(Dependencies, EndWithTheStopHoweverManyTheyAre) {
  const Dependency one{{1, 0, 0.4}, {0, 0, 0.5}, 0.0};
  const std::vector<Dependency> many(100'000, one);
  support::StepLimit limit(100);
  EXPECT_FALSE(TwoDrivers().execute(many, 3.0, support::counted(limit)));
  EXPECT_LT(limit.late(), 10);
  EXPECT_EQ(TwoDrivers().execute(many, 3.0)[1].end(), TwoDrivers().execute({one}, 3.0)[1].end());
}

TEST(Dependencies, HoldARobotAtItsGateUntilTheOtherOneIsThere) {
  // Robot 1 may not pass 4 m until robot 0 has reached 5 m, which takes 15 s.
  const auto executed = TwoDrivers().execute({{{1, 0, 0.4}, {0, 0, 0.5}, 0.0}}, 3.0);
  EXPECT_DOUBLE_EQ(executed[0].end(), 30.0);
  EXPECT_DOUBLE_EQ(knot_at(executed[1], 4.0).fraction, 0.4);
  EXPECT_DOUBLE_EQ(knot_at(executed[1], 14.9).fraction, 0.4);
  EXPECT_NEAR(knot_at(executed[1], 16.0).fraction, 0.5, 1e-12);
  EXPECT_DOUBLE_EQ(executed[1].end(), 21.0);
}

TEST(Dependencies, LetARobotPassAGateThatIsOpenWithoutAStop) {
  const auto executed = TwoDrivers().execute({{{1, 0, 0.4}, {0, 0, 0.3}, 0.0}}, 1.0);
  EXPECT_DOUBLE_EQ(executed[1].end(), 10.0);
}

TEST(Dependencies, AreFollowedBackAndForth) {
  const auto executed = TwoDrivers().execute(
      {{{1, 0, 0.2}, {0, 0, 0.4}, 0.0}, {{0, 0, 0.6}, {1, 0, 0.5}, 0.0}, {{1, 0, 0.8}, {0, 0, 1.0}, 0.0}},
      1.0);
  // Robot 1 passes 2 m at 4 s and reaches 5 m at 7 s. Robot 0 passes 6 m then and ends at 11 s.
  EXPECT_NEAR(executed[0].end(), 11.0, 1e-12);
  EXPECT_NEAR(executed[1].end(), 13.0, 1e-12);
}

TEST(Dependencies, OnEachOtherLeaveRobotsStanding) {
  const auto executed =
      TwoDrivers().execute({{{1, 0, 0.2}, {0, 0, 0.6}, 0.0}, {{0, 0, 0.3}, {1, 0, 0.4}, 0.0}}, 1.0);
  EXPECT_FALSE(executed[0].arrived);
  EXPECT_FALSE(executed[1].arrived);
  EXPECT_DOUBLE_EQ(executed[0].knots.back().fraction, 0.3);
  EXPECT_DOUBLE_EQ(executed[1].knots.back().fraction, 0.2);
}

TEST(ClockStop, LetsALateRobotCatchUpWhileOthersStand) {
  // Robot 0 halts for 8 s after 2 s; with 3 s of delay allowed, robot 1 stands for the other 5.
  TwoDrivers scene;
  PlannedExecution planned =
      simulated(scene.grid, scene.robots, scene.plans, ExecutionPolicy::clock_stop).execution;
  planned.max_delay = 3.0;
  std::vector<DisturbedActions> disturbed{slowed(scene.plans[0], 1.0), slowed(scene.plans[1], 1.0)};
  disturbed[0].all_halts = {{2.0, 8.0}};
  disturbed[0].actions[0].halts = {0, 1};
  const auto executed = *execute_plans(planned, disturbed, StopCondition::never());
  EXPECT_NEAR(executed[0].end(), 18.0, 1e-9);
  EXPECT_NEAR(executed[1].end(), 15.0, 1e-9);
  EXPECT_NEAR(knot_at(executed[1], 5.0).fraction, 0.5, 1e-9);
  EXPECT_NEAR(knot_at(executed[1], 9.9).fraction, 0.5, 1e-9);
  EXPECT_NEAR(knot_at(executed[1], 11.0).fraction, 0.6, 1e-9);
}

TEST(ClockStop, GoesAsSlowlyAsARobotThatIsAsLateAsAllowed) {
  // At half the speed, robot 0 is 2 s late after 4 s; then the clock has half its pace.
  TwoDrivers scene;
  PlannedExecution planned =
      simulated(scene.grid, scene.robots, scene.plans, ExecutionPolicy::clock_stop).execution;
  planned.max_delay = 2.0;
  const auto executed = *execute_plans(planned, {slowed(scene.plans[0], 2.0), slowed(scene.plans[1], 1.0)},
                                       StopCondition::never());
  EXPECT_NEAR(executed[0].end(), 20.0, 1e-9);
  EXPECT_NEAR(executed[1].end(), 4.0 + (10.0 - 4.0) * 2.0, 1e-9);
}

/// The planned time of a progress.
double planned_time(const RobotPlan& plan, const ExecutionKnot& knot) {
  const Action& action = plan.actions[knot.action];
  return action.t_start + knot.fraction * (action.t_end - action.t_start);
}

TEST(ClockStop, KeepsRandomRobotsWithinTheDelayOfEachOther) {
  constexpr double kMaxDelay = 1.5;
  for (unsigned seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    const RandomFleet fleet = random_fleet(random, 5, 20.0, 8);
    const OccupancyGrid grid = open_map();
    PlannedExecution planned =
        simulated(grid, fleet.robots, fleet.plans, ExecutionPolicy::clock_stop).execution;
    planned.max_delay = kMaxDelay;
    const auto disturbed = *draw_disturbances(fleet.plans, rough(), seed, 0, StopCondition::never());
    const auto executed = *execute_plans(planned, disturbed, StopCondition::never());
    double longest = 0.0;
    for (const ExecutedProgress& progress : executed) longest = std::max(longest, progress.end());
    for (double t = 0.05; t < longest; t += 0.05) {
      double latest = 1e9;
      double first = 0.0;
      for (std::size_t k = 0; k < executed.size(); ++k) {
        if (executed[k].knots.empty()) continue;
        const double at = planned_time(fleet.plans[k], knot_at(executed[k], t));
        const bool waits = fleet.plans[k].actions[knot_at(executed[k], t).action].type == Action::Type::wait;
        first = std::max(first, at);
        if (t < executed[k].end() && !waits) latest = std::min(latest, at);
      }
      ASSERT_LE(first, latest + kMaxDelay + 1e-6) << t;
    }
    for (std::size_t k = 0; k < executed.size(); ++k) {
      EXPECT_TRUE(executed[k].arrived);
      EXPECT_GE(executed[k].end(), fleet.plans[k].cost - 1e-6);
    }
  }
}

TEST(ExecutionPolicies, EndWhenTheStopConditionIsMet) {
  TwoDrivers scene;
  const StopCondition met(StopCondition::Clock::now());
  for (const auto policy : {ExecutionPolicy::open_loop, ExecutionPolicy::absorb_waits,
                            ExecutionPolicy::dependencies, ExecutionPolicy::clock_stop}) {
    const PlannedExecution planned = simulated(scene.grid, scene.robots, scene.plans, policy).execution;
    EXPECT_FALSE(execute_plans(planned, {slowed(scene.plans[0], 1.0), slowed(scene.plans[1], 1.0)}, met));
  }
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
