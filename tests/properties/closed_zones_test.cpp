// Random fleets with zones over some of them that no robot enters. The independent checker accepts every
// plan, and so do samples of it. A robot alone leaves if it may.

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <utility>
#include <variant>
#include <vector>

#include "core/model/ways_out.h"
#include "core/plan/planner.h"
#include "tests/support/expect_safe.h"
#include "tests/support/moments.h"
#include "tests/support/random_zones.h"
#include "tests/support/summary.h"

namespace fleetplan::core {
namespace TEST_FILE {

constexpr int kRuns = 300;

StopCondition generous_budget() {
  return StopCondition(StopCondition::Clock::now() + std::chrono::seconds(2));
}

/// A random fleet, of which some robots have several goals, with closed zones anywhere.
Problem random_problem(support::Dice& dice, int count, double inflation) {
  const Problem plain = support::random_problem(dice, count);
  std::vector<Robot> robots = plain.robots();
  for (Robot& robot : robots) {
    if (!robot.goal || !dice.chance(0.3)) continue;
    robot.via.push_back({robot.start.position, std::nullopt});
    robot.via.push_back({robot.goal->position, std::nullopt});
  }
  ProblemConditions conditions;
  conditions.inflation = inflation;
  conditions.zones = support::random_zones(dice, plain, {Zone::Type::blocked, Zone::Type::one_way});
  for (Zone& zone : conditions.zones) zone.may_leave = zone.type == Zone::Type::blocked;
  return std::get<Problem>(
      Problem::create(plain.map(), robots, std::move(conditions), StopCondition::never()));
}

/// How far a robot is from the closed zones that are for it, metres.
double distance_to_closed(const Problem& problem, std::size_t robot, const Position& position) {
  constexpr double kFar = 1e9;
  const auto nearest = nearest_zone_to_leave(problem.zones(), robot, position, kFar);
  return nearest ? nearest->distance : kFar;
}

/// The number of actions that end inside after an action that ended outside.
int come_back(const Problem& problem, const RobotPlan& plan) {
  constexpr double kRounding = 1e-6;
  const double radius = problem.robots()[plan.robot].radius;
  bool is_out =
      distance_to_closed(problem, plan.robot, problem.robots()[plan.robot].start.position) >= radius;
  int count = 0;
  for (const Action& action : plan.actions) {
    const bool is_inside = distance_to_closed(problem, plan.robot, action.to.position) < radius - kRounding;
    if (is_out && is_inside) ++count;
    is_out = is_out || !is_inside;
  }
  return count;
}

class FleetAmongClosedZones : public testing::TestWithParam<int> {};

TEST_P(FleetAmongClosedZones, LeavesThemAndDoesNotComeBack) {
  const int seed = GetParam();
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  support::Dice dice(static_cast<std::uint64_t>(seed));
  const double inflation = dice.chance(0.3) ? 0.05 : 0.0;
  const Problem problem = random_problem(dice, 1 + dice.below(10), inflation);
  PlanOptions options = support::random_options(dice, problem);
  options.inflation = inflation;

  const Plan plan = core::plan(problem, options, generous_budget());

  support::expect_safe(problem, plan, options);
  for (const RobotPlan& robot : plan.plans)
    EXPECT_EQ(come_back(problem, robot), 0) << "robot " << robot.robot;
}

INSTANTIATE_TEST_SUITE_P(Seeds, FleetAmongClosedZones, testing::Range(0, kRuns));

/// A robot alone with a way out has a plan, unless the zones close its way on.
TEST(RobotInAClosedZone, HasAPlanWhereverItHasAWay) {
  int inside = 0;
  int planned = 0;
  for (int seed = 0; seed < kRuns; ++seed) {
    support::Dice dice(static_cast<std::uint64_t>(seed));
    const Problem problem = random_problem(dice, 1, 0.0);
    const Leaving* leaving = problem.leaving(0);
    if (leaving == nullptr || leaving->way_out.empty()) continue;
    ++inside;
    const Plan plan = core::plan(problem, {}, generous_budget());
    planned += static_cast<int>(plan.plans.size());
    if (plan.plans.empty()) {
      EXPECT_EQ(plan.unplanned[0].reason, Unplanned::Reason::goal_unreachable) << "seed " << seed;
    } else {
      const Position end = plan.plans[0].actions.back().to.position;
      EXPECT_GE(distance_to_closed(problem, 0, end), problem.robots()[0].radius - 1e-6) << "seed " << seed;
    }
  }
  EXPECT_GT(inside, kRuns / 10);
  EXPECT_GT(planned, inside / 2);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
