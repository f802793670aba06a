// Random fleets whose robots pick loads up and put them down, at any moment of their plans. The independent
// checker accepts every plan.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>

#include "core/plan/planner.h"
#include "tests/support/expect_replanned.h"
#include "tests/support/moving_fleet.h"
#include "tests/support/sanitized.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::Dice;
using support::expect_no_worse_than_previous;
using support::FleetRequest;
using support::moment_of;
using support::planned;
using support::problem_of;

FleetRequest request_with_loads(Dice& dice) {
  FleetRequest request = support::random_request(dice);
  for (Robot& robot : request.robots) {
    if (robot.goal && robot.via.empty()) support::add_goals(dice, request.grid, robot);
  }
  support::add_loads(dice, request);
  return request;
}

class Loads : public testing::TestWithParam<int> {};

TEST_P(Loads, AreCarriedWithoutCollisions) {
  SCOPED_TRACE(testing::Message() << "seed " << GetParam());
  Dice dice(static_cast<std::uint64_t>(GetParam()) + 900'000);
  FleetRequest request = request_with_loads(dice);
  std::optional<Problem> problem = problem_of(request);
  ASSERT_TRUE(problem);
  Plan plan = planned(*problem, request.options, 300);
  for (int round = 0; round < 3; ++round) {
    SCOPED_TRACE(testing::Message() << "round " << round);
    const double t = dice.between(0.0, std::max(1.0, 0.8 * plan.objectives.makespan));
    FleetRequest next = moment_of(dice, request, plan, t);
    problem = problem_of(next);
    if (!problem && !plan.unavoidable.empty()) return;  // amid a collision
    ASSERT_TRUE(problem) << "at t = " << t << " the fleet is not accepted";
    Plan later = planned(*problem, next.options, dice.chance(0.3) ? 10 : 200);
    expect_no_worse_than_previous(*problem, next.options, later);
    request = std::move(next);
    plan = std::move(later);
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, Loads, testing::Range(0, support::kSanitized ? 60 : 200));

}  // namespace TEST_FILE
}  // namespace fleetplan::core
