// One random robot on random maps with zones. Its travel time is the time of its plan, if the planner looks
// as long as it can. It is no less than the lower bound of all plans.

#include "core/travel/travel_times.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <utility>
#include <variant>

#include "core/plan/planner.h"
#include "core/runtime/executor.h"
#include "tests/support/random_zones.h"

namespace fleetplan::core {
namespace TEST_FILE {

constexpr int kRuns = 400;
/// Later improvement has up to 32 neighbours of a vertex; travel times have the request's connectivity.
constexpr int kMaxSlower = kRuns / 25;
constexpr double kRounding = 1e-6;  // seconds

PlanOptions options_for(support::Dice& dice) {
  PlanOptions options = support::random_options(dice, support::random_problem(dice, 1));
  options.mode = PlanOptions::Mode::anytime;
  options.max_iterations = 100;
  options.smoothing = false;
  return options;
}

/// One robot with a goal.
Problem random_problem(support::Dice& dice, bool with_zones, double inflation) {
  while (true) {
    const Problem plain = support::random_problem(dice, 1);
    if (!plain.robots().front().goal) continue;
    ProblemConditions conditions;
    conditions.inflation = inflation;
    if (with_zones) {
      conditions.zones =
          support::random_zones(dice, plain, {Zone::Type::blocked, Zone::Type::speed, Zone::Type::one_way});
    }
    std::vector<Robot> robots = plain.robots();
    robots.front().may_reverse = dice.chance(0.3);
    auto made =
        Problem::create(plain.map(), std::move(robots), std::move(conditions), StopCondition::never());
    if (auto* problem = std::get_if<Problem>(&made)) return std::move(*problem);
  }
}

std::optional<Travel> travel(const Problem& problem, const PlanOptions& options) {
  ProblemConditions conditions;
  conditions.inflation = options.inflation;
  conditions.zones = problem.zones();
  conditions.one_at_a_time = true;
  const auto alone = std::get<Problem>(
      Problem::create(problem.map(), problem.robots(), std::move(conditions), StopCondition::never()));
  CallerThread executor;
  const TravelQuestions questions{{false}, {{*problem.robots().front().goal, {0}}}};
  return (*travel_times(alone, options, questions, StopCondition::never(), executor, {}))[0][0];
}

class RandomTravelTimes : public testing::TestWithParam<bool> {};

TEST_P(RandomTravelTimes, AreThoseOfThePlan) {
  const bool with_zones = GetParam();
  int planned = 0;
  int slower = 0;  // than the plan
  for (int run = 0; run < kRuns; ++run) {
    support::Dice dice(static_cast<std::uint64_t>(run));
    PlanOptions options = options_for(dice);
    const Problem problem = random_problem(dice, with_zones, options.inflation);
    const Plan found = plan(problem, options, StopCondition::never());
    const auto way = travel(problem, options);
    ASSERT_EQ(way.has_value(), !found.plans.empty()) << run;
    if (!way) continue;
    ++planned;
    EXPECT_GE(way->seconds, found.plans.front().lower_bound - kRounding) << run;
    EXPECT_GE(way->metres,
              (problem.robots().front().goal->position - problem.robots().front().start.position).norm() -
                  kRounding)
        << run;
    if (way->seconds > found.plans.front().cost + kRounding) ++slower;
  }
  EXPECT_GT(planned, kRuns / 2);
  EXPECT_LE(slower, kMaxSlower);
}

INSTANTIATE_TEST_SUITE_P(Zones, RandomTravelTimes, testing::Bool());

}  // namespace TEST_FILE
}  // namespace fleetplan::core
