// Random fleets with and without smoothing. The independent checker accepts every smoothed plan, no robot's
// share in the objective becomes more, and without smoothing robots stop on the lattice only.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "core/map/lattice.h"
#include "core/model/objective_share.h"
#include "core/plan/planner.h"
#include "tests/support/expect_bounds.h"
#include "tests/support/expect_replanned.h"
#include "tests/support/moving_fleet.h"
#include "tests/support/random_zones.h"
#include "tests/support/sanitized.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::Dice;
using support::FleetRequest;
using support::problem_of;

constexpr int kBudget = 1000;  // milliseconds

/// Goals with loads, dues, services and headings, accelerations and zones, each in some of the requests.
FleetRequest request_with_all(Dice& dice) {
  while (true) {
    FleetRequest request = support::random_request(dice);
    if (dice.chance(0.3)) support::add_loads(dice, request);
    const bool is_due = dice.chance(0.3);
    const bool accelerates = dice.chance(0.3);
    if (is_due) request.options.objective = PlanOptions::Objective::tardiness;
    for (Robot& robot : request.robots) {
      robot.weight = dice.between(0.5, 2.0);
      if (accelerates) {
        robot.linear_acceleration = robot.linear_speed * dice.between(0.2, 3.0);
        robot.linear_deceleration = robot.linear_speed * dice.between(0.2, 3.0);
      }
      for (std::size_t k = 0; is_due && k < robot.goal_count(); ++k) {
        Goal& goal = k < robot.via.size() ? robot.via[k] : *robot.goal;
        if (dice.chance(0.7)) goal.due = dice.between(0.0, 20.0);
      }
    }
    const std::optional<Problem> plain = problem_of(request);
    if (plain && dice.chance(0.3)) {
      request.zones =
          support::random_zones(dice, *plain, {Zone::Type::blocked, Zone::Type::one_way, Zone::Type::speed});
    }
    if (problem_of(request)) return request;
  }
}

/// The robot's share in the objective, by its plan.
double share_in(const Problem& problem, const PlanOptions& options, const RobotPlan& plan) {
  const Itinerary itinerary = itinerary_of(problem.robots()[plan.robot]);
  if (itinerary.is_parked()) return 0.0;
  Trajectory trajectory;
  trajectory.cost = plan.cost;
  trajectory.visits = plan.visits;
  const std::size_t last = itinerary.first_goal + itinerary.goals.size() - 1;
  std::erase_if(trajectory.visits,
                [&](const Visit& visit) { return visit.goal < itinerary.first_goal || visit.goal == last; });
  return share_of(itinerary, options.objective, trajectory);
}

/// Expects that no robot has a greater share than without smoothing.
void expect_no_greater_shares(const Problem& problem, const PlanOptions& options, const Plan& smoothed,
                              const Plan& plain) {
  ASSERT_EQ(smoothed.plans.size(), plain.plans.size());
  for (std::size_t k = 0; k < plain.plans.size(); ++k) {
    EXPECT_EQ(smoothed.plans[k].robot, plain.plans[k].robot);
    const double with = share_in(problem, options, smoothed.plans[k]);
    const double without = share_in(problem, options, plain.plans[k]);
    EXPECT_LE(with, without + 1e-9) << "robot " << plain.plans[k].robot;
  }
}

class SmoothedFleet : public testing::TestWithParam<int> {};

TEST_P(SmoothedFleet, GetsSafePlansThatAreNoWorse) {
  SCOPED_TRACE(testing::Message() << "seed " << GetParam());
  Dice dice(static_cast<std::uint64_t>(GetParam()) + 300'000);
  FleetRequest request = request_with_all(dice);
  // Moments of plans assume robots at constant speed.
  const bool accelerates = request.robots[0].linear_inertia().is_limited;
  for (int round = 0; round < (accelerates ? 1 : 2); ++round) {
    SCOPED_TRACE(testing::Message() << "round " << round);
    const std::optional<Problem> problem = problem_of(request);
    ASSERT_TRUE(problem) << "the fleet is not accepted";
    request.options.any_angle = true;
    request.options.mode = PlanOptions::Mode::first;
    request.options.smoothing = false;
    const Plan plain = support::planned(*problem, request.options, kBudget);
    request.options.smoothing = true;
    const Plan smoothed = support::planned(*problem, request.options, kBudget);
    support::expect_bounded(smoothed);
    if (plain.deterministic && smoothed.deterministic) {
      expect_no_greater_shares(*problem, request.options, smoothed, plain);
    }
    request.options.mode = PlanOptions::Mode::anytime;
    const Plan improved = support::planned(*problem, request.options, kBudget);
    support::expect_bounded(improved);
    if (!improved.unavoidable.empty()) return;  // amid a collision
    const double t = dice.between(0.0, std::max(1.0, 0.8 * improved.objectives.makespan));
    request = support::moment_of(dice, request, improved, t);
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, SmoothedFleet, testing::Range(0, support::kSanitized ? 60 : 200));

/// A fleet that begins and ends on the lattice, which nothing refines.
struct LatticeFleet {
  explicit LatticeFleet(int seed) : dice(static_cast<std::uint64_t>(seed) + 310'000) {
    const Problem any = support::random_problem(dice, 8);
    std::vector<Robot> robots;
    for (Robot robot : any.robots()) {
      robot.radius = std::min(robot.radius, 0.5 * any.grid().resolution());
      robot.start.position = any.grid().center(any.grid().cell_at(robot.start.position));
      if (robot.goal) robot.goal->position = any.grid().center(any.grid().cell_at(robot.goal->position));
      robots.push_back(robot);
      auto made = Problem::create(any.map(), robots, {}, StopCondition::never());
      if (!std::holds_alternative<Problem>(made)) robots.pop_back();
    }
    problem = std::get<Problem>(Problem::create(any.map(), robots, {}, StopCondition::never()));
    options.mode = dice.chance(0.3) ? PlanOptions::Mode::anytime : PlanOptions::Mode::first;
    options.max_iterations = 20;
    options.connectivity = 4 << dice.below(4);
  }

  /// How many stops of the plan are off the lattice.
  int stops_off_lattice(bool smoothing) {
    options.smoothing = smoothing;
    const Plan plan = support::planned(*problem, options, kBudget);
    const Lattice lattice(problem->grid(), options.connectivity);
    int off = 0;
    for (const RobotPlan& robot : plan.plans) {
      for (const Action& action : robot.actions) {
        if (lattice.vertex_at(action.to.position) < 0) ++off;
      }
    }
    return off;
  }

  Dice dice;
  std::optional<Problem> problem;
  PlanOptions options;
};

TEST(LatticeFleet, LeavesTheLatticeOnlyWithSmoothing) {
  int smoothed = 0;
  for (int seed = 0; seed < (support::kSanitized ? 30 : 150); ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    LatticeFleet fleet(seed);
    EXPECT_EQ(fleet.stops_off_lattice(false), 0);
    if (fleet.stops_off_lattice(true) > 0) ++smoothed;
  }
  EXPECT_GT(smoothed, support::kSanitized ? 6 : 30);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
