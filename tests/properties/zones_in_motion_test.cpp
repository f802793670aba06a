// Random fleets among random zones, planned again under way. The independent checker accepts every plan, and
// previous plans that hold stay.

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "core/plan/planner.h"
#include "tests/support/expect_replanned.h"
#include "tests/support/moving_fleet.h"
#include "tests/support/random_zones.h"
#include "tests/support/sanitized.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::Dice;
using support::FleetRequest;

/// A valid request with zones of all types.
FleetRequest request_with_zones(Dice& dice) {
  while (true) {
    FleetRequest request = support::random_request(dice);
    const std::optional<Problem> plain = support::problem_of(request);
    if (!plain) continue;
    request.zones =
        support::random_zones(dice, *plain, {Zone::Type::blocked, Zone::Type::one_way, Zone::Type::speed});
    if (support::problem_of(request)) return request;
  }
}

class ZonesInMotion : public testing::TestWithParam<int> {};

TEST_P(ZonesInMotion, FleetsGoOnFromAnyMoment) {
  SCOPED_TRACE(testing::Message() << "seed " << GetParam());
  Dice dice(static_cast<std::uint64_t>(GetParam()) + 700'000);
  FleetRequest request = request_with_zones(dice);
  Plan plan = support::planned(*support::problem_of(request), request.options, 500);
  for (int round = 0; round < 3; ++round) {
    SCOPED_TRACE(testing::Message() << "round " << round);
    const double t = dice.between(0.0, std::max(1.0, 0.8 * plan.objectives.makespan));
    FleetRequest next = support::moment_of(dice, request, plan, t);
    const std::optional<Problem> problem = support::problem_of(next);
    if (!problem && !plan.unavoidable.empty()) return;  // amid a collision
    ASSERT_TRUE(problem) << "at t = " << t << " the fleet is not accepted";
    Plan later = support::planned(*problem, next.options, dice.chance(0.3) ? 10 : 300);
    support::expect_no_worse_than_previous(*problem, next.options, later);
    request = std::move(next);
    plan = std::move(later);
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, ZonesInMotion, testing::Range(0, support::kSanitized ? 50 : 150));

}  // namespace TEST_FILE
}  // namespace fleetplan::core
