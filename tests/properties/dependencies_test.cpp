// Random plans, executed at random speeds with random stops by robots that obey the dependencies. They never
// collide by the checker's own formulas, except in pairs that are listed as tight, and all arrive. The same
// executions without dependencies collide.

#include "core/execution/dependencies.h"

#include <gtest/gtest.h>

#include <chrono>
#include <set>
#include <utility>

#include "core/plan/planner.h"
#include "core/verify/verify.h"
#include "tests/support/moving_fleet.h"
#include "tests/support/own_pace.h"
#include "tests/support/plain_check.h"
#include "tests/support/sanitized.h"
#include "tests/support/summary.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::Dice;
using Pair = std::pair<std::size_t, std::size_t>;

constexpr int kPlans = support::kSanitized ? 200 : 2000;
constexpr int kExecutions = 4;  // of each plan
/// Metres: the tolerance of the plan's check, and rounding.
constexpr double kTolerance = 1.1e-6;

/// What happened in all executions.
struct Tally {
  int dependencies = 0;
  int collisions = 0;          // of loose pairs
  int collisions_without = 0;  // of loose pairs, without dependencies
};

std::vector<Robot> with_margins(std::vector<Robot> robots, const std::vector<double>& margins) {
  for (std::size_t k = 0; k < robots.size(); ++k) {
    robots[k].radius += margins[k];
    robots[k].vicinity = 0.0;  // a late robot may need it
    robots[k].invalid = false;
  }
  return robots;
}

/// The pairs that collide, by the checker's formulas.
std::set<Pair> collisions(const OccupancyGrid& grid, const std::vector<Robot>& robots,
                          const std::vector<RobotPlan>& executed) {
  std::set<Pair> pairs;
  const VerifyReport report = *verify(grid, robots, executed, kTolerance, StopCondition::never());
  for (const Violation& violation : report.violations) {
    if (violation.kind == Violation::Kind::robot_collision) {
      pairs.emplace(violation.robots[0], violation.robots[1]);
    }
  }
  return pairs;
}

class OwnPaceOfRandomPlans {
 public:
  explicit OwnPaceOfRandomPlans(int seed) : dice_(static_cast<std::uint64_t>(seed)) {}

  void run(Tally& tally) {
    const support::FleetRequest request = random_request();
    const auto problem = support::problem_of(request);
    if (!problem) return;
    const Plan plan = core::plan(*problem, request.options,
                                 StopCondition(StopCondition::Clock::now() + std::chrono::seconds(1)));
    DependencyRules rules{{}, dice_.between(0.02, 0.4), 1e-6};
    const bool has_margins = dice_.chance(0.3);
    for (std::size_t k = 0; k < problem->robots().size(); ++k) {
      rules.margins.push_back(has_margins ? request.options.inflation * dice_.between(0.0, 1.0) : 0.0);
    }
    const auto made = make_dependencies(problem->robots(), plan.plans, rules, StopCondition::never());
    ASSERT_TRUE(made);
    expect_ordered(*made, executed_actions(problem->robots(), plan.plans));
    tally.dependencies += static_cast<int>(made->list.size());
    const std::vector<Robot> robots = with_margins(problem->robots(), rules.margins);
    std::set<Pair> tight;
    for (const TightPair& pair : made->tight) tight.emplace(pair.first, pair.second);
    for (int k = 0; k < kExecutions; ++k) {
      const auto actions = executed_actions(problem->robots(), plan.plans);
      const auto obedient = support::OwnPaceExecution(dice_, actions, made->list).run();
      EXPECT_TRUE(obedient.everyone_arrived);
      for (const Pair& pair : collisions(problem->grid(), robots, obedient.executed)) {
        if (tight.contains(pair)) continue;
        ++tally.collisions;
        ADD_FAILURE() << "robots " << pair.first << " and " << pair.second << " collide";
      }
      const auto careless = support::OwnPaceExecution(dice_, actions, {}).run();
      for (const Pair& pair : collisions(problem->grid(), robots, careless.executed)) {
        tally.collisions_without += tight.contains(pair) ? 0 : 1;
      }
    }
  }

 private:
  support::FleetRequest random_request() {
    support::FleetRequest request = support::random_request(dice_);
    if (dice_.chance(0.7)) request.options.interval_margin = dice_.between(0.1, 2.0);
    if (dice_.chance(0.5)) request.options.inflation = request.grid.resolution() * dice_.between(0.0, 0.3);
    request.options.mode = PlanOptions::Mode::first;
    return request;
  }

  static void expect_ordered(const Dependencies& made, const std::vector<Actions>& actions) {
    for (const Dependency& one : made.list) {
      EXPECT_NE(one.gate.robot, one.until.robot);
      EXPECT_GT(one.slack, 0.0);
      EXPECT_LT(one.gate.action, actions[one.gate.robot].size());
      EXPECT_LT(one.until.action, actions[one.until.robot].size());
    }
  }

  Dice dice_;
};

TEST(DependenciesOfRandomPlans, KeepRobotsApartAtAnyPaceAndLetThemArrive) {
  Tally tally;
  for (int seed = 0; seed < kPlans && !testing::Test::HasFailure(); ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    OwnPaceOfRandomPlans(seed).run(tally);
  }
  RecordProperty("dependencies", tally.dependencies);
  RecordProperty("collisions_without", tally.collisions_without);
  EXPECT_GT(tally.dependencies, kPlans);
  EXPECT_GT(tally.collisions_without, kPlans / 4) << "the executions do not test the dependencies";
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
