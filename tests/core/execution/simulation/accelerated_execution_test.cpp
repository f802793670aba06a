// Simulated executions of robots with limited acceleration: times and positions by hand. Also the judge of
// overlaps, which sees where robots are while they start and brake.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/core/execution/simulation/study.h"

namespace fleetplan::core {
namespace TEST_FILE {

/// Up to 2 m/s in 2 s and 2 m; down in 4 s and 4 m.
Robot heavy_robot(double x, double y) {
  Robot robot = robot_at(x, y);
  robot.linear_speed = 2.0;
  robot.linear_acceleration = 1.0;
  robot.linear_deceleration = 0.5;
  return robot;
}

/// The plan of a robot that drives so many metres along x at its limits, from rest to rest.
RobotPlan driven(std::size_t index, const Robot& robot, double metres, double wait = 0.0) {
  const Inertia inertia = robot.linear_inertia();
  Pose to = robot.start;
  to.position.x() += metres;
  RobotPlan plan;
  plan.robot = index;
  if (wait > 0.0) plan.actions.push_back({Action::Type::wait, 0.0, wait, robot.start, robot.start});
  plan.cost = wait + inertia.time(metres, robot.linear_speed);
  Action action{Action::Type::translate, wait, plan.cost, robot.start, to};
  action.profile = fastest_profile(metres, robot.linear_speed, inertia);
  plan.actions.push_back(action);
  return plan;
}

DisturbedActions undisturbed(const RobotPlan& plan) {
  DisturbedActions disturbed;
  for (const Action& action : plan.actions) disturbed.actions.push_back({0.0, action.t_end - action.t_start});
  return disturbed;
}

/// Two robots that drive 18 m each, in 12 s.
struct HeavyPair {
  std::vector<Robot> robots{heavy_robot(1, 1), heavy_robot(1, 5)};
  std::vector<RobotPlan> plans{driven(0, robots[0], 18.0), driven(1, robots[1], 18.0)};
  std::vector<DisturbedActions> disturbed{undisturbed(plans[0]), undisturbed(plans[1])};
  OccupancyGrid grid = open_map(30, 10);

  std::vector<ExecutedProgress> execute(ExecutionPolicy policy, std::vector<Dependency> dependencies = {},
                                        double max_delay = 0.0) {
    PlannedExecution planned = simulated(grid, robots, plans, policy).execution;
    planned.dependencies = std::move(dependencies);
    planned.max_delay = max_delay;
    return *execute_plans(planned, disturbed, StopCondition::never());
  }

  /// Where a robot is at a time, in metres from its start.
  double place(std::size_t plan, const ExecutedProgress& progress, double t) {
    const auto legs =
        *executed_legs(robots[plan], plans[plan].actions, disturbed[plan], progress, StopCondition::never());
    const auto leg = std::find_if(legs.begin(), legs.end(), [&](const Leg& one) { return one.t_end >= t; });
    return position_at(*leg, t).x() - robots[plan].start.position.x();
  }

  std::vector<Action> trace(std::size_t plan, const ExecutedProgress& progress) {
    return *disturbed_actions(plans[plan].actions, disturbed[plan], progress, 1000, StopCondition::never());
  }
};

TEST(AcceleratedExecution, FollowsTheProfileUnderEveryPolicy) {
  HeavyPair scene;
  for (const ExecutionPolicy policy : {ExecutionPolicy::open_loop, ExecutionPolicy::absorb_waits,
                                       ExecutionPolicy::dependencies, ExecutionPolicy::clock_stop}) {
    const auto executed = scene.execute(policy, {}, 1.0);
    EXPECT_NEAR(executed[0].end(), 12.0, 1e-9);
    EXPECT_NEAR(scene.place(0, executed[0], 1.0), 0.5, 1e-9);
    EXPECT_NEAR(scene.place(0, executed[0], 5.0), 8.0, 1e-9);
    EXPECT_NEAR(scene.place(0, executed[0], 10.0), 17.0, 1e-9);
  }
}

TEST(AcceleratedExecution, HasTheFactorOnItsCruiseSpeed) {
  HeavyPair scene;
  scene.disturbed[0].actions[0].factor = 0.5;
  scene.disturbed[0].actions[0].moving *= 2.0;
  const auto executed = scene.execute(ExecutionPolicy::open_loop);
  EXPECT_NEAR(executed[0].end(), 18.0 + 0.5 + 1.0, 1e-9);
  EXPECT_NEAR(scene.place(0, executed[0], 1.0), 0.5, 1e-9) << "it starts as fast as ever";
  const auto trace = scene.trace(0, executed[0]);
  ASSERT_EQ(trace.size(), 1U);
  EXPECT_NEAR(trace[0].profile->cruise, 1.0, 1e-9);
}

TEST(AcceleratedExecution, BrakesForAHaltAndStartsAgain) {
  HeavyPair scene;
  scene.disturbed[0].all_halts = {{5.5, 3.0}};  // at 9 m
  scene.disturbed[0].actions[0].halts = {0, 1};
  for (const ExecutionPolicy policy :
       {ExecutionPolicy::open_loop, ExecutionPolicy::absorb_waits, ExecutionPolicy::dependencies}) {
    const auto executed = scene.execute(policy);
    EXPECT_NEAR(executed[0].end(), 7.5 + 3.0 + 7.5, 1e-9);
    EXPECT_NEAR(scene.place(0, executed[0], 5.5), 8.0, 1e-9) << "it has braked for 2 s";
    EXPECT_NEAR(scene.place(0, executed[0], 8.0), 9.0, 1e-9);
    EXPECT_NEAR(scene.place(0, executed[0], 11.5), 9.5, 1e-9);
    const auto trace = scene.trace(0, executed[0]);
    ASSERT_EQ(trace.size(), 3U);
    EXPECT_EQ(trace[1].type, Action::Type::wait);
    EXPECT_NEAR(trace[0].profile->end, 0.0, 1e-9);
    EXPECT_NEAR(trace[2].profile->start, 0.0, 1e-9);
  }
}

TEST(AcceleratedExecution, StandsAtAClosedGateAndGoesOnFromRest) {
  HeavyPair scene;
  scene.disturbed[0].actions[0].factor = 0.5;
  // Robot 0 is at 9 m after 9.5 s; robot 1 stands at 9 m from 7.5 s on.
  const auto executed = scene.execute(ExecutionPolicy::dependencies, {{{1, 0, 0.5}, {0, 0, 0.5}, 0.0}});
  EXPECT_NEAR(scene.place(1, executed[1], 7.5), 9.0, 1e-9);
  EXPECT_NEAR(scene.place(1, executed[1], 9.5), 9.0, 1e-9);
  EXPECT_NEAR(scene.place(1, executed[1], 10.5), 9.5, 1e-9);
  EXPECT_NEAR(executed[1].end(), 9.5 + 7.5, 1e-9);
}

TEST(AcceleratedExecution, PassesAGateThatOpensBeforeItBrakes) {
  HeavyPair scene;
  // It would brake from 3.5 s and 5 m on; robot 0 is at 4 m then.
  const auto executed = scene.execute(ExecutionPolicy::dependencies, {{{1, 0, 0.5}, {0, 0, 4.0 / 18}, 0.0}});
  EXPECT_NEAR(executed[1].end(), 12.0, 1e-9);
  EXPECT_EQ(scene.trace(1, executed[1]).size(), 1U);
}

TEST(AcceleratedExecution, GoesOnFromTheSpeedThatItHasWhenAGateOpens) {
  HeavyPair scene;
  // Robot 0 is at 9 m after 5.5 s. Robot 1 has then braked to 1 m/s, at 8 m.
  const auto executed = scene.execute(ExecutionPolicy::dependencies, {{{1, 0, 0.5}, {0, 0, 0.5}, 0.0}});
  EXPECT_NEAR(scene.place(1, executed[1], 5.5), 8.0, 1e-9);
  EXPECT_NEAR(scene.place(1, executed[1], 6.5), 9.5, 1e-9);
  EXPECT_NEAR(executed[1].end(), 5.5 + 1.0 + 2.25 + 4.0, 1e-9);
  const auto trace = scene.trace(1, executed[1]);
  ASSERT_EQ(trace.size(), 2U);
  EXPECT_NEAR(trace[0].profile->end, 1.0, 1e-6);
  EXPECT_NEAR(trace[1].profile->start, 1.0, 1e-6);
  EXPECT_NEAR(trace[1].profile->cruise, 2.0, 1e-6);
}

TEST(AcceleratedExecution, HasNoSliversWhereOthersAreTold) {
  HeavyPair scene;
  // Robot 1 waits for robot 0 to be where that begins to cruise, and where it begins to brake.
  for (const double place : {2.0, 14.0, 2.0 + 1e-15, 14.0 - 4e-15}) {
    const auto executed =
        scene.execute(ExecutionPolicy::dependencies, {{{1, 0, 0.9}, {0, 0, place / 18}, 0.0}});
    EXPECT_EQ(scene.trace(0, executed[0]).size(), 1U) << place;
    EXPECT_NEAR(executed[0].end(), 12.0, 1e-9);
  }
}

TEST(AcceleratedExecution, TwoThatBrakeForEachOtherGoOnInTheOrderOfTime) {
  HeavyPair scene;
  // Robot 1 brakes for 9 m until robot 0 is at 8.5 m. Robot 0 brakes there as well: it waits at 9 m until
  // robot 1 is at 8.5 m, too. Both are there at 6 s, with 0.5 m to go at 0.707 m/s.
  const auto executed = scene.execute(ExecutionPolicy::dependencies, {{{1, 0, 0.5}, {0, 0, 8.5 / 18}, 0.0},
                                                                      {{0, 0, 0.5}, {1, 0, 8.5 / 18}, 0.0}});
  const double speed = std::sqrt(2 * 0.5 * 0.5);
  const double there = 3.5 + (2.0 - speed) / 0.5;
  const double rise = 2.0 - speed;
  const double cruised = 9.5 - 4.0 - 0.5 * (2.0 + speed) * rise;
  for (const ExecutedProgress& progress : executed) {
    EXPECT_TRUE(progress.arrived);
    EXPECT_NEAR(progress.end(), there + rise + cruised / 2.0 + 4.0, 1e-9);
  }
}

TEST(AcceleratedExecution, ThatWaitForEachOtherStand) {
  HeavyPair scene;
  const auto executed = scene.execute(ExecutionPolicy::dependencies,
                                      {{{1, 0, 0.2}, {0, 0, 0.6}, 0.0}, {{0, 0, 0.3}, {1, 0, 0.4}, 0.0}});
  EXPECT_FALSE(executed[0].arrived);
  EXPECT_FALSE(executed[1].arrived);
  EXPECT_NEAR(executed[0].knots.back().fraction, 0.3, 1e-12);
  EXPECT_NEAR(executed[1].knots.back().fraction, 0.2, 1e-12);
}

TEST(AcceleratedExecution, RobotsWithAndWithoutLimitsWaitForEachOther) {
  HeavyPair scene;
  scene.plans[0] =
      support::PlanBuilder(0, scene.robots[0]).translate_to(19, 1).build();  // at 2 m/s from 0 s on
  scene.disturbed[0] = undisturbed(scene.plans[0]);
  // Robot 0 waits at 6 m, where it is at 3 s, until robot 1 is at 8 m, at 5 s. Robot 1 passes 14 m at 8 s. It
  // begins to brake for it at 6 s and 10 m. Robot 0 is at 12 m at 8 s.
  const auto executed =
      scene.execute(ExecutionPolicy::dependencies,
                    {{{0, 0, 6.0 / 18}, {1, 0, 8.0 / 18}, 0.0}, {{1, 0, 14.0 / 18}, {0, 0, 8.0 / 18}, 0.0}});
  EXPECT_NEAR(executed[0].end(), 5.0 + 6.0, 1e-9);
  EXPECT_NEAR(executed[1].end(), 12.0, 1e-9) << "robot 0 is at 8 m at 6 s";
}

TEST(AcceleratedExecution, FollowsAClockThatStands) {
  HeavyPair scene;
  scene.disturbed[0].all_halts = {{4.0, 8.0}};
  scene.disturbed[0].actions[0].halts = {0, 1};
  const auto executed = scene.execute(ExecutionPolicy::clock_stop, {}, 3.0);
  EXPECT_NEAR(executed[1].end(), 12.0 + 5.0, 1e-6);
  EXPECT_NEAR(scene.place(1, executed[1], 2.0), 2.0, 1e-6);
  EXPECT_NEAR(scene.place(1, executed[1], 7.0), 12.0, 1e-6);
  EXPECT_NEAR(scene.place(1, executed[1], 11.9), 12.0, 1e-6);
  EXPECT_NEAR(scene.place(1, executed[1], 15.0), 17.0, 1e-6);
}

/// Robot 1 drives behind robot 0, which starts at the same time and brakes earlier. At mean speeds they never
/// come near each other; in truth they do.
TEST(AcceleratedExecution, IsSeenByTheJudgeOfOverlaps) {
  std::vector<Robot> robots{heavy_robot(3, 1), heavy_robot(1, 1)};
  robots[1].linear_acceleration = 4.0;  // it is up to 2 m/s after half a second
  robots[1].linear_deceleration = 0.25;
  const std::vector<RobotPlan> plans{driven(0, robots[0], 18.0), driven(1, robots[1], 18.0)};
  const double gap = 2.0 - robots[0].radius - robots[1].radius;
  ASSERT_GT(gap, 0.0);
  const OccupancyGrid grid = open_map(40, 10);
  const auto collides = [&](const std::vector<RobotPlan>& executed) {
    const SimulatedFleet fleet = simulated(grid, robots, executed);
    const auto simulator = Simulator::make(fleet, {{}, 1, 0}, StopCondition::never());
    return simulator->run(0, StopCondition::never())->collisions.first;
  };
  // Robot 1 is up to 1.5 m nearer while robot 0 starts.
  const auto collision = collides(plans);
  ASSERT_TRUE(collision.has_value());
  EXPECT_LT(collision->t, 2.0);
  const double driven_by_0 = 0.5 * collision->t * collision->t;
  const double driven_by_1 = collision->t < 0.5 ? 2 * collision->t * collision->t : 2 * collision->t - 0.5;
  EXPECT_NEAR(2.0 + driven_by_0 - driven_by_1, robots[0].radius + robots[1].radius, 1e-5);
  std::vector<RobotPlan> mean = plans;
  for (RobotPlan& plan : mean) plan.actions[0].profile.reset();
  EXPECT_FALSE(collides(mean).has_value());
}

TEST(AcceleratedExecution, IsTheSameWithTheSameSeed) {
  HeavyPair scene;
  const SimulatedFleet fleet = simulated(scene.grid, scene.robots, scene.plans);
  Disturbance disturbance = rough();
  disturbance.cross_track = {0.05, 1.0};
  const auto trace = [&](std::uint64_t seed) {
    return trace_run(fleet, {disturbance, 1, seed}, 0, 1000, StopCondition::never())->actions;
  };
  const auto first = trace(7);
  const auto again = trace(7);
  ASSERT_EQ(first[0].size(), again[0].size());
  for (std::size_t k = 0; k < first[0].size(); ++k) {
    EXPECT_EQ(first[0][k].t_end, again[0][k].t_end);
    EXPECT_EQ(first[0][k].to.position, again[0][k].to.position);
  }
  EXPECT_NE(trace(8)[0].back().t_end, first[0].back().t_end);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
