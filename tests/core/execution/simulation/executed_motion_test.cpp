#include "core/execution/simulation/executed_motion.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "tests/core/execution/simulation/study.h"
#include "tests/support/step_limit.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::PlanBuilder;

/// One robot that drives 3000 m along a wall in one action, with many stops and bends.
struct LongWay {
  LongWay() {
    settings.disturbance.stops = {36'000.0, 1e-3};
    settings.disturbance.cross_track = {0.01, 0.01};
  }

  OccupancyGrid grid = open_map(3010, 10);
  std::vector<Robot> robots{Robot{"a", 0.3, 1.0, 2.0, {{2, 5}, 0.0}, {}}};
  std::vector<RobotPlan> plans{PlanBuilder(0, robots[0]).translate_to(3002, 5).build()};
  SimulationSettings settings{{}, 1, 1};
};

TEST(ExecutedMotion, HasABendForEachOffsetOfALongActionWithManyStops) {
  const LongWay way;
  const auto disturbed = draw_disturbances(way.plans, way.settings.disturbance, 1, 0, StopCondition::never());
  ASSERT_EQ(disturbed->front().all_offsets.size(), 300'000U);
  const std::size_t halts = disturbed->front().all_halts.size();
  EXPECT_GT(halts, 25'000U);
  const SimulatedFleet fleet = simulated(way.grid, way.robots, way.plans);
  const auto progress = execute_alone(fleet.execution, 0, disturbed->front(), StopCondition::never());
  const auto legs = executed_legs(way.robots[0], way.plans[0].actions, disturbed->front(), *progress,
                                  StopCondition::never());
  // A piece for each bend and each halt, the halts, the last piece, and the rest.
  EXPECT_EQ(legs->size(), 300'000 + 2 * halts + 2);
  for (std::size_t k = 1; k < legs->size(); ++k) {
    ASSERT_EQ((*legs)[k].t_begin, (*legs)[k - 1].t_end);
    ASSERT_LE(((*legs)[k].from - (*legs)[k - 1].to).norm(), 1e-9);
  }
}

TEST(ExecutedMotion, IsNoTraceIfItHasTooManyActions) {
  const LongWay way;
  const SimulatedFleet fleet = simulated(way.grid, way.robots, way.plans);
  EXPECT_FALSE(trace_run(fleet, way.settings, 0, 300'000, StopCondition::never()));
  EXPECT_TRUE(trace_run(fleet, way.settings, 0, 400'000, StopCondition::never()));
}

/// `work` returns none soon after its stop condition is met, whenever that is.
template <typename Work>
void expect_to_end_soon(const Work& work) {
  std::int64_t all = 0;
  {
    support::StepLimit limit;
    ASSERT_TRUE(work(support::counted(limit)));
    all = limit.steps();
  }
  ASSERT_GT(all, 20);
  for (std::int64_t steps = 0; steps < all; steps += all / 20) {
    support::StepLimit limit(steps);
    EXPECT_FALSE(work(support::counted(limit)));
    EXPECT_LE(limit.late(), 4) << steps;
  }
}

TEST(Simulator, EndsSoonAfterItsStop) {
  LongWay way;
  way.settings.disturbance.cross_track.correlation_length = 0.1;
  for (const auto policy : {ExecutionPolicy::open_loop, ExecutionPolicy::absorb_waits,
                            ExecutionPolicy::dependencies, ExecutionPolicy::clock_stop}) {
    SCOPED_TRACE(static_cast<int>(policy));
    SimulatedFleet fleet = simulated(way.grid, way.robots, way.plans, policy);
    fleet.execution.max_delay = 1.0;
    const auto simulator = Simulator::make(fleet, way.settings, StopCondition::never());
    expect_to_end_soon([&](const StopCondition& stop) { return simulator->run(0, stop); });
    expect_to_end_soon(
        [&](const StopCondition& stop) { return trace_run(fleet, way.settings, 0, 400'000, stop); });
  }
}

TEST(Simulator, IsNotMadeSoonAfterItsStop) {
  LongWay way;
  way.settings.disturbance = {};
  PlanBuilder builder(0, way.robots[0]);
  for (int k = 0; k < 2000; ++k) builder.translate_to(10, 5).translate_to(2, 5);
  way.plans = {builder.build()};
  const SimulatedFleet fleet = simulated(way.grid, way.robots, way.plans);
  for (const std::int64_t steps : {0, 1, 100}) {
    support::StepLimit limit(steps);
    EXPECT_FALSE(Simulator::make(fleet, way.settings, support::counted(limit)));
    EXPECT_LE(limit.late(), 4);
  }
  CallerThread callers_thread;
  support::StepLimit limit(100);
  EXPECT_EQ(simulate(fleet, way.settings, support::counted(limit), callers_thread).totals.done, 0U);
  EXPECT_LE(limit.late(), 4);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
