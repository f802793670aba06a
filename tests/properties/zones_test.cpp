// Random fleets among random zones: the independent checker accepts every plan.

#include <gtest/gtest.h>

#include <chrono>
#include <vector>

#include "core/plan/planner.h"
#include "tests/support/expect_bounds.h"
#include "tests/support/expect_safe.h"
#include "tests/support/random_zones.h"
#include "tests/support/summary.h"

namespace fleetplan::core {
namespace TEST_FILE {

constexpr int kRuns = 400;

StopCondition generous_budget() {
  return StopCondition(StopCondition::Clock::now() + std::chrono::seconds(2));
}

using Types = std::vector<Zone::Type>;

/// Zones of one type, or of all.
Types types_of(int seed) {
  const std::vector<Types> all{{Zone::Type::blocked},
                               {Zone::Type::one_way},
                               {Zone::Type::speed},
                               {Zone::Type::blocked, Zone::Type::one_way, Zone::Type::speed}};
  return all[static_cast<std::size_t>(seed) % all.size()];
}

class FleetAmongZones : public testing::TestWithParam<int> {};

TEST_P(FleetAmongZones, KeepsTheRulesOfAllZones) {
  const int seed = GetParam();
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  support::Dice dice(static_cast<std::uint64_t>(seed));
  const Problem problem = support::random_problem_with_zones(dice, 1 + dice.below(10), types_of(seed));
  const PlanOptions options = support::random_options(dice, problem);

  const Plan plan = core::plan(problem, options, generous_budget());

  support::expect_safe(problem, plan, options);
  support::expect_bounded(plan);
}

TEST_P(FleetAmongZones, PlansTheSameTwice) {
  const int seed = GetParam();
  if (seed % 11 != 0) return;  // an eleventh of the seeds suffices
  support::Dice dice(static_cast<std::uint64_t>(seed));
  const Problem problem = support::random_problem_with_zones(dice, 1 + dice.below(10), types_of(seed));
  const PlanOptions options = support::random_options(dice, problem);

  const Plan first = core::plan(problem, options, generous_budget());
  const Plan second = core::plan(problem, options, generous_budget());

  if (first.deterministic && second.deterministic) {
    EXPECT_EQ(support::exact_text(first), support::exact_text(second));
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, FleetAmongZones, testing::Range(0, kRuns));

/// How many robots a random fleet among zones would lead through a zone if the planner knew of none: the
/// property test can fail.
TEST(FleetWithoutZones, BreaksTheirRules) {
  for (int type = 0; type < 3; ++type) {
    const Types types = types_of(type);
    int broken = 0;
    for (int seed = 0; seed < 40; ++seed) {
      support::Dice dice(static_cast<std::uint64_t>(seed));
      const Problem problem = support::random_problem_with_zones(dice, 4, types);
      auto plain = Problem::create(problem.map(), problem.robots(), {}, StopCondition::never());
      const Plan plan = core::plan(std::get<Problem>(plain), {}, generous_budget());
      if (!support::safety_report(problem, plan.plans).valid()) ++broken;
    }
    EXPECT_GT(broken, 5) << "type " << type;
  }
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
