#include "core/lns/large_neighbourhood_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "core/explain/triage.h"
#include "core/moves/prioritized_planning.h"
#include "tests/core/support/planning.h"
#include "tests/support/random_problem.h"
#include "tests/support/step_limit.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::expect_safe;
using support::robot_at;
using Objective = PlanOptions::Objective;

struct Value {
  double flowtime = 0.0;
  double makespan = 0.0;
};

Value value_of(const FleetReservations& reservations) {
  Value value;
  for (const RobotPlan& plan : support::plans_of(reservations)) {
    value.flowtime += plan.cost;
    value.makespan = std::max(value.makespan, plan.cost);
  }
  return value;
}

/// Plans as core::plan does before large neighbourhood search.
std::vector<std::size_t> plan_first_solution(Planning& p) {
  const auto given_up = triage(p.state, p.never);
  std::vector<std::size_t> movers = p.movers();
  std::erase_if(movers, [&](std::size_t robot) { return given_up[robot].has_value(); });
  plan_prioritized(p.state, movers, p.random, PlanningTime::until(StopCondition::never()), p.progress);
  return movers;
}

TautPathBounds bounds_of(const Planning& p) {
  return {p.instance, p.movers(), std::vector<double>(p.instance.size(), kForever), p.never};
}

PlanOptions iterations(std::int64_t count, Objective objective = Objective::flowtime) {
  PlanOptions options;
  options.max_iterations = count;
  options.objective = objective;
  options.seed = 5;
  return options;
}

/// Eight robots that all cross in the middle of a hall.
std::vector<Robot> roundabout() {
  std::vector<Robot> robots;
  for (int k = 0; k < 8; ++k) {
    const double angle = k * 0.25 * 3.141592653589793;
    const Position arm = 4.0 * Position(std::cos(angle), std::sin(angle));
    robots.push_back(robot_at(5.0 + arm.x(), 5.0 + arm.y()).to(5.0 - arm.x(), 5.0 - arm.y()));
  }
  return robots;
}

TEST(LargeNeighbourhoodSearch, LowersTheFlowtime) {
  Planning p(OccupancyGrid(10, 10, 1.0), roundabout(), iterations(60));
  const auto movers = plan_first_solution(p);
  const Value before = value_of(p.reservations);
  const LnsResult result =
      large_neighbourhood_search(p.state, movers, bounds_of(p), p.random, p.callers_thread, p.never);
  EXPECT_GT(result.improvements, 0);
  EXPECT_FALSE(result.cut_off);
  EXPECT_LT(value_of(p.reservations).flowtime, before.flowtime);
  expect_safe(p.reservations);
}

TEST(LargeNeighbourhoodSearch, LowersTheMakespanWithThatObjective) {
  Planning p(OccupancyGrid(10, 10, 1.0), roundabout(), iterations(60, Objective::makespan));
  const auto movers = plan_first_solution(p);
  const Value before = value_of(p.reservations);
  large_neighbourhood_search(p.state, movers, bounds_of(p), p.random, p.callers_thread, p.never);
  EXPECT_LT(value_of(p.reservations).makespan, before.makespan);
  expect_safe(p.reservations);
}

/// Two robots that meet head-on in a corridor with a bay for either.
std::vector<Robot> meeting() {
  return {robot_at(0.5, 0.5).to(10.5, 0.5), robot_at(10.5, 0.5, 3.141592653589793).to(0.5, 0.5)};
}

OccupancyGrid corridor_with_bays() {
  return support::ascii_map({"###.###.###",  //
                             "..........."});
}

/// The costs of both robots after improvement.
std::pair<double, double> improved_costs(std::vector<Robot> robots, Objective objective) {
  Planning p(corridor_with_bays(), std::move(robots), iterations(60, objective));
  const auto movers = plan_first_solution(p);
  large_neighbourhood_search(p.state, movers, bounds_of(p), p.random, p.callers_thread, p.never);
  expect_safe(p.reservations);
  return {p.reservations.trajectory(0)->cost, p.reservations.trajectory(1)->cost};
}

TEST(LargeNeighbourhoodSearch, LetsTheHeavyRobotPass) {
  for (const std::size_t heavy : {0U, 1U}) {
    std::vector<Robot> robots = meeting();
    robots[heavy].weight = 100.0;
    const auto [a, b] = improved_costs(robots, Objective::flowtime);
    EXPECT_LT(heavy == 0 ? a : b, heavy == 0 ? b : a);
  }
}

TEST(LargeNeighbourhoodSearch, LetsTheRobotPassThatIsDueWithThatObjective) {
  for (const std::size_t urgent : {0U, 1U}) {
    std::vector<Robot> robots = meeting();
    robots[urgent].goal->due = 10.0;
    robots[1 - urgent].goal->due = 100.0;
    const auto [a, b] = improved_costs(robots, Objective::tardiness);
    EXPECT_LE(urgent == 0 ? a : b, 10.0 + 1e-9);
  }
}

TEST(LargeNeighbourhoodSearch, ChangesNothingWithoutIterations) {
  Planning p(OccupancyGrid(10, 10, 1.0), roundabout(), iterations(0));
  const auto movers = plan_first_solution(p);
  const double before = value_of(p.reservations).flowtime;
  EXPECT_EQ(large_neighbourhood_search(p.state, movers, bounds_of(p), p.random, p.callers_thread, p.never)
                .improvements,
            0);
  EXPECT_EQ(value_of(p.reservations).flowtime, before);
}

TEST(LargeNeighbourhoodSearch, ReturnsTheSamePlanForTheSameSeed) {
  const auto run = [] {
    Planning p(OccupancyGrid(10, 10, 1.0), roundabout(), iterations(30));
    const auto movers = plan_first_solution(p);
    large_neighbourhood_search(p.state, movers, bounds_of(p), p.random, p.callers_thread, p.never);
    Plan plan;
    plan.plans = support::plans_of(p.reservations);
    return support::exact_text(plan);
  };
  EXPECT_EQ(run(), run());
}

TEST(LargeNeighbourhoodSearch, EndsWhenEveryRobotIsAtItsLowerBound) {
  PlanOptions options;  // no limit of iterations or time
  Planning p(OccupancyGrid(10, 10, 1.0), {robot_at(1.5, 1.5).to(8.5, 1.5), robot_at(1.5, 8.5).to(8.5, 7.5)},
             options);
  const auto movers = plan_first_solution(p);
  const LnsResult result =
      large_neighbourhood_search(p.state, movers, bounds_of(p), p.random, p.callers_thread, p.never);
  EXPECT_EQ(result.improvements, 0);
  EXPECT_FALSE(result.cut_off);
}

/// Small fleets often come to a plan in which no robot has a cheaper way, and stray from a plan in which some
/// do.
TEST(LargeNeighbourhoodSearch, EndsEarlyOnlyIfNoRobotOfTheBestPlanHasACheaperWay) {
  int exhausted = 0;
  for (std::uint64_t seed = 0; seed < 80; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    support::Dice dice(seed);
    PlanOptions options;
    options.seed = seed;
    options.connectivity = 32;  // estimates as good from the beginning
    Planning p(support::random_problem(dice, 3), options);
    const auto movers = plan_first_solution(p);
    support::StepLimit limit(5'000);
    const LnsResult result = large_neighbourhood_search(p.state, movers, bounds_of(p), p.random,
                                                        p.callers_thread, support::counted(limit));
    ASSERT_TRUE(result.exhausted || result.cut_off);
    if (!result.exhausted) continue;
    ++exhausted;
    for (const std::size_t robot : movers) {
      if (!p.reservations.trajectory(robot)) continue;
      const double cost = p.reservations.trajectory(robot)->cost;
      const SearchResult alone = p.state.plan_ignoring(robot, movers, kExact, p.never);
      ASSERT_TRUE(alone.trajectory) << robot;
      ASSERT_GE(alone.trajectory->cost, cost - 1e-6) << robot;
    }
  }
  EXPECT_GT(exhausted, 20);
}

TEST(LargeNeighbourhoodSearch, EndsAtOnceWithoutTrajectories) {
  Planning p(OccupancyGrid(10, 10, 1.0), {robot_at(1.5, 1.5).to(8.5, 1.5), robot_at(5.5, 5.5)});
  EXPECT_FALSE(
      large_neighbourhood_search(p.state, {}, bounds_of(p), p.random, p.callers_thread, p.never).cut_off);
  EXPECT_FALSE(
      large_neighbourhood_search(p.state, {0}, bounds_of(p), p.random, p.callers_thread, p.never).cut_off)
      << "it has no plan to improve";
}

TEST(LargeNeighbourhoodSearch, ChangesNothingWhenStopped) {
  Planning p(OccupancyGrid(10, 10, 1.0), roundabout(), iterations(1000));
  const auto movers = plan_first_solution(p);
  const double before = value_of(p.reservations).flowtime;
  const LnsResult result =
      large_neighbourhood_search(p.state, movers, bounds_of(p), p.random, p.callers_thread, met());
  EXPECT_TRUE(result.cut_off);
  EXPECT_EQ(value_of(p.reservations).flowtime, before);
}

class LnsRandomFleets : public testing::TestWithParam<Objective> {};

/// Allows so many steps.
class Steps final : public Executor {
 public:
  explicit Steps(int count) : left_(count) {}
  void run_on(std::size_t threads, std::size_t count, const Task& task) override {
    caller_.run_on(threads, count, task);
  }
  bool may_improve(const StopCondition& /*stop*/) override { return left_-- > 0; }

 private:
  CallerThread caller_;
  int left_;
};

TEST(LargeNeighbourhoodSearch, AsksBeforeEveryStepOfTheCallerWhetherToGoOn) {
  const auto improved = [](int steps) {
    Planning p(OccupancyGrid(10, 10, 1.0), roundabout(), iterations(8));
    const auto movers = plan_first_solution(p);
    Steps executor(steps);
    return large_neighbourhood_search(p.state, movers, bounds_of(p), p.random, executor, p.never);
  };
  EXPECT_FALSE(improved(9).cut_off) << "eight iterations, and one step that finds none";
  EXPECT_TRUE(improved(7).cut_off);
  EXPECT_GT(improved(7).expansions, 0) << "results so far count";
  EXPECT_EQ(improved(0).expansions, 0);
}

TEST(LargeNeighbourhoodSearch, SmoothsInTheLastTenthOfIterations) {
  const auto expansions = [](int count, bool smoothing) {
    PlanOptions options = iterations(count);
    options.smoothing = smoothing;
    Planning p(OccupancyGrid(10, 10, 1.0), roundabout(), options);
    const auto movers = plan_first_solution(p);
    return large_neighbourhood_search(p.state, movers, bounds_of(p), p.random, p.callers_thread, p.never)
        .expansions;
  };
  EXPECT_GT(expansions(10, false), expansions(9, false));
  EXPECT_EQ(expansions(10, true), expansions(9, true)) << "the tenth iteration searches nothing";
}

TEST(LargeNeighbourhoodSearch, SaysThatTheTimeBeganToSmooth) {
  // Time that is over, except for a thread that has waited for the CPU.
  const auto late = StopCondition(StopCondition::Clock::now() - std::chrono::seconds(1));
  const StopCondition patient = late.with_cpu_time(std::chrono::hours(1));
  Planning p(OccupancyGrid(10, 10, 1.0), roundabout(), iterations(3));
  const auto movers = plan_first_solution(p);
  const LnsResult result =
      large_neighbourhood_search(p.state, movers, bounds_of(p), p.random, p.callers_thread, patient);
  EXPECT_EQ(result.expansions, 0);
  EXPECT_TRUE(result.cut_off);
  EXPECT_FALSE(result.exhausted);
}

TEST_P(LnsRandomFleets, NeverMakesAPlanWorseOrUnsafe) {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    support::Dice dice(seed);
    Planning p(support::random_problem(dice, 8), iterations(15, GetParam()));
    const auto movers = plan_first_solution(p);
    const std::size_t planned = support::plans_of(p.reservations).size();
    const Value before = value_of(p.reservations);
    const LnsResult result =
        large_neighbourhood_search(p.state, movers, bounds_of(p), p.random, p.callers_thread, p.never);
    const Value after = value_of(p.reservations);
    const bool by_makespan = GetParam() == Objective::makespan;
    ASSERT_LE(by_makespan ? after.makespan : after.flowtime, by_makespan ? before.makespan : before.flowtime);
    if (result.improvements == 0) {
      ASSERT_EQ(after.flowtime, before.flowtime);
    }
    ASSERT_EQ(support::plans_of(p.reservations).size(), planned) << "every robot keeps a plan";
    expect_safe(p.reservations);
  }
}

INSTANTIATE_TEST_SUITE_P(Objectives, LnsRandomFleets,
                         testing::Values(Objective::flowtime, Objective::makespan));

}  // namespace TEST_FILE
}  // namespace fleetplan::core
