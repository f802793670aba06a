#include "core/execution/simulation/simulation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "tests/core/execution/simulation/study.h"
#include "tests/support/threaded_executor.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::PlanBuilder;

constexpr std::size_t kAnyLength = std::numeric_limits<std::size_t>::max();  // of a trace

SimulationReport simulated_by(std::size_t threads, const SimulatedFleet& fleet,
                              const SimulationSettings& settings) {
  support::ThreadedExecutor executor(threads);
  return simulate(fleet, settings, StopCondition::never(), executor);
}

TEST(Simulation, OfAnUndisturbedPlanIsThePlan) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    const RandomFleet fleet = random_fleet(random, 5, 12.0, 8);
    const OccupancyGrid grid = open_map();
    for (const auto policy :
         {ExecutionPolicy::open_loop, ExecutionPolicy::absorb_waits, ExecutionPolicy::clock_stop}) {
      const SimulatedFleet study = simulated(grid, fleet.robots, fleet.plans, policy);
      const SimulationSettings settings{{}, 1, 0};
      const auto trace = trace_run(study, settings, 0, kAnyLength, StopCondition::never());
      for (std::size_t k = 0; k < fleet.plans.size(); ++k) {
        const Position rest = fleet.robots[fleet.plans[k].robot].start.position;
        for (double t = 0.0; t < fleet.makespan + 1.0; t += 0.1) {
          const Position planned = sampled_position(fleet, fleet.plans[k].robot, t);
          ASSERT_NEAR((sampled(trace->actions[k], rest, t) - planned).norm(), 0.0, 1e-6) << t;
        }
      }
      const auto run =
          Simulator::make(study, settings, StopCondition::never())->run(0, StopCondition::never());
      for (std::size_t k = 0; k < fleet.plans.size(); ++k) {
        EXPECT_NEAR(run->ends[k], fleet.plans[k].cost, 1e-6);
      }
    }
  }
}

/// The least distance of two robots in a trace, less their radii; by samples.
double sampled_gap(const SimulationTrace& trace, const RandomFleet& fleet, double end) {
  double least = 1e9;
  const auto actions = [&](std::size_t robot) {
    for (std::size_t k = 0; k < fleet.plans.size(); ++k) {
      if (fleet.plans[k].robot == robot) return trace.actions[k];
    }
    return std::vector<Action>{};
  };
  const auto first = actions(0);
  const auto second = actions(1);
  for (double t = 0.0; t < end + 0.5; t += 0.01) {
    const Position a = sampled(first, fleet.robots[0].start.position, t);
    const Position b = sampled(second, fleet.robots[1].start.position, t);
    least = std::min(least, (a - b).norm());
  }
  return least - fleet.robots[0].radius - fleet.robots[1].radius;
}

TEST(Simulation, FindsTheCollisionsThatSamplesOfTheTraceFind) {
  int collisions = 0;
  int clear = 0;
  for (unsigned seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    const RandomFleet fleet = random_fleet(random, 2, 5.0, 8);
    if (fleet.plans.empty()) continue;
    const OccupancyGrid grid = open_map(1000, 1000);
    const SimulatedFleet study = simulated(grid, fleet.robots, fleet.plans);
    SimulationSettings settings{rough(), 1, seed};
    settings.disturbance.cross_track = {0.1, 0.5};
    const auto run =
        Simulator::make(study, settings, StopCondition::never())->run(seed, StopCondition::never());
    const double end = *std::max_element(run->ends.begin(), run->ends.end());
    const auto trace = trace_run(study, settings, seed, kAnyLength, StopCondition::never());
    const double gap = sampled_gap(*trace, fleet, end);
    const bool collides = !run->collisions.pairs.empty();
    if (gap < -2e-6) {
      EXPECT_TRUE(collides) << gap;
      ++collisions;
    } else if (gap > 0.05) {
      EXPECT_FALSE(collides) << gap;
      ++clear;
    }
  }
  EXPECT_GT(collisions, 30);
  EXPECT_GT(clear, 30);
}

TEST(Simulation, TracesAreContiguous) {
  std::mt19937 random(5);
  const RandomFleet fleet = random_fleet(random, 6, 12.0, 8);
  const OccupancyGrid grid = open_map();
  SimulationSettings settings{rough(), 1, 3};
  settings.disturbance.cross_track = {0.05, 0.3};
  const SimulatedFleet study = simulated(grid, fleet.robots, fleet.plans, ExecutionPolicy::clock_stop);
  const auto trace = trace_run(study, settings, 0, kAnyLength, StopCondition::never());
  for (const std::vector<Action>& actions : trace->actions) {
    ASSERT_FALSE(actions.empty());
    EXPECT_EQ(actions.front().t_start, 0.0);
    for (std::size_t k = 1; k < actions.size(); ++k) {
      EXPECT_EQ(actions[k].t_start, actions[k - 1].t_end);
      EXPECT_LE((actions[k].from.position - actions[k - 1].to.position).norm(), 1e-9);
    }
  }
}

TEST(Simulation, HasTheSameFiguresForAnyNumberOfThreads) {
  std::mt19937 random(7);
  const RandomFleet fleet = random_fleet(random, 6, 12.0, 8);
  const OccupancyGrid grid = open_map();
  const SimulationSettings settings{rough(), 150, 11};
  const SimulatedFleet study = simulated(grid, fleet.robots, fleet.plans);
  const SimulationReport one = simulated_by(1, study, settings);
  const SimulationReport three = simulated_by(3, study, settings);
  EXPECT_EQ(one.totals.done, 150U);
  EXPECT_GT(one.totals.collided, 0U);
  EXPECT_EQ(one.flowtimes, three.flowtimes);
  EXPECT_EQ(one.delays, three.delays);
  EXPECT_EQ(one.totals.collided, three.totals.collided);
  ASSERT_EQ(one.first_collisions.size(), three.first_collisions.size());
  EXPECT_EQ(one.first_collisions.front().collision.t, three.first_collisions.front().collision.t);
  ASSERT_EQ(one.pairs.size(), three.pairs.size());
  EXPECT_EQ(one.pairs.front().runs, three.pairs.front().runs);
}

/// Robot 0 drives through the place that robot 1 leaves in time, by the plan.
struct Follower {
  std::vector<Robot> robots{robot_at(1, 1, 0.0), robot_at(5, 1, 0.0)};
  std::vector<RobotPlan> plans{PlanBuilder(0, robots[0]).translate_to(5, 1).build(),
                               PlanBuilder(1, robots[1]).translate_to(9, 1).build()};
  OccupancyGrid grid = open_map();
};

TEST(Simulation, ReportsWhoMeetsWhenWhereAndHowDeep) {
  Follower scene;
  SimulatedFleet study = simulated(scene.grid, scene.robots, scene.plans);
  study.body_radii = {2.5, 2.5};
  const SimulationReport report = simulated_by(1, study, {{}, 3, 0});
  EXPECT_EQ(report.totals.collided, 3U);
  ASSERT_EQ(report.first_collisions.size(), 3U);
  // The edge of the map is nearer than 2.5 m from the beginning, as are the two robots.
  const ExecutedCollision& collision = report.first_collisions.front().collision;
  EXPECT_EQ(collision.first, 0U);
  EXPECT_EQ(collision.t, 0.0);
  ASSERT_EQ(report.pairs.size(), 1U);
  EXPECT_EQ(report.pairs.front().runs, 3U);

  const auto after_wait = [&](double seconds) {
    scene.plans[1] = PlanBuilder(1, scene.robots[1]).wait(seconds).translate_to(9, 1).build();
    return simulated_by(1, simulated(scene.grid, scene.robots, scene.plans), {{}, 1, 0});
  };
  EXPECT_EQ(after_wait(2.0).totals.collided, 0U);
  const SimulationReport late = after_wait(3.5);
  ASSERT_EQ(late.totals.collided, 1U);
  const ExecutedCollision& met = late.first_collisions.front().collision;
  EXPECT_EQ(met.second, 1U);
  EXPECT_NEAR(met.t, 3.0, 1e-5);  // contact, with the tolerance
  EXPECT_NEAR(met.position.x(), 4.5, 1e-5);
  EXPECT_NEAR(met.depth, 0.5, 1e-9);
}

TEST(Simulation, MeetsWallsBesideThePath) {
  const OccupancyGrid grid = support::ascii_map({"##########", "..........", "##########"});
  std::vector<Robot> robots{robot_at(0.5, 1.5, 0.0, 0.45)};
  const std::vector<RobotPlan> plans{PlanBuilder(0, robots[0]).translate_to(9.5, 1.5).build()};
  const SimulatedFleet study = simulated(grid, robots, plans);
  SimulationSettings settings{{}, 20, 0};
  EXPECT_EQ(simulated_by(1, study, settings).totals.collided, 0U);
  settings.disturbance.cross_track = {0.1, 1.0};
  const SimulationReport report = simulated_by(1, study, settings);
  EXPECT_GT(report.totals.collided, 10U);
  const ExecutedCollision& collision = report.first_collisions.front().collision;
  EXPECT_FALSE(collision.second.has_value());
  EXPECT_NEAR(std::abs(collision.position.y() - 1.5), 0.05 + collision.depth, 1e-9);
}

TEST(Simulation, CountsDeadlocksAndLeavesThemOutOfTheTimes) {
  Follower scene;
  SimulatedFleet study = simulated(scene.grid, scene.robots, scene.plans, ExecutionPolicy::dependencies);
  study.execution.dependencies = {{{0, 0, 0.5}, {1, 0, 0.9}, 0.0}, {{1, 0, 0.5}, {0, 0, 0.9}, 0.0}};
  const SimulationReport report = simulated_by(2, study, {{}, 5, 0});
  EXPECT_EQ(report.totals.deadlocked, 5U);
  EXPECT_TRUE(report.flowtimes.empty());
  EXPECT_TRUE(report.delays[0].empty());
  ASSERT_EQ(report.deadlocks.size(), 5U);
  EXPECT_EQ(report.deadlocks.front().plans, (std::vector<std::size_t>{0, 1}));
}

TEST(Simulation, ReportsTheRunsThatWereFinished) {
  Follower scene;
  const SimulatedFleet study = simulated(scene.grid, scene.robots, scene.plans);
  CallerThread executor;
  const SimulationSettings settings{rough(), 1000, 4};
  const SimulationReport part =
      simulate(study, settings, StopCondition::never(), executor,
               [](const SimulationProgress& progress) { return progress.done < 100; });
  EXPECT_GE(part.totals.done, 100U);
  EXPECT_LT(part.totals.done, 1000U);
  const SimulationReport all = simulate(study, settings, StopCondition::never(), executor);
  EXPECT_EQ(all.totals.done, 1000U);
  EXPECT_TRUE(std::equal(part.flowtimes.begin(), part.flowtimes.end(), all.flowtimes.begin()));
  const StopCondition met(StopCondition::Clock::now());
  EXPECT_EQ(simulate(study, settings, met, executor).totals.done, 0U);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
