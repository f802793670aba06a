#include "core/execution/simulation/disturbance.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/core/execution/simulation/study.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::PlanBuilder;

/// A robot that turns, drives 100 m in 100 s and waits, many times: enough for means.
struct LongPlan {
  static constexpr int kRepeats = 400;
  Robot robot = robot_at(0, 0);
  std::vector<RobotPlan> plans;

  LongPlan() {
    PlanBuilder builder(0, robot);
    for (int k = 0; k < kRepeats; ++k) {
      builder.rotate_to(k % 2 == 0 ? 0.5 : 0.0).translate_to(k % 2 == 0 ? 100.0 : 0.0, 0.0).wait(2.0);
    }
    plans.push_back(builder.build());
  }

  DisturbedActions draw(const Disturbance& disturbance, std::uint64_t seed = 1, std::uint64_t run = 0) const {
    return draw_disturbances(plans, disturbance, seed, run, StopCondition::never())->front();
  }
};

TEST(Disturbance, ChangesNothingByDefault) {
  const LongPlan plan;
  const DisturbedActions drawn = plan.draw({});
  for (std::size_t k = 0; k < drawn.actions.size(); ++k) {
    const Action& action = plan.plans[0].actions[k];
    const double expected = action.type == Action::Type::wait ? 0.0 : action.t_end - action.t_start;
    EXPECT_EQ(drawn.actions[k].moving, expected);
    EXPECT_EQ(drawn.actions[k].start_delay, 0.0);
  }
  EXPECT_TRUE(drawn.all_halts.empty());
  EXPECT_TRUE(drawn.all_offsets.empty());
}

TEST(Disturbance, DrawsSpeedsAndDelaysUniformly) {
  const LongPlan plan;
  Disturbance disturbance;
  disturbance.speed = {0.5, 1.0};
  disturbance.turn = {0.2, 0.4};
  disturbance.start_delay = {1.0, 3.0};
  const DisturbedActions drawn = plan.draw(disturbance);
  double speed = 0.0;
  double delay = 0.0;
  for (std::size_t k = 0; k < drawn.actions.size(); ++k) {
    const Action& action = plan.plans[0].actions[k];
    delay += drawn.actions[k].start_delay;
    EXPECT_GE(drawn.actions[k].start_delay, 1.0);
    EXPECT_LE(drawn.actions[k].start_delay, 3.0);
    if (action.type == Action::Type::wait) continue;
    const double factor = (action.t_end - action.t_start) / drawn.actions[k].moving;
    const bool turns = action.type == Action::Type::rotate;
    EXPECT_GE(factor, turns ? 0.2 - 1e-12 : 0.5 - 1e-12);
    EXPECT_LE(factor, turns ? 0.4 + 1e-12 : 1.0 + 1e-12);
    if (!turns) speed += factor;
  }
  // Four standard deviations of the means.
  EXPECT_NEAR(speed / LongPlan::kRepeats, 0.75, 4 * 0.5 / std::sqrt(12.0 * LongPlan::kRepeats));
  EXPECT_NEAR(delay / (3 * LongPlan::kRepeats), 2.0, 4 * 2.0 / std::sqrt(36.0 * LongPlan::kRepeats));
}

TEST(Disturbance, DrawsStopsAtTheirRateAndMeanDuration) {
  const LongPlan plan;
  Disturbance disturbance;
  disturbance.stops = {90.0, 5.0};
  const DisturbedActions drawn = plan.draw(disturbance);
  double moving = 0.0;
  double stopped = 0.0;
  for (std::size_t k = 0; k < drawn.actions.size(); ++k) {
    moving += drawn.actions[k].moving;
    double last = 0.0;
    for (const DisturbedActions::Halt& halt : drawn.halts(k)) {
      EXPECT_GE(halt.after, last);
      EXPECT_LT(halt.after, drawn.actions[k].moving);
      last = halt.after;
      stopped += halt.seconds;
    }
  }
  const double expected = moving / 40.0;
  const auto stops = static_cast<double>(drawn.all_halts.size());
  EXPECT_NEAR(stops, expected, 4 * std::sqrt(expected));
  EXPECT_NEAR(stopped / stops, 5.0, 4 * 5.0 / std::sqrt(stops));
}

TEST(Disturbance, DrawsNormalOffsetsACorrelationLengthApart) {
  const LongPlan plan;
  Disturbance disturbance;
  disturbance.cross_track = {0.1, 2.0};
  const DisturbedActions drawn = plan.draw(disturbance);
  double sum = 0.0;
  double squares = 0.0;
  for (const double offset : drawn.all_offsets) {
    sum += offset;
    squares += offset * offset;
  }
  const auto count = static_cast<double>(drawn.all_offsets.size());
  EXPECT_EQ(drawn.all_offsets.size(), 50U * LongPlan::kRepeats);
  EXPECT_NEAR(sum / count, 0.0, 4 * 0.1 / std::sqrt(count));
  EXPECT_NEAR(std::sqrt(squares / count), 0.1, 4 * 0.1 / std::sqrt(2.0 * count));
}

TEST(Disturbance, DependsOnSeedAndRunOnly) {
  const LongPlan plan;
  const auto total = [&](std::uint64_t seed, std::uint64_t run) {
    double seconds = 0.0;
    for (const auto& action : plan.draw(rough(), seed, run).actions) seconds += action.moving;
    return seconds;
  };
  EXPECT_EQ(total(1, 2), total(1, 2));
  EXPECT_NE(total(1, 2), total(1, 3));
  EXPECT_NE(total(1, 2), total(2, 1));
  EXPECT_NE(total(0, 1), total(1, 0));
}

TEST(Disturbance, IsNotDrawnOnceTheStopConditionIsMet) {
  Disturbance disturbance;
  disturbance.stops = {36'000.0, 1.0};
  const StopCondition met(StopCondition::Clock::now());
  EXPECT_FALSE(draw_disturbances(LongPlan().plans, disturbance, 1, 0, met));
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
