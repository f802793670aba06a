// Random fleets in random moments of random plans: commitments cut anywhere, late robots, new goals,
// services, moving obstacles and margins. The independent checker accepts every plan, and previous plans that
// hold stay.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>

#include "core/plan/planner.h"
#include "tests/support/expect_replanned.h"
#include "tests/support/moving_fleet.h"
#include "tests/support/summary.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::Dice;
using support::expect_no_worse_than_previous;
using support::FleetRequest;
using support::moment_of;
using support::planned;
using support::previous_plans;
using support::problem_of;
using support::random_request;

class FleetInMotion : public testing::TestWithParam<int> {};

TEST_P(FleetInMotion, GoesOnFromAnyMoment) {
  SCOPED_TRACE(testing::Message() << "seed " << GetParam());
  Dice dice(static_cast<std::uint64_t>(GetParam()));
  FleetRequest request = random_request(dice);
  std::optional<Problem> problem = problem_of(request);
  ASSERT_TRUE(problem);
  Plan plan = planned(*problem, request.options, 1000);
  for (int round = 0; round < 4; ++round) {
    SCOPED_TRACE(testing::Message() << "round " << round);
    const double t = dice.between(0.0, std::max(1.0, 0.8 * plan.objectives.makespan));
    FleetRequest next = moment_of(dice, request, plan, t);
    const int disturbed = dice.below(static_cast<int>(next.robots.size()));
    Robot& robot = next.robots[static_cast<std::size_t>(disturbed)];
    const int disturbance = dice.below(4);
    if (disturbance == 1) support::hold_back(dice, robot);
    if (disturbance == 2) robot.previous.reset();
    if (disturbance == 3 && robot.goal) {
      robot.previous.reset();
      robot.via.clear();
      robot.goal->not_before = 0.0;
    }
    problem = problem_of(next);
    // A robot that is held stands in the way of what others are committed to; others are amid a collision.
    if (!problem && (disturbance == 1 || !plan.unavoidable.empty())) return;
    ASSERT_TRUE(problem) << "at t = " << t << " the fleet is not accepted";
    const int budget = dice.chance(0.3) ? 10 : 500;
    Plan later = planned(*problem, next.options, budget);
    expect_no_worse_than_previous(*problem, next.options, later);
    request = std::move(next);
    plan = std::move(later);
  }
}

TEST_P(FleetInMotion, KeepsPlansThatHoldWhateverTheBudget) {
  SCOPED_TRACE(testing::Message() << "seed " << GetParam());
  Dice dice(static_cast<std::uint64_t>(GetParam()) + 100'000);
  FleetRequest request = random_request(dice);
  const Plan plan = planned(*problem_of(request), request.options, 1000);
  if (!plan.unplanned.empty()) return;
  const double t = dice.between(0.0, plan.objectives.makespan);
  FleetRequest next = moment_of(dice, request, plan, t);
  const std::optional<Problem> problem = problem_of(next);
  ASSERT_TRUE(problem) << "at t = " << t;
  const Plan later = planned(*problem, next.options, dice.below(2) * 10);
  const bool holds = expect_no_worse_than_previous(*problem, next.options, later);
  // What was planned without moves under way that keep less than the full distance goes on as planned.
  const bool keeps_apart = request.options.inflation > 0.0 || request.robots[0].vicinity > 0.0;
  if (!keeps_apart && request.options.wait_before_move == 0.0) {
    EXPECT_TRUE(holds) << support::text(support::safety_report(*problem, *previous_plans(*problem)));
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, FleetInMotion, testing::Range(0, 150));

}  // namespace TEST_FILE
}  // namespace fleetplan::core
